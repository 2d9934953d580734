#include "app/bench/stress_case_groups.h"

namespace mv::stress {
namespace {

using glm::dvec3;
using glm::vec3;

// ---------------------------------------------------------------- camera and resolutions

Case cameraCase(const std::string& name, const std::string& why, double factor, dvec3 from,
                dvec3 to, double yfovDeg = 62) {
    return {name, why,
            [=] {
                World w = litRoom();
                w.camera(from, to, yfovDeg);
                return finished(std::move(w));
            },
            factor};
}

template <typename Change>
Case settingsCase(const std::string& name, const std::string& why, double factor, Change change) {
    return {name, why,
            [=] {
                Settings s = usual();
                change(s);
                return finished(litRoom(), s);
            },
            factor};
}

Case levelsCase(int sceneLevels, int viewLevels, bool small, double factor,
                const std::string& why) {
    const std::string name = sceneLevels == viewLevels ? "levels-" + std::to_string(sceneLevels)
                                                       : "levels-" + std::to_string(sceneLevels) +
                                                             "-" + std::to_string(viewLevels);
    return {small ? name + "-corridor" : name, why,
            [=] {
                Settings s = usual();
                s.scene.octreeDepth = sceneLevels;
                s.views.octreeDepth = viewLevels;
                return finished(small ? corridor() : litRoom(), s);
            },
            factor};
}

}  // namespace

void addCameraCases(std::vector<Case>& all) {
    all.push_back(cameraCase("looking-down", "forward along up", 2, {2, 3.5, 4}, {2, 0, 4}));
    all.push_back(cameraCase("in-the-wall", "the camera in the plane of a wall, looking along it",
                             1.5, {0, 2, 3}, {0, 1, 0}));
    all.push_back(cameraCase("inside-pillar", "surfaces nearer than any feature, seen from behind",
                             1.5, {2.9, 2, 2.5}, {6, 1, 2}));
    all.push_back(cameraCase("nose-on-floor", "a camera 1e-5 of the edge above the floor", 1.5,
                             {4, 8e-5, 4.5}, {6, 0, 2}));
    all.push_back(
        cameraCase("far-away", "the whole scene in one pixel", 1.5, {60, 25, 110}, {4, 2, 3}));
    all.push_back(cameraCase("fov-0.1", "a telescope", 1.25, {0.7, 1.8, 5.5}, {6, 1.1, 2.6}, 0.1));
    all.push_back(cameraCase("fov-170", "pixels of very different angles", 2.75, {0.7, 1.8, 5.5},
                             {6, 1.1, 2.6}, 170));
    all.push_back(cameraCase("nothing-in-sight", "means over no pixel", 0, {-5, 2, 3}, {-9, 2, 3}));
}

void addResolutionCases(std::vector<Case>& all) {
    all.push_back(settingsCase("one-pixel", "a picture of one pixel: no mean over pixels", 1.75,
                               [](Settings& s) { s.resolution.width = s.resolution.height = 1; }));
    all.push_back(settingsCase("view-res-8", "texels of 30 degrees", 3,
                               [](Settings& s) { s.side[0].maps.resolution = 8; }));
    all.push_back(
        settingsCase("view-res-256", "texels below the leaves: holes", 1.25, [](Settings& s) {
            s.side[0].maps.resolution = 256;
            s.views.vpls = 4;
        }));
    all.push_back(settingsCase("clamp-0", "the geometry term without its clamp", 1.25,
                               [](Settings& s) { s.gather.clampDistance = 0; }));
    all.push_back(levelsCase(1, 1, false, 8.5, "both octrees are their roots: no visibility left"));
    all.push_back(levelsCase(2, 2, false, 21, "leaves of half the room"));
    all.push_back(levelsCase(3, 3, false, 28, "leaves of 2 m"));
    all.push_back(levelsCase(4, 4, false, 12, "leaves of 1 m"));
    all.push_back(levelsCase(5, 5, false, 2, "leaves of 0.5 m"));
    all.push_back(levelsCase(6, 6, false, 1.25, "leaves of 26 cm"));
    all.push_back(levelsCase(7, 7, false, 1.25, "leaves of 13 cm"));
    all.push_back(levelsCase(9, 9, false, 1.25, "leaves of 3 cm"));
    all.push_back(levelsCase(8, 1, false, 12, "one view leaf at the root"));
    all.push_back(levelsCase(1, 8, false, 8.5, "one scene leaf at the root"));
    all.push_back(levelsCase(8, 8, true, 1, "the corridor that deeper octrees are held against"));
    all.push_back(levelsCase(10, 10, true, 1, "leaves of 16 mm"));
    all.push_back(levelsCase(11, 11, true, 1, "all 30 bits of the keys"));
}

}  // namespace mv::stress
