#include "app/viewer/reference_worker.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "app/viewer/references.h"

namespace mv {

namespace {

// Rows are shown this often, so that copying them costs little.
constexpr std::chrono::milliseconds kShowEvery{150};

}  // namespace

// A request of its own, and what has come of it; what is not const is guarded by Impl::mutex.
struct ReferenceWorker::Job {
    const int side;
    const std::shared_ptr<const SceneAssets> assets;
    const Settings settings;
    const FrameInput input;
    const Emitters emitters;
    const std::vector<View> views;
    const std::vector<Receiver> receivers;
    std::atomic<bool> cancelled = false;

    std::vector<glm::vec3> irradiance = {};  // not handed on yet
    bool complete = false, told = false;
    Status status{"waiting", 0};
    std::optional<Error> error = {};

    bool hasNews() const { return !irradiance.empty() || ((complete || error) && !told); }
};

struct ReferenceWorker::Impl {
    const std::filesystem::path folder;
    std::shared_ptr<const SceneAssets> assets;

    mutable std::mutex mutex;
    std::condition_variable changed;
    std::deque<std::shared_ptr<Job>> queue;
    std::array<std::shared_ptr<Job>, 2> jobs;  // the last of each side
    std::shared_ptr<Job> current;              // that the thread works on
    bool closing = false;

    // Of the thread alone.
    std::shared_ptr<const SceneAssets> madeFor;
    std::unique_ptr<References> references;
    std::chrono::steady_clock::time_point shown;

    std::thread thread;

    explicit Impl(std::filesystem::path keptIn) : folder(std::move(keptIn)) {
        thread = std::thread([this] { run(); });
    }
    ~Impl() {
        {
            const std::lock_guard lock(mutex);
            closing = true;
            for (const auto& job : queue) job->cancelled = true;
            if (current) current->cancelled = true;
        }
        changed.notify_all();
        thread.join();
    }

    void run() {
        std::unique_lock lock(mutex);
        while (true) {
            changed.wait(lock, [&] { return closing || !queue.empty(); });
            if (closing) return;
            current = queue.front();
            queue.pop_front();
            lock.unlock();
            make(*current);
            lock.lock();
            current.reset();
        }
    }

    void make(Job& job) {
        if (job.cancelled) return;
        std::vector<glm::vec3> irradiance;
        std::optional<Error> error;
        try {
            if (madeFor != job.assets) {
                references = std::make_unique<References>(
                    *job.assets, folder,
                    [this](std::string_view stage, float fraction) { note(stage, fraction); });
                references->setWatch([this](const auto& rows) { show(rows); });
                madeFor = job.assets;
            }
            irradiance = references->irradiance(
                {job.settings, job.input, job.emitters, job.views, job.receivers});
        } catch (const Cancelled&) {
            return;
        } catch (const Error& e) {
            error = e;
        } catch (const std::exception& e) {
            error.emplace(ExitCode::impossible, e.what());
        }
        const std::lock_guard lock(mutex);
        job.irradiance = std::move(irradiance);
        job.complete = !error;
        job.error = error;
    }

    void note(std::string_view stage, float fraction) {
        if (current->cancelled) throw Cancelled();
        const std::lock_guard lock(mutex);
        current->status = {std::string(stage), fraction};
    }

    void show(const std::vector<glm::vec3>& rows) {
        const auto now = std::chrono::steady_clock::now();
        if (now - shown < kShowEvery) return;
        shown = now;
        const std::lock_guard lock(mutex);
        current->irradiance = rows;
    }

    void abandon(int side) {
        auto& job = jobs.at(static_cast<std::size_t>(side));
        if (!job) return;
        job->cancelled = true;
        std::erase(queue, job);
        job.reset();
    }
};

ReferenceWorker::ReferenceWorker(std::filesystem::path folder)
    : impl_(std::make_unique<Impl>(std::move(folder))) {}
ReferenceWorker::~ReferenceWorker() = default;

void ReferenceWorker::setScene(std::shared_ptr<const SceneAssets> assets) {
    const std::lock_guard lock(impl_->mutex);
    for (const int side : {0, 1}) impl_->abandon(side);
    impl_->assets = std::move(assets);
}

void ReferenceWorker::begin(const ReferenceRequest& request, int side) {
    std::shared_ptr<Job> job(new Job{side,
                                     impl_->assets,
                                     request.settings,
                                     request.input,
                                     request.emitters,
                                     {request.views.begin(), request.views.end()},
                                     {request.receivers.begin(), request.receivers.end()}});
    {
        const std::lock_guard lock(impl_->mutex);
        impl_->abandon(side);
        impl_->jobs.at(static_cast<std::size_t>(side)) = job;
        impl_->queue.push_back(std::move(job));
    }
    impl_->changed.notify_all();
}

void ReferenceWorker::end(int side) {
    const std::lock_guard lock(impl_->mutex);
    impl_->abandon(side);
}

ReferenceMaker::Light ReferenceWorker::more(int side) {
    const std::lock_guard lock(impl_->mutex);
    const auto& job = impl_->jobs.at(static_cast<std::size_t>(side));
    if (!job) return {};
    job->told = job->complete;
    return {std::exchange(job->irradiance, {}), job->complete};
}

bool ReferenceWorker::busy(int side) const {
    const std::lock_guard lock(impl_->mutex);
    const auto& job = impl_->jobs.at(static_cast<std::size_t>(side));
    return job && !job->complete && !job->error;
}

bool ReferenceWorker::news() const {
    const std::lock_guard lock(impl_->mutex);
    return std::any_of(impl_->jobs.begin(), impl_->jobs.end(),
                       [](const auto& job) { return job && job->hasNews(); });
}

ReferenceWorker::Status ReferenceWorker::status() const {
    const std::lock_guard lock(impl_->mutex);
    for (const auto& job : {impl_->current, impl_->jobs[0], impl_->jobs[1]}) {
        if (job && !job->cancelled && !job->complete && !job->error) return job->status;
    }
    return {};
}

std::optional<ReferenceWorker::Failure> ReferenceWorker::takeFailure() {
    const std::lock_guard lock(impl_->mutex);
    for (const auto& job : impl_->jobs) {
        if (!job || !job->error || job->told) continue;
        job->told = true;
        return Failure{job->side, *job->error};
    }
    return std::nullopt;
}

}  // namespace mv
