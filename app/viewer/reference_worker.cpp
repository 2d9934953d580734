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
// Jobs by what they are for: pictures of both sides, then maps of both.
constexpr std::size_t kPlaces = 4, kMapsPlace = 2;

std::size_t pictureOf(int side) { return static_cast<std::size_t>(side); }
std::size_t mapsOf(int side) { return kMapsPlace + static_cast<std::size_t>(side); }

}  // namespace

// A request of its own, and what has come of it; what is not const is guarded by Impl::mutex.
struct ReferenceWorker::Job {
    const std::size_t place;  // in Impl::jobs
    const std::shared_ptr<const SceneAssets> assets;
    const ReferenceRequest request;  // of exact maps: without receivers
    const std::size_t mapCount = 0;
    std::atomic<bool> cancelled = false;

    std::vector<glm::vec3> irradiance = {};  // not handed on yet
    std::shared_ptr<const MapReferences> maps = {};
    bool complete = false, told = false;  // of its failure
    Status status{"waiting", 0};
    std::optional<Error> error = {};

    bool ofMaps() const { return place >= kMapsPlace; }
    bool busy() const { return !complete && !error; }
};

struct ReferenceWorker::Impl {
    const std::filesystem::path folder;
    std::shared_ptr<const SceneAssets> assets;

    mutable std::mutex mutex;
    std::condition_variable changed;
    std::deque<std::shared_ptr<Job>> queue;
    std::array<std::shared_ptr<Job>, kPlaces> jobs;  // the last of each place
    std::shared_ptr<Job> current;                    // that the thread works on
    bool closing = false;

    // The thread alone uses these.
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
            const auto outlived = [&] { return madeFor && madeFor != assets; };
            changed.wait(lock, [&] { return closing || !queue.empty() || outlived(); });
            if (closing) return;
            if (outlived()) letGo();
            if (queue.empty()) continue;
            current = queue.front();
            queue.pop_front();
            lock.unlock();
            make(*current);
            lock.lock();
            current.reset();
            changed.notify_all();
        }
    }

    // Lets go of the scene that references were made for.
    void letGo() {
        references.reset();
        madeFor.reset();
    }

    void make(Job& job) {
        if (job.cancelled) return;
        std::vector<glm::vec3> irradiance;
        std::shared_ptr<const MapReferences> maps;
        std::optional<Error> error;
        try {
            if (madeFor != job.assets) {
                references = std::make_unique<References>(
                    *job.assets, folder,
                    [this](std::string_view stage, float fraction) { note(stage, fraction); });
                references->setWatch([this](const auto& rows) { show(rows); });
                madeFor = job.assets;
            }
            if (job.ofMaps()) {
                maps = std::make_shared<const MapReferences>(
                    references->maps(job.request, job.mapCount));
            } else {
                irradiance = references->irradiance(job.request);
            }
        } catch (const Cancelled&) {
            return;
        } catch (const Error& e) {
            error = e;
        } catch (const std::exception& e) {
            error.emplace(ExitCode::impossible, e.what());
        }
        const std::lock_guard lock(mutex);
        job.irradiance = std::move(irradiance);
        job.maps = std::move(maps);
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

    void begin(std::shared_ptr<Job> job) {
        {
            const std::lock_guard lock(mutex);
            abandon(job->place);
            jobs.at(job->place) = job;
            queue.push_back(std::move(job));
        }
        changed.notify_all();
    }

    void abandon(std::size_t place) {
        auto& job = jobs.at(place);
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
    for (std::size_t place = 0; place < kPlaces; ++place) impl_->abandon(place);
    impl_->assets = std::move(assets);
    impl_->changed.notify_all();
}

void ReferenceWorker::rest() {
    std::unique_lock lock(impl_->mutex);
    for (std::size_t place = 0; place < kPlaces; ++place) impl_->abandon(place);
    if (impl_->current) impl_->current->cancelled = true;
    impl_->changed.wait(lock, [&] { return !impl_->current; });
    impl_->letGo();  // the thread reads it under no lock, but rests
}

void ReferenceWorker::begin(ReferenceRequest request, int side) {
    impl_->begin(std::shared_ptr<Job>(new Job{pictureOf(side), impl_->assets, std::move(request)}));
}

void ReferenceWorker::beginMaps(ReferenceRequest request, std::size_t count, int side) {
    impl_->begin(
        std::shared_ptr<Job>(new Job{mapsOf(side), impl_->assets, std::move(request), count}));
}

void ReferenceWorker::end(int side) {
    const std::lock_guard lock(impl_->mutex);
    impl_->abandon(pictureOf(side));
}

void ReferenceWorker::endMaps(int side) {
    const std::lock_guard lock(impl_->mutex);
    impl_->abandon(mapsOf(side));
}

std::shared_ptr<const MapReferences> ReferenceWorker::maps(int side) const {
    const std::lock_guard lock(impl_->mutex);
    const auto& job = impl_->jobs.at(mapsOf(side));
    return job ? job->maps : nullptr;
}

ReferenceWorker::Light ReferenceWorker::more(int side) {
    const std::lock_guard lock(impl_->mutex);
    const auto& job = impl_->jobs.at(pictureOf(side));
    if (!job) return {};
    return {std::exchange(job->irradiance, {}), job->complete};
}

bool ReferenceWorker::busy(int side) const {
    const std::lock_guard lock(impl_->mutex);
    const auto& job = impl_->jobs.at(pictureOf(side));
    return job && job->busy();
}

bool ReferenceWorker::busyWithMaps() const {
    const std::lock_guard lock(impl_->mutex);
    return std::any_of(impl_->jobs.begin() + kMapsPlace, impl_->jobs.end(),
                       [](const auto& job) { return job && job->busy(); });
}

ReferenceWorker::Status ReferenceWorker::status() const {
    const std::lock_guard lock(impl_->mutex);
    const auto making = [](const auto& job) { return job && !job->cancelled && job->busy(); };
    if (making(impl_->current)) return impl_->current->status;
    const auto job = std::find_if(impl_->jobs.begin(), impl_->jobs.end(), making);
    return job != impl_->jobs.end() ? (*job)->status : Status();
}

std::optional<ReferenceWorker::Failure> ReferenceWorker::takeFailure() {
    const std::lock_guard lock(impl_->mutex);
    for (const auto& job : impl_->jobs) {
        if (!job || !job->error || job->told) continue;
        job->told = true;
        return Failure{static_cast<int>(job->place % kMapsPlace), job->ofMaps(), *job->error};
    }
    return std::nullopt;
}

}  // namespace mv
