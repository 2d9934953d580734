#pragma once
// Loads scenes on a worker thread: says where it is, can be cancelled, and leaves whatever is on
// screen alone until the new scene stands.

#include <atomic>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "app/common/scene_assets.h"

namespace mv {

class SceneLoader {
  public:
    SceneLoader() = default;
    ~SceneLoader();  // cancels and waits
    SceneLoader(const SceneLoader&) = delete;
    SceneLoader& operator=(const SceneLoader&) = delete;

    // Gives up what it was loading, if anything.
    void start(const std::string& scene, const Settings& settings,
               const std::filesystem::path& cacheDirectory);
    void cancel();
    bool loading() const { return current_ != nullptr; }

    struct Status {
        std::string stage;
        float fraction = 0;  // of the stage
    };
    Status status() const;
    const std::string& scene() const { return scene_; }     // of the last start
    const Settings& settings() const { return settings_; }  // the same

    // The scene once it is ready, else nullptr. Throws the loader's Error once if it failed.
    std::unique_ptr<SceneAssets> take();

  private:
    struct Job {
        std::mutex mutex;
        Status status{"starting", 0};
        std::atomic<bool> cancelled = false;
        std::future<std::unique_ptr<SceneAssets>> result;
    };
    std::unique_ptr<Job> current_;
    std::vector<std::unique_ptr<Job>> cancelled_;  // until their threads have noticed
    std::string scene_;
    Settings settings_;
};

}  // namespace mv
