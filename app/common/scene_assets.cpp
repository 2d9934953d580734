#include "app/common/scene_assets.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "megaviews/core/error.h"
#include "megaviews/hierarchy/sample_tree.h"
#include "megaviews/scene/framing.h"
#include "megaviews/scene/load_scene.h"
#include "megaviews/scene/outlines.h"
#include "megaviews/scene/rigged_scene.h"
#include "megaviews/settings/light_placement.h"
#include "megaviews/views/view_set.h"
#include "renderer/frame_renderer.h"

namespace mv {
namespace {

bool hasSunOfFile(const std::string& name, const Scene& scene) {
    return !name.starts_with("builtin:") &&
           std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
               return light.type == LightType::directional && !light.isDefault;
           });
}

glm::dvec3 vectorOf(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

// A camera that withCamera() wrote down is made of unit vectors of floats: normalised once more,
// they would change in their last bit, and the picture with them.
bool isOne(double length) { return std::abs(length - 1) < 1e-6; }

}  // namespace

std::pair<glm::vec3, glm::vec3> SceneAssets::bounds() const {
    if (scene.positions.empty()) return {glm::vec3(0), glm::vec3(0)};
    glm::vec3 low = scene.positions.front(), high = low;
    for (const glm::vec3& p : scene.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return {low, high};
}

void SceneAssets::pose(double timeS) {
    if (!poseScene(scene, timeS)) return;
    bvh.refit();
    hierarchy.refit(scene);
}

std::unique_ptr<SceneAssets> loadAssets(const std::string& name, const Settings& settings,
                                        const std::filesystem::path& cacheDirectory,
                                        const Progress& progress) {
    auto assets = loadAssetsWithoutHierarchy(name, settings, progress);
    buildHierarchy(*assets, settings, cacheDirectory, progress);
    return assets;
}

std::unique_ptr<SceneAssets> loadAssetsWithoutHierarchy(const std::string& name,
                                                        const Settings& settings,
                                                        const Progress& progress) {
    auto assets = std::make_unique<SceneAssets>();
    LoadOptions options;
    options.timeS = settings.scene.timeS;
    options.sceneIndex = settings.scene.fileScene.value_or(-1);
    options.variant = settings.scene.variant;
    options.animation = settings.scene.animation;
    options.progress = progress;
    const auto load = [&] {
        assets->scene = loadScene(name, options);
        // Trees are built where the surface of what moves is largest, whatever time is asked for.
        poseForTrees(assets->scene);
        assets->bvh = TriangleBvh::build(assets->scene, progress);
    };
    load();
    options.without = outlineMaterials(assets->bvh);
    if (!options.without.empty()) {
        load();
        for (const std::uint32_t material : options.without) {
            assets->scene.notes.push_back("material " + std::to_string(material) + " '" +
                                          assets->scene.materials[material].name +
                                          "' draws outlines by a hull that faces inwards: it is "
                                          "left out, since it would block all light");
        }
    }
    // Camera and light as at the beginning, whatever time is asked for.
    if (assets->scene.moving && poseScene(assets->scene, 0)) assets->bvh.refit();
    placeDefaults(assets->scene, assets->bvh);
    if (settings.scene.environment.source == "auto" && hasSunOfFile(name, assets->scene)) {
        assets->scene.notes.push_back(
            "a sun in the file, and glTF holds no sky: --environment sky puts one around it");
    }
    for (const std::string& note : assets->scene.notes) spdlog::info("{}", note);
    findVariant(assets->scene, settings.scene.variant);  // refuse one that there is not
    assets->animation = findAnimation(assets->scene, settings.scene.animation);
    posedCamera(*assets, settings, settings.scene.timeS);  // refuse a bad camera before long work
    return assets;
}

void buildHierarchy(SceneAssets& assets, const Settings& settings,
                    const std::filesystem::path& cacheDirectory, const Progress& progress) {
    if (assets.scene.moving) {
        poseForTrees(assets.scene);
        assets.bvh.refit();
    }
    const int levels = settings.scene.octreeDepth;
    assets.hierarchy =
        settings.scene.tree == SceneTree::binary
            ? buildSampleTree(assets.scene, assets.bvh, levels, progress)
            : buildOrLoad(assets.scene, assets.bvh, levels, cacheDirectory, progress);
    assets.pose(settings.scene.timeS);
}

PosedCamera posedCamera(const SceneAssets& assets, const Settings& settings, double timeS) {
    const double edge = assets.scene.root.edge;
    const int index = findCamera(assets.scene, settings.camera.name);
    const std::vector<PosedCamera> cameras = assets.scene.camerasAt(timeS, assets.animation);
    PosedCamera camera = cameras.at(static_cast<std::size_t>(index < 0 ? 0 : index));
    if (settings.camera.position) camera.position = vectorOf(*settings.camera.position);
    if (settings.camera.target) {
        const glm::dvec3 toTarget = vectorOf(*settings.camera.target) - camera.position;
        const double distance = glm::length(toTarget);
        if (!(distance > 0)) {
            throw Error(ExitCode::usage, "--camera-target: the camera stands at this very point");
        }
        camera.forward = toTarget / (isOne(distance / edge) ? edge : distance);
    }
    const bool given = settings.camera.up != Settings{}.camera.up;
    if (settings.camera.target || given) {
        glm::dvec3 up = vectorOf(settings.camera.up);
        const auto alongUp = [&] {
            return !(glm::length(glm::cross(camera.forward, up)) > 1e-9 * glm::length(up));
        };
        if (!given && alongUp()) up = {0, 0, -1};  // a plan: what is in front lies below
        if (alongUp()) {
            throw Error(ExitCode::usage,
                        "--camera-up: the camera looks along it; give another direction");
        }
        const glm::dvec3 right = glm::cross(camera.forward, up);
        const double length = glm::length(right);
        const bool exact = isOne(glm::length(up)) && isOne(1 + glm::dot(up, camera.forward));
        camera.up = exact ? up : glm::cross(right / length, camera.forward);
    }
    if (settings.camera.fovDeg) {
        camera.camera.yfovRad = glm::radians(*settings.camera.fovDeg);
        camera.camera.orthoHalfHeight.reset();
    }
    return camera;
}

std::vector<PosedLight> posedLights(const SceneAssets& assets, const std::string& placements,
                                    double timeS) {
    return placedLights(assets.scene, timeS, assets.animation,
                        parseLightPlacements(placements, "lights"));
}

FrameCamera chosenCamera(const Settings& settings, const SceneAssets& assets, double timeS) {
    return frameCamera(posedCamera(assets, settings, timeS), assets.scene.root);
}

}  // namespace mv
