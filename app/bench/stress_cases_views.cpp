#include <cmath>

#include "app/bench/stress_case_groups.h"
#include "shaders/shared/vpl.glsl"

namespace mv::stress {
namespace {

using glm::dvec3;
using glm::vec3;

// ---------------------------------------------------------------- scale and place

Case scaled(const std::string& name, double scale, dvec3 offset, double tolerance,
            const std::string& why) {
    return {name, why, [=] { return finished(litRoom(scale, offset)); }, 1.05,
            Equality{"room", 1, tolerance}};
}

// ---------------------------------------------------------------- views

template <typename Place>
Case viewCase(const std::string& name, const std::string& why, double factor, Place place) {
    return {name, why, [=] { return withViews(furnishedRoom(), place); }, factor};
}

// The room with a partition that has no thickness.
World partitionedRoom() {
    World w = furnishedRoom();
    w.use(vec3(0.6f), vec3(0), true);
    w.quad({3.9, 0, 0}, {3.9, 0, 3.2}, {3.9, 4, 3.2}, {3.9, 4, 0});
    return w;
}

}  // namespace

void addScaleCases(std::vector<Case>& all) {
    const std::string scale = "lengths in single precision, and areas in powers of them";
    const std::string far = "single precision holds 7 digits, and the distance takes them";
    all.push_back(scaled("scale-2^-13", std::exp2(-13), dvec3(0), 0, scale));
    all.push_back(scaled("scale-2^20", std::exp2(20), dvec3(0), 0, scale));
    all.push_back(scaled("scale-1e-4", 1e-4, dvec3(0), 1e-3, scale));
    all.push_back(scaled("scale-1e6", 1e6, dvec3(0), 1e-3, scale));
    all.push_back(scaled("scale-1e-12", 1e-12, dvec3(0), 1e-3, scale));
    all.push_back(scaled("scale-1e12", 1e12, dvec3(0), 1e-3, scale));
    all.push_back(scaled("offset-2^20", 1, dvec3(std::exp2(20), -std::exp2(19), 4096), 1e-3, far));
    all.push_back(scaled("offset-1e6", 1, dvec3(1e6, -1e6, 1e6), 1e-3, far));
    all.push_back(scaled("offset-1e6-scale-1e-4", 1e-4, dvec3(1e6, 0, -1e6), 0.02,
                         "double precision itself ends at a few units of the root cube's floats"));
    all.push_back({"file-rounded-1e6",
                   "corners kept in single precision 1e6 m away, as a file may: a grid of 6 cm",
                   [] {
                       World w = litRoom(1, dvec3(1e6, 0, 0));
                       w.roundToFloat();
                       return finished(std::move(w));
                   },
                   1.5});
}

void addViewCases(std::vector<Case>& all) {
    all.push_back(viewCase("one-view", "a tree that is one leaf", 1.5,
                           [](const RootCube& root, ViewSet& set) {
                               addView(set, root.rootFromWorld({2, 3.5, 4}), {0, -1, 0});
                           }));
    all.push_back(viewCase("no-views", "empty lists, buffers and means", 0,
                           [](const RootCube&, ViewSet&) {}));
    all.push_back(
        viewCase("dead-views", "every slot of the set is dead", 0,
                 [](const RootCube&, ViewSet& set) { set.views.assign(kUsualViews, vplDead()); }));
    all.push_back(viewCase("coincident", "all views in one point: boxes and radii of size zero",
                           1.5, [](const RootCube& root, ViewSet& set) {
                               for (std::uint32_t i = 0; i < kUsualViews; ++i)
                                   addView(set, root.rootFromWorld({2, 2.5, 4}), {0, -1, 0});
                           }));
    all.push_back(
        viewCase("coincident-all-ways", "one point, every direction: no cone", 2.25,
                 [](const RootCube& root, ViewSet& set) {
                     for (std::uint32_t i = 0; i < kUsualViews; ++i)
                         addView(set, root.rootFromWorld({2, 2.5, 4}), randomDirection(7, i));
                 }));
    all.push_back(viewCase("antiparallel-pairs", "normals that cancel have no mean", 1.25,
                           [](const RootCube& root, ViewSet& set) {
                               for (std::uint32_t i = 0; i < kUsualViews; ++i)
                                   addView(set, root.rootFromWorld(inRoom(3, i / 2)),
                                           randomDirection(4, i / 2) * (i % 2 ? -1.0f : 1.0f));
                           }));
    all.push_back(viewCase("on-octree-planes",
                           "views on faces, edges and corners of cells of both octrees", 1.25,
                           [](const RootCube& root, ViewSet& set) {
                               for (std::uint32_t i = 0; set.views.size() < kUsualViews; ++i) {
                                   const vec3 p = root.rootFromWorld(inRoom(5, i));
                                   const float cells = i % 2 ? 8.0f : 128.0f;
                                   vec3 snapped = glm::round(p * cells) / cells;
                                   if (i % 3) snapped.x = p.x;
                                   vec3 n(0);
                                   n[static_cast<int>(i / 2 % 3)] = i % 2 ? 1.0f : -1.0f;
                                   addView(set, snapped, n);
                               }
                           }));
    all.push_back(viewCase("particles", "omnidirectional views see everything, nothing is culled",
                           1.25, [](const RootCube& root, ViewSet& set) {
                               for (std::uint32_t i = 0; i < kUsualViews; ++i)
                                   addView(set, root.rootFromWorld(inRoom(6, i)), vec3(0));
                           }));
    all.push_back(viewCase(
        "inside-geometry", "views inside the pillar and the chest light nothing", 1.75,
        [](const RootCube& root, ViewSet& set) {
            for (std::uint32_t i = 0; i < kUsualViews; ++i) {
                const dvec3 r(randomPoint(8, i));
                addView(
                    set,
                    root.rootFromWorld(i % 2 ? dvec3(2.65, 0.1, 2.25) + r * dvec3(0.5, 3.8, 0.5)
                                             : dvec3(5.65, 0.05, 3.65) + r * dvec3(1.2, 1, 1.1)),
                    randomDirection(9, i));
            }
        }));
    all.push_back({"thin-wall",
                   "views on both sides of a wall without thickness, 2e-5 of the edge off it",
                   [] {
                       return withViews(partitionedRoom(), [](const RootCube& root, ViewSet& set) {
                           for (std::uint32_t i = 0; i < kUsualViews; ++i) {
                               const dvec3 r(randomPoint(10, i));
                               const vec3 n(i % 2 ? 1.0f : -1.0f, 0, 0);
                               addView(set,
                                       root.rootFromWorld({3.9, 0.1 + 3.8 * r.y, 0.1 + 3 * r.z}) +
                                           n * kVplOffset,
                                       n);
                           }
                       });
                   },
                   1.25});
    for (const auto& [name, distance] :
         {std::pair{"facing-wall-1e-6", 1e-6f}, {"facing-wall-1e-3", 1e-3f}}) {
        all.push_back(
            {name, "views that look at a wall from just before it: nothing may pass",
             [distance = distance] {
                 return withViews(partitionedRoom(), [&](const RootCube& root, ViewSet& set) {
                     for (std::uint32_t i = 0; i < kUsualViews; ++i) {
                         const dvec3 r(randomPoint(10, i));
                         const vec3 n(i % 2 ? 1.0f : -1.0f, 0, 0);
                         addView(set,
                                 root.rootFromWorld({3.9, 0.1 + 3.8 * r.y, 0.1 + 3 * r.z}) +
                                     n * distance,
                                 -n);
                     }
                 });
             },
             2.5});
    }
    all.push_back(viewCase("on-the-surface", "views not lifted off their wall: at distance zero",
                           1.25, [](const RootCube& root, ViewSet& set) {
                               for (std::uint32_t i = 0; i < kUsualViews; ++i) {
                                   dvec3 p = inRoom(11, i);
                                   p.y = i % 2 ? 0 : 4;
                                   addView(set, root.rootFromWorld(p), {0, i % 2 ? 1 : -1, 0});
                               }
                           }));
    all.push_back(viewCase("at-the-cube's-corners", "keys at both ends of every axis", 4.25,
                           [](const RootCube&, ViewSet& set) {
                               for (std::uint32_t i = 0; i < 27; ++i) {
                                   const vec3 p = vec3(static_cast<float>(i % 3),
                                                       static_cast<float>(i / 3 % 3),
                                                       static_cast<float>(i / 9)) *
                                                  0.5f;
                                   if (p != vec3(0.5f))
                                       addView(set, p, glm::normalize(vec3(0.5f) - p));
                               }
                               addView(set, vec3(0.3f, 0.6f, 0.6f), {0, -1, 0});
                           }));
    all.push_back(viewCase(
        "outside-the-cube", "views where no cell is, and all the scene in a few texels", 15,
        [](const RootCube&, ViewSet& set) {
            for (std::uint32_t i = 0; i < 40; ++i)
                addView(set, vec3(0.5f) + 3.0f * randomDirection(12, i), -randomDirection(12, i));
            addView(set, vec3(0.3f, 0.6f, 0.6f), {0, -1, 0});
        }));
}

}  // namespace mv::stress
