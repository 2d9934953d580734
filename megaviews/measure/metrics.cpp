#include "megaviews/measure/metrics.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "megaviews/measure/pixel_errors.h"
#include "megaviews/measure/ssim.h"

namespace mv {
namespace {

using enum MetricDomain;

constexpr std::array kMetrics = {
    MetricInfo{Metric::mse, "mse", "MSE", "", radiance, false,
               "Mean squared error of linear radiance, in its unit squared.", "definition"},
    MetricInfo{Metric::relMse, "relmse", "relMSE", "", radiance, false,
               "Mean squared error relative to the reference's square plus 1e-2 of its squared "
               "mean: dark surfaces count as much as bright ones.",
               "after Rousselle et al. 2011"},
    MetricInfo{Metric::mape, "mape", "MAPE", "%", radiance, false,
               "Mean absolute error relative to the reference plus 1e-2 of its mean.",
               "definition"},
    MetricInfo{Metric::psnr, "psnr", "PSNR", "dB", display, true,
               "Peak signal to noise ratio of display values; infinite for equal pictures.",
               "definition"},
    MetricInfo{Metric::ssim, "ssim", "SSIM", "", display, true,
               "Structural similarity of display luma, at most 1.", "Wang et al. 2004"},
    MetricInfo{Metric::flip, "flip", "FLIP", "", display, false,
               "Mean difference seen when flipping between the pictures on a screen, 0 to 1.",
               "Andersson et al. 2020"},
    MetricInfo{Metric::hdrFlip, "hdr-flip", "HDR-FLIP", "", radiance, false,
               "FLIP, at each pixel the worst over the exposures that the reference calls for.",
               "Andersson et al. 2021"},
    MetricInfo{Metric::leaked, "leaked", "Leaked light", "%", radiance, false,
               "Luminance above the reference's, summed, of the reference's sum; noise adds to it.",
               "definition"},
    MetricInfo{Metric::occluded, "occluded", "Lost light", "%", radiance, false,
               "Luminance below the reference's, summed, of the reference's sum; noise adds to it.",
               "definition"},
};

// FLIP's map is asked for beside its mean.
double keep(FlipMap map, FlipMap* kept) {
    const double mean = map.mean;
    if (kept) *kept = std::move(map);
    return mean;
}

double valueOf(Metric metric, const Compared& compared, FlipMap* flipMap, FlipMap* hdrFlipMap,
               const Progress& progress) {
    assert(infoOf(metric).domain == display || compared.radiance);
    switch (metric) {
        case Metric::mse:
            return meanSquaredError(*compared.radiance);
        case Metric::relMse:
            return relativeMeanSquaredError(*compared.radiance);
        case Metric::mape:
            return 100 * meanAbsolutePercentageError(*compared.radiance);
        case Metric::psnr:
            return peakSignalToNoiseRatio(compared.display);
        case Metric::ssim:
            return structuralSimilarity(compared.display);
        case Metric::flip:
            return keep(flip(compared.display, kFlipPixelsPerDegree, progress), flipMap);
        case Metric::hdrFlip:
            return keep(hdrFlip(*compared.radiance, kFlipPixelsPerDegree, progress), hdrFlipMap);
        case Metric::leaked:
            return 100 * energyError(*compared.radiance).leaked;
        case Metric::occluded:
            return 100 * energyError(*compared.radiance).occluded;
    }
    return 0;
}

}  // namespace

std::span<const MetricInfo> metricsTable() { return kMetrics; }

const MetricInfo& infoOf(Metric metric) { return kMetrics[static_cast<std::size_t>(metric)]; }

const MetricInfo* findMetric(std::string_view name) {
    const auto found = std::find_if(kMetrics.begin(), kMetrics.end(),
                                    [&](const MetricInfo& info) { return info.name == name; });
    return found == kMetrics.end() ? nullptr : &*found;
}

Compared compared(const Comparison& c) {
    if (!c.linear) {
        return {std::nullopt, ImagePair(c.test, c.reference), c.exposureEv, c.toneMap};
    }
    return {ImagePair(c.test, c.reference),
            ImagePair(displayImage(c.test, c.exposureEv, c.toneMap),
                      displayImage(c.reference, c.exposureEv, c.toneMap)),
            c.exposureEv, c.toneMap};
}

std::vector<Metric> metricsOf(const Compared& compared) {
    std::vector<Metric> out;
    for (const MetricInfo& info : kMetrics) {
        if (info.domain == display || compared.radiance) out.push_back(info.metric);
    }
    return out;
}

std::vector<MetricValue> evaluate(const Compared& compared, std::span<const Metric> metrics,
                                  FlipMap* flipMap, const Progress& progress) {
    const bool hasFlip = std::find(metrics.begin(), metrics.end(), Metric::flip) != metrics.end();
    std::vector<MetricValue> out;
    for (const Metric metric : metrics) {
        const double value =
            valueOf(metric, compared, flipMap, hasFlip ? nullptr : flipMap, progress);
        out.push_back({metric, value});
    }
    return out;
}

}  // namespace mv
