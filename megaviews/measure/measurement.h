#pragma once
// What --reference, --metrics, --threshold and --diff ask for, and what comes of it, in the words
// of standard output, of statistics files and of a picture's metadata. Names and units are those of
// megaviews/measure/metrics.h.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "megaviews/measure/metrics.h"

namespace mv {

// The least or, if lower is better, the largest value that passes, in the metric's unit.
struct Threshold {
    Metric metric;
    double value;
};

struct MeasureOptions {
    std::string referenceFile;
    std::vector<Metric> metrics;  // empty: all that the reference allows
    std::vector<Threshold> thresholds;
    std::string diffFile;  // .png: FLIP's map in colours; .exr: its values
};

// "psnr,flip", or "all" for none in particular; "psnr:25". Throw Error(ExitCode::usage), opening
// with `where`.
std::vector<Metric> metricsFromText(const std::string& text, const std::string& where);
Threshold thresholdFromText(const std::string& text, const std::string& where);

// What has to be computed, thresholds and the map of --diff included. Throws Error(ExitCode::usage)
// if a metric needs radiance and the reference, which is named, has none.
std::vector<Metric> wantedMetrics(const MeasureOptions& options, bool hasRadiance);

struct Measurement {
    std::string reference;  // as it was given
    double exposureEv = 0;  // of both pictures as displayed
    ToneMap toneMap = ToneMap::aces;
    std::uint64_t badPixels = 0;  // not finite in either, left out
    std::vector<MetricValue> values;
    std::vector<Threshold> thresholds;
};

// The metrics of a comparison, as evaluate(); reference and thresholds are the caller's.
Measurement measure(const Compared& compared, std::span<const Metric> metrics,
                    FlipMap* flipMap = nullptr, const Progress& progress = {});

double valueOf(const Measurement& measurement, Metric metric);  // NaN if it was not asked for

// "psnr 24.8 dB", one line a metric.
std::string toText(const Measurement& measurement);

// "psnr 24.8 dB < 25 dB" for each threshold that is missed, joined by "; "; empty if all are met.
std::string missedThresholds(const Measurement& measurement);

// {"reference", "exposureEv", "toneMap", "badPixels", "values": {"psnr": 24.8}, "thresholds"}; a
// value that is no number, or without bound, is null.
nlohmann::ordered_json toJson(const Measurement& measurement);

}  // namespace mv
