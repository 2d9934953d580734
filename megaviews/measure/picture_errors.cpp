#include "megaviews/measure/picture_errors.h"

#include <atomic>
#include <future>
#include <limits>
#include <mutex>
#include <utility>

#include "megaviews/core/error.h"

namespace mv {
std::vector<float> flipErrors(const Comparison& comparison, const Progress& progress) {
    const ImagePair display = compared(comparison).display;
    const FlipMap map = flip(display, kFlipPixelsPerDegree, progress);
    const auto width = static_cast<std::size_t>(display.width());
    std::vector<float> out;
    out.reserve(map.errors.size());
    for (std::size_t row = static_cast<std::size_t>(display.height()); row-- > 0;) {
        for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
            out.push_back(display.isBad(i) ? std::numeric_limits<float>::quiet_NaN()
                                           : map.errors[i]);
        }
    }
    return out;
}

struct PictureErrors::Job {
    std::uint64_t version = 0;
    std::atomic<bool> cancelled = false, done = false;
    mutable std::mutex mutex;
    std::vector<Result> results;
    std::vector<float> flip;
    std::optional<Error> failure;
    std::future<void> thread;  // the last member: it is waited for first

    void check() const {
        if (cancelled) throw Cancelled();
    }
    void measure(const std::vector<Comparison>& comparisons, const Progress& progress) {
        for (std::size_t i = 0; i < comparisons.size(); ++i) {
            check();
            const Compared both = compared(comparisons[i]);
            {
                const std::lock_guard lock(mutex);
                results[i].badPixels = both.display.badPixels();
            }
            for (const Metric metric : metricsOf(both)) {
                check();
                const auto values = evaluate(both, {&metric, 1}, nullptr, progress);
                const std::lock_guard lock(mutex);
                results[i].values.push_back(values.front());
            }
        }
    }
};

PictureErrors::PictureErrors() = default;
PictureErrors::~PictureErrors() { stop(); }

void PictureErrors::start(std::uint64_t version, std::vector<Comparison> comparisons) {
    run(version, std::move(comparisons), false);
}

void PictureErrors::startFlip(std::uint64_t version, Comparison comparison) {
    std::vector<Comparison> one;
    one.push_back(std::move(comparison));
    run(version, std::move(one), true);
}

void PictureErrors::run(std::uint64_t version, std::vector<Comparison> comparisons, bool flipOnly) {
    stop();
    job_ = std::make_shared<Job>();
    job_->version = version;
    job_->results.resize(comparisons.size());
    // The job outlives its thread: it is kept until the thread is done.
    Job* job = job_.get();
    job->thread = std::async(std::launch::async, [job, flipOnly, all = std::move(comparisons)] {
        const Progress progress = [job](std::string_view, float) { job->check(); };
        try {
            if (flipOnly) {
                std::vector<float> errors = flipErrors(all.front(), progress);
                const std::lock_guard lock(job->mutex);
                job->flip = std::move(errors);
            } else {
                job->measure(all, progress);
            }
        } catch (const Cancelled&) {
            // Nobody asks for the rest.
        } catch (const std::exception& e) {
            const std::lock_guard lock(job->mutex);
            job->failure =
                Error(ExitCode::impossible, std::string("errors cannot be measured: ") + e.what());
        }
        job->done = true;
    });
}

void PictureErrors::stop() {
    std::erase_if(old_, [](const auto& job) { return job->done.load(); });
    if (!job_) return;
    job_->cancelled = true;
    old_.push_back(std::move(job_));
    job_.reset();
}

std::optional<std::uint64_t> PictureErrors::version() const {
    return job_ ? std::optional(job_->version) : std::nullopt;
}

std::optional<Error> PictureErrors::takeFailure() {
    if (!job_) return std::nullopt;
    const std::lock_guard lock(job_->mutex);
    return std::exchange(job_->failure, std::nullopt);
}

bool PictureErrors::busy() const { return job_ && !job_->done; }

std::vector<PictureErrors::Result> PictureErrors::results() const {
    if (!job_) return {};
    const std::lock_guard lock(job_->mutex);
    return job_->results;
}

std::vector<float> PictureErrors::flip() const {
    if (!job_ || !job_->done) return {};
    const std::lock_guard lock(job_->mutex);
    return job_->flip;
}

}  // namespace mv
