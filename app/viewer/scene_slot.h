#pragma once
// The scene on screen and the one that is being loaded on another thread: what each was asked for
// with, and what comes into effect once it is there.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/common/scene_assets.h"
#include "app/common/state.h"
#include "app/viewer/scene_loader.h"
#include "renderer/frame_renderer.h"

namespace mv {

class SceneSlot {
  public:
    explicit SceneSlot(std::filesystem::path cacheDirectory);  // empty: no cache

    // Each replaces what is being loaded. What is on screen stays until take().
    void load(const std::string& scene, const Settings& settings);  // perhaps the same, loaded anew
    void open(const std::string& scene, const Settings& settings);  // to be seen from the start
    void restore(const State& state);  // what else the state says comes into effect with its scene
    // Octree depth, animation and a file of views belong to the load: the same scene is loaded anew
    // if the settings ask for others.
    void reloadWhereNeeded(const Settings& settings);
    void cancel();
    // What moves, to a time; nobody may read the scene meanwhile.
    void pose(double timeS) {
        if (assets_) assets_->pose(timeS);
    }
    // Takes the settings back to those that the scene on screen was loaded with.
    void keepLoaded(Settings& settings) const;

    // The same file again, in another octree or for another of its scenes.
    bool reloading() const { return loading() && assets_ && loader_.scene() == name_; }
    bool loading() const { return loader_.loading(); }
    SceneLoader::Status status() const { return loader_.status(); }

    // Puts a scene that is ready into the renderer; the old one goes only when the new one stands
    // there. Throws the loader's and the renderer's errors, once; then the old one stays.
    struct Change {
        bool sameFile = false;          // as that on screen
        bool sameScene = false;         // and loaded anew: camera and history stay
        bool opened = false;            // by open()
        std::optional<State> restored;  // with it
    };
    std::optional<Change> take(FrameRenderer& renderer);

    // The scene on screen; null and empty if there is none.
    std::shared_ptr<const SceneAssets> assets() const { return assets_; }
    const std::string& name() const { return name_; }
    // Hash of the file of views that was loaded with it; empty: there is none.
    const std::string& viewsHash() const { return viewsHash_; }

  private:
    std::filesystem::path cacheDirectory_;
    SceneLoader loader_;
    std::optional<State> restoring_;
    bool opening_ = false;
    std::shared_ptr<SceneAssets> assets_;
    std::string name_, viewsHash_;
    Settings loaded_;  // that assets_ was loaded with
};

}  // namespace mv
