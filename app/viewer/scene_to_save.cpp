#include "app/viewer/scene_to_save.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "megaviews/views/sky.h"
#include "renderer/frame_renderer.h"

namespace mv {
namespace {

// Menus and --camera find a camera by its name.
void add(std::vector<PosedCamera>& cameras, PosedCamera camera, const std::string& name) {
    const auto taken = [&](const std::string& wanted) {
        return std::any_of(cameras.begin(), cameras.end(),
                           [&](const PosedCamera& other) { return other.camera.name == wanted; });
    };
    camera.camera.name = name;
    for (int i = 2; taken(camera.camera.name); ++i) {
        camera.camera.name = name + " " + std::to_string(i);
    }
    cameras.push_back(std::move(camera));
}

// The settings have no word for its lens where the scene's first camera has another kind.
PosedCamera cameraOf(const PictureInfo& picture, const Settings& settings) {
    PosedCamera camera = posedCamera(*picture.assets, settings, picture.timeS);
    auto& halfHeight = camera.camera.orthoHalfHeight;
    halfHeight.reset();
    if (picture.camera.orthoHalfHeight > 0) {
        halfHeight =
            static_cast<double>(picture.camera.orthoHalfHeight) * picture.assets->scene.root.edge;
    }
    return camera;
}

std::vector<PosedCamera> camerasOf(const PictureInfo& picture, Settings settings,
                                   const SceneBookmarks* bookmarks) {
    const SceneAssets& assets = *picture.assets;
    std::vector<PosedCamera> own = assets.scene.camerasAt(picture.timeS, assets.animation);
    const auto shown = std::find_if(own.begin(), own.end(), [&](const PosedCamera& camera) {
        return frameCamera(camera, assets.scene.root) == picture.camera;
    });
    std::vector<PosedCamera> cameras;
    add(cameras, cameraOf(picture, settings), shown == own.end() ? "Picture" : shown->camera.name);
    if (shown != own.end()) own.erase(shown);
    std::erase_if(own, [](const PosedCamera& camera) { return camera.camera.isDefault; });

    settings.camera.name.clear();
    for (std::size_t i = 0; bookmarks && i < kBookmarks; ++i) {
        if (!bookmarks->cameras[i]) continue;
        useBookmark(settings, *bookmarks->cameras[i]);
        add(cameras, posedCamera(assets, settings, picture.timeS),
            "Bookmark " + std::to_string(i + 1));
    }
    for (const PosedCamera& camera : own) add(cameras, camera, camera.camera.name);
    return cameras;
}

}  // namespace

SceneToSave sceneToSave(const PictureInfo& picture, const SceneBookmarks* bookmarks) {
    const Settings settings = stateOf(picture).settings;  // with the camera filled in
    std::vector<PosedLight> lights =
        posedLights(*picture.assets, settings.scene.lights, picture.timeS);
    if (replacesPlacedLight(settings.scene.environment)) {
        std::erase_if(lights, [](const PosedLight& posed) { return posed.light.isDefault; });
    }
    return {.scene = picture.assets->scene,
            .lights = std::move(lights),
            .cameras = camerasOf(picture, settings, bookmarks),
            .aspect = static_cast<double>(settings.resolution.width) / settings.resolution.height,
            .lightScale = settings.scene.lightScale};
}

}  // namespace mv
