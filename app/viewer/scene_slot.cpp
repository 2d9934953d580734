#include "app/viewer/scene_slot.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "megaviews/io/ply.h"

namespace mv {
namespace {

std::optional<ViewSet> readViews(const std::string& file, const RootCube& root) {
    if (file.empty()) return std::nullopt;
    std::vector<std::string> warnings;
    ViewSet views = loadViews(file, root, &warnings);
    for (const std::string& warning : warnings) spdlog::warn("{}", warning);
    return views;
}

}  // namespace

SceneSlot::SceneSlot(std::filesystem::path cacheDirectory)
    : cacheDirectory_(std::move(cacheDirectory)) {}

void SceneSlot::load(const std::string& scene, const Settings& settings) {
    restoring_.reset();
    opening_ = false;
    loader_.start(scene, settings, cacheDirectory_);
}

void SceneSlot::open(const std::string& scene, const Settings& settings) {
    load(scene, settings);
    opening_ = true;
}

void SceneSlot::restore(const State& state) {
    load(state.scene, state.settings);
    restoring_ = state;
}

void SceneSlot::reloadWhereNeeded(const Settings& settings) {
    Settings kept = settings;
    keepLoaded(kept);
    if (assets_ && !loading() && kept != settings) load(name_, settings);
}

void SceneSlot::cancel() {
    loader_.cancel();
    restoring_.reset();
}

void SceneSlot::keepLoaded(Settings& settings) const {
    if (!assets_) return;
    settings.scene.octreeDepth = loaded_.scene.octreeDepth;
    settings.scene.tree = loaded_.scene.tree;
    settings.scene.fileScene = loaded_.scene.fileScene;
    settings.scene.variant = loaded_.scene.variant;
    settings.scene.animation = loaded_.scene.animation;
    settings.views.file = loaded_.views.file;
}

std::optional<SceneSlot::Change> SceneSlot::take(FrameRenderer& renderer) {
    // What was to come into effect is forgotten if this throws.
    std::optional<State> restoring = std::exchange(restoring_, std::nullopt);
    std::shared_ptr<SceneAssets> assets = loader_.take();
    if (!assets) {
        restoring_ = std::move(restoring);
        return std::nullopt;
    }
    std::optional<ViewSet> views = readViews(loader_.settings().views.file, assets->scene.root);
    std::string viewsHash = views ? views->fileHash : std::string();
    std::optional<ViewSet> viewsBefore = renderer.takeViews();
    try {
        renderer.setScene(assets->scene, assets->bvh, assets->hierarchy);
    } catch (...) {
        if (assets_) renderer.setScene(assets_->scene, assets_->bvh, assets_->hierarchy);
        renderer.setViews(std::move(viewsBefore));
        throw;
    }
    renderer.setViews(std::move(views));
    const bool sameFile = assets_ && name_ == loader_.scene() &&
                          loaded_.scene.fileScene == loader_.settings().scene.fileScene;
    const bool sameScene = sameFile && !restoring && !opening_;
    if (!sameScene) renderer.forgetExposure();
    assets_ = std::move(assets);
    name_ = loader_.scene();
    viewsHash_ = std::move(viewsHash);
    loaded_ = loader_.settings();
    return Change{sameFile, sameScene, std::exchange(opening_, false), std::move(restoring)};
}

}  // namespace mv
