#pragma once
// Errors of depth maps: how many texels of a map made from shared pairs are off the depth that a
// ray finds through the texel's centre, and to which side.

#include <cstdint>
#include <span>
#include <string_view>

namespace mv {

// Counts over texels. `empty` and `filled` are texels in which only the reference, or only the map,
// has a surface; the shares below are over texels in which the reference has one.
struct MapErrors {
    std::uint64_t texels = 0;      // in which the reference has a surface
    std::uint64_t off2 = 0;        // off by more than 2 % of the reference's depth, or empty
    std::uint64_t off10 = 0;       // by more than 10 %, or empty
    std::uint64_t tooNear = 0;     // more than 2 % nearer: what lies behind is wrongly in shadow
    std::uint64_t tooFar = 0;      // more than 2 % farther: light leaks
    std::uint64_t empty = 0;       // no surface: light leaks without end
    std::uint64_t filled = 0;      // a surface where the reference has none
    std::uint64_t outOfRange = 0;  // outside what rays through the texel find, or empty;
                                   // 0 without ranges
    std::uint64_t bad = 0;         // NaN in map or reference; in no other count

    double share(std::uint64_t count) const {
        return texels ? static_cast<double>(count) / static_cast<double>(texels) : 0;
    }
    MapErrors& operator+=(const MapErrors& other);
};

// Depths of as many texels each, in any one unit, infinity where there is no surface (unreachable
// corners are that in both). `nearest` and `farthest` bound the depths that rays through the whole
// texel find; both may be empty. A depth in [nearest, farthest] counts as within, also by rounding
// (1e-5); a `farthest` of infinity means that some ray leaves the scene, and an empty texel is then
// within its range.
MapErrors compareMaps(std::span<const float> depths, std::span<const float> reference,
                      std::span<const float> nearest = {}, std::span<const float> farthest = {});

// The counts as statistics files, tables and the documentation name them. Each is given as a share
// of MapErrors::texels, in %.
struct MapMetricInfo {
    std::string_view name;  // "tooNear"
    std::string_view label, description;
    std::uint64_t MapErrors::*count;
    double percent(const MapErrors& errors) const { return 100 * errors.share(errors.*count); }
};
std::span<const MapMetricInfo> mapMetricsTable();

}  // namespace mv
