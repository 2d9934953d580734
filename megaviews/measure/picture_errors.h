#pragma once
// Measures pictures on another thread, so that a window never waits: the numbers of the errors
// panel and FLIP's picture. The metrics are those of the command line (megaviews/measure).

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "megaviews/core/error.h"
#include "megaviews/measure/metrics.h"

namespace mv {

// FLIP of a comparison, an error for each pixel, bottom row first, NaN where it is bad.
std::vector<float> flipErrors(const Comparison& comparison, const Progress& progress = {});

// What a comparison that runs has come to.
class PictureErrors {
  public:
    PictureErrors();
    ~PictureErrors();  // abandons what it measures and waits for a part of a FLIP map
    PictureErrors(const PictureErrors&) = delete;
    PictureErrors& operator=(const PictureErrors&) = delete;

    // In place of what was measured before. version: names it.
    void start(std::uint64_t version, std::vector<Comparison> comparisons);
    // The same for FLIP's picture of one comparison, and for no number.
    void startFlip(std::uint64_t version, Comparison comparison);
    void stop();
    std::optional<std::uint64_t> version() const;  // of the last start
    bool busy() const;

    struct Result {
        std::vector<MetricValue> values;  // in the order of metricsTable(); more follow while busy
        std::uint64_t badPixels = 0;
    };
    std::vector<Result> results() const;  // one a comparison
    std::vector<float> flip() const;      // empty while busy
    std::optional<Error> takeFailure();   // why it ended early; once

  private:
    struct Job;
    void run(std::uint64_t version, std::vector<Comparison> comparisons, bool flipOnly);
    std::shared_ptr<Job> job_;
    std::vector<std::shared_ptr<Job>> old_;
};

}  // namespace mv
