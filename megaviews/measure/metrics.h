#pragma once
// The error metrics of pictures, named once: the command line, statistics files, panels and tables
// of the documentation take name, unit and domain from this list. Domains and constants are
// docs/metrics.md's.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "megaviews/measure/flip.h"
#include "megaviews/measure/rgb_image.h"

namespace mv {

enum class Metric { mse, relMse, mape, psnr, ssim, flip, hdrFlip, leaked, occluded };
enum class MetricDomain { radiance, display };

struct MetricInfo {
    Metric metric;
    std::string_view name;  // as options and JSON write it: "relmse"
    std::string_view label;
    std::string_view unit;  // empty: a plain number
    MetricDomain domain;
    bool higherIsBetter;
    std::string_view description;
    std::string_view source;
};

// In the order of Metric.
std::span<const MetricInfo> metricsTable();
const MetricInfo& infoOf(Metric metric);
const MetricInfo* findMetric(std::string_view name);

struct MetricValue {
    Metric metric;
    double
        value;  // in the metric's unit; infinite PSNR for equal pictures; NaN without good pixels
};

// A picture against its reference, of one size.
struct Comparison {
    RgbImage test, reference;
    bool linear = true;     // radiance; else display values
    double exposureEv = 0;  // of both as displayed
    ToneMap toneMap = ToneMap::aces;
};

// The same in the domains that both have: a reference of display values has no radiance.
struct Compared {
    std::optional<ImagePair> radiance;
    ImagePair display;
    double exposureEv = 0;
    ToneMap toneMap = ToneMap::aces;
};
Compared compared(const Comparison& comparison);

// Values of the metrics asked for, whose domains must be there. `flipMap`, if given, receives the
// map of `flip` or, if that is not asked for, of `hdrFlip`. `progress`, of these two, may throw
// Cancelled; the others take a moment.
std::vector<MetricValue> evaluate(const Compared& compared, std::span<const Metric> metrics,
                                  FlipMap* flipMap = nullptr, const Progress& progress = {});

// All metrics that `compared` allows, in the table's order.
std::vector<Metric> metricsOf(const Compared& compared);

}  // namespace mv
