#pragma once
// Measures pictures on another thread, so that a window never waits: the numbers of the errors
// panel and FLIP's picture. The metrics are those of the command line (megaviews/metrics).

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "megaviews/metrics/metrics.h"
#include "renderer/frame_renderer.h"

namespace mv {

// One picture against another of its size.
struct PictureComparison {
    RgbImage test, reference;
    bool linear = true;  // radiance; else display values
    double exposureEv = 0;
    ToneMap toneMap = ToneMap::aces;
};

// As FrameRenderer::setFlip wants it: right against left, bottom row first, NaN where bad.
std::vector<float> flipErrors(const PictureComparison& comparison, const Progress& progress = {});

// What a comparison that runs has come to.
class PictureErrors {
  public:
    PictureErrors();
    ~PictureErrors();  // abandons what it measures and waits for a part of a FLIP map
    PictureErrors(const PictureErrors&) = delete;
    PictureErrors& operator=(const PictureErrors&) = delete;

    // In place of what was measured before. version: names it.
    void start(std::uint64_t version, std::vector<PictureComparison> comparisons);
    // The same for FLIP's picture of one comparison, and for no number.
    void startFlip(std::uint64_t version, PictureComparison comparison);
    void stop();
    std::optional<std::uint64_t> version() const;  // of the last start
    bool busy() const;

    struct Result {
        std::vector<MetricValue> values;  // in the order of metricsTable(); more follow while busy
        std::uint64_t badPixels = 0;
    };
    std::vector<Result> results() const;  // one a comparison
    std::vector<float> flip() const;      // empty while busy

  private:
    struct Job;
    void run(std::uint64_t version, std::vector<PictureComparison> comparisons, bool flipOnly);
    std::shared_ptr<Job> job_;
    std::vector<std::shared_ptr<Job>> old_;
};

}  // namespace mv
