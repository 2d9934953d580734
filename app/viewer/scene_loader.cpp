#include "app/viewer/scene_loader.h"

#include <algorithm>
#include <chrono>

#include "megaviews/core/error.h"

namespace mv {
namespace {

template <typename Future>
bool ready(const Future& future) {
    return future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

SceneLoader::~SceneLoader() { cancel(); }

void SceneLoader::start(const std::string& scene, const Settings& settings,
                        const std::filesystem::path& cacheDirectory) {
    cancel();
    scene_ = scene;
    settings_ = settings;
    current_ = std::make_unique<Job>();
    Job* job = current_.get();
    const Progress progress = [job](std::string_view stage, float fraction) {
        if (job->cancelled) throw Cancelled();
        const std::lock_guard lock(job->mutex);
        job->status = {std::string(stage), fraction};
    };
    job->result = std::async(std::launch::async, [scene, settings, cacheDirectory, progress] {
        return loadAssets(scene, settings, cacheDirectory, progress);
    });
}

void SceneLoader::cancel() {
    std::erase_if(cancelled_, [](const auto& job) { return ready(job->result); });
    if (!current_) return;
    current_->cancelled = true;
    cancelled_.push_back(std::move(current_));
}

SceneLoader::Status SceneLoader::status() const {
    if (!current_) return {};
    const std::lock_guard lock(current_->mutex);
    return current_->status;
}

std::unique_ptr<SceneAssets> SceneLoader::take() {
    if (!current_ || !ready(current_->result)) return nullptr;
    const std::unique_ptr<Job> job = std::move(current_);
    return job->result.get();
}

}  // namespace mv
