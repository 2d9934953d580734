#include "megaviews/metrics/map_errors.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <array>
#include <cassert>
#include <cmath>

namespace mv {
namespace {

constexpr double kRounding = 1e-5;

using E = MapErrors;
constexpr std::array kMapMetrics = {
    MapMetricInfo{"off2", "Off by 2 %", "Off by more than 2 % of the exact depth, or empty.",
                  &E::off2},
    MapMetricInfo{"off10", "Off by 10 %", "Off by more than 10 % of the exact depth, or empty.",
                  &E::off10},
    MapMetricInfo{"tooNear", "Too near",
                  "More than 2 % too near: what lies behind is wrongly in shadow.", &E::tooNear},
    MapMetricInfo{"tooFar", "Too far", "More than 2 % too far: light leaks.", &E::tooFar},
    MapMetricInfo{"empty", "Empty", "Without a surface where there is one: light leaks.",
                  &E::empty},
    MapMetricInfo{"filled", "Filled",
                  "With a surface where there is none, for every hundred texels that have one.",
                  &E::filled},
    MapMetricInfo{"outOfRange", "Out of range",
                  "Outside the depths that 5 x 5 rays through the whole texel find, or empty.",
                  &E::outOfRange},
};

}  // namespace

std::span<const MapMetricInfo> mapMetricsTable() { return kMapMetrics; }

MapErrors& MapErrors::operator+=(const MapErrors& other) {
    texels += other.texels;
    off2 += other.off2;
    off10 += other.off10;
    tooNear += other.tooNear;
    tooFar += other.tooFar;
    empty += other.empty;
    filled += other.filled;
    outOfRange += other.outOfRange;
    bad += other.bad;
    return *this;
}

MapErrors compareMaps(std::span<const float> depths, std::span<const float> reference,
                      std::span<const float> nearest, std::span<const float> farthest) {
    assert(depths.size() == reference.size());
    assert(nearest.size() == farthest.size());
    assert(nearest.empty() || nearest.size() == reference.size());
    // Whole numbers add up to the same in any order.
    const auto count = [&](const tbb::blocked_range<std::size_t>& range, MapErrors errors) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const double depth = depths[i], exact = reference[i];
            if (std::isnan(depth) || std::isnan(exact)) {
                ++errors.bad;
                continue;
            }
            if (std::isinf(exact)) {
                errors.filled += !std::isinf(depth);
                continue;
            }
            ++errors.texels;
            const bool isEmpty = std::isinf(depth);
            errors.empty += isEmpty;
            errors.off2 += isEmpty || std::abs(depth - exact) > 0.02 * exact;
            errors.off10 += isEmpty || std::abs(depth - exact) > 0.10 * exact;
            errors.tooNear += depth < 0.98 * exact;
            errors.tooFar += !isEmpty && depth > 1.02 * exact;
            if (nearest.empty()) continue;
            const double low = nearest[i], high = farthest[i];
            errors.outOfRange += depth < low * (1 - kRounding) || depth > high * (1 + kRounding);
        }
        return errors;
    };
    return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, depths.size(), 1 << 14),
                                MapErrors{}, count,
                                [](MapErrors a, const MapErrors& b) { return a += b; });
}

}  // namespace mv
