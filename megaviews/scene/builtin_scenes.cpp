#include "megaviews/scene/builtin_scenes.h"

#include <array>
#include <string>

#include "megaviews/core/error.h"
#include "megaviews/core/text.h"
#include "megaviews/scene/builtin_mesh.h"
#include "megaviews/scene/load_scene.h"
#include "megaviews/scene/rigged_scene.h"

namespace mv {
namespace builtin {

// Measurements of the Cornell box in metres, turned so that the open side faces +z.
void makeCornell(Scene& scene) {
    MeshBuilder mesh(scene);
    auto white = mesh.addMaterial("white", {0.73f, 0.71f, 0.68f});
    auto red = mesh.addMaterial("red", {0.63f, 0.065f, 0.05f});
    auto green = mesh.addMaterial("green", {0.14f, 0.45f, 0.091f});
    auto p = [](double x, double y, double z) {
        return Vec((278 - x) / 100, y / 100, (279.6 - z) / 100);
    };
    // Room: floor, ceiling, back, then the coloured sides.
    mesh.use(white);
    mesh.quad(p(552.8, 0, 0), p(0, 0, 0), p(0, 0, 559.2), p(549.6, 0, 559.2));
    mesh.quad(p(556, 548.8, 0), p(556, 548.8, 559.2), p(0, 548.8, 559.2), p(0, 548.8, 0));
    mesh.quad(p(549.6, 0, 559.2), p(0, 0, 559.2), p(0, 548.8, 559.2), p(556, 548.8, 559.2));
    mesh.use(green);
    mesh.quad(p(0, 0, 559.2), p(0, 0, 0), p(0, 548.8, 0), p(0, 548.8, 559.2));
    mesh.use(red);
    mesh.quad(p(552.8, 0, 0), p(549.6, 0, 559.2), p(556, 548.8, 559.2), p(556, 548.8, 0));
    // Blocks: a top given counter-clockwise from above, four sides, no bottom.
    mesh.use(white);
    auto block = [&](std::array<glm::dvec2, 4> c, double height) {
        auto top = [&](std::size_t i) { return p(c[i % 4].x, height, c[i % 4].y); };
        auto foot = [&](std::size_t i) { return p(c[i % 4].x, 0, c[i % 4].y); };
        mesh.quad(top(0), top(1), top(2), top(3));
        for (std::size_t i = 0; i < 4; ++i) mesh.quad(foot(i), foot(i + 1), top(i + 1), top(i));
    };
    block({{{130, 65}, {82, 225}, {240, 272}, {290, 114}}}, 165);
    block({{{423, 247}, {265, 296}, {314, 456}, {472, 406}}}, 330);
    mesh.finish();

    // A lamp under the ceiling that shines downwards and circles slowly.
    Light lamp;
    lamp.name = "lamp";
    lamp.type = LightType::spot;
    lamp.intensity = glm::vec3(34, 26, 16);
    lamp.innerConeRad = 0.35;
    lamp.outerConeRad = 1.48;
    addMovingLight(scene, lamp, 12, [](double turns) {
        Vec at(1.15 * sinTurns(turns), 5.3, 1.15 * cosTurns(turns) - 1.15);
        return std::pair(at, at - Vec(0, 1, 0));
    });
    addCamera(scene, "front", {0, 2.73, 10.796}, {0, 2.73, 0}, 39.3);
    addCamera(scene, "inside", {2.2, 3.6, 2.5}, {-0.9, 1.7, -1.6}, 62);
}

}  // namespace builtin

namespace {

struct Entry {
    const char* name;
    int version;  // raised when the geometry changes: caches are keyed by it
    void (*make)(Scene&);
};
constexpr std::array<Entry, 5> kEntries = {{
    {"cornell", 1, builtin::makeCornell},
    {"atrium", 2, builtin::makeAtrium},
    {"cathedral", 2, builtin::makeCathedral},
    {"hairball", 1, builtin::makeHairball},
    {"door", 1, builtin::makeDoor},
}};

}  // namespace

std::vector<std::string> builtinNames() {
    std::vector<std::string> names;
    for (const Entry& entry : kEntries) names.push_back(std::string("builtin:") + entry.name);
    return names;
}

Scene makeBuiltin(const std::string& name, const LoadOptions& options) {
    std::string plain = name.rfind("builtin:", 0) == 0 ? name.substr(8) : name;
    for (const Entry& e : kEntries) {
        if (plain == e.name) {
            report(options.progress, "scene", 0.0f);
            Scene scene;
            scene.name = "builtin:" + plain;
            scene.hash = scene.name + "/" + std::to_string(e.version);
            e.make(scene);
            if (scene.moving && findAnimation(scene, options.animation) < 0) {
                scene.contentHash = scene.moving->contentHash;
                scene.moving = nullptr;
            }
            poseScene(scene, options.timeS);
            report(options.progress, "scene", 1.0f);
            return scene;
        }
    }
    throw Error(ExitCode::input, "no scene is called \"builtin:" + plain + "\"; there are " +
                                     joined(builtinNames(), ", "));
}

}  // namespace mv
