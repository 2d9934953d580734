#pragma once
// Errors of depth maps: how many texels of a map made from shared pairs are off the depth that a
// ray finds through the texel's centre, and to which side (docs/metrics.md, "Depth maps").

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "megaviews/maps/view_maps.h"
#include "megaviews/measure/reference_store.h"

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

// Errors of the maps that a method gave these views, texel against texel: the depth in a direction
// from the map's centre, which is that of the view's leaf, against the depth in the same direction
// from the view. So views that share a map err by sharing it. Texels that nothing asks for are left
// out: those whose centre lies behind a view that lights one hemisphere (views without a normal
// light all), and those that show the view's own surface, within ten times the distance that views
// are lifted off it.
MapErrors mapErrors(const MapReferences& references, std::span<const View> views,
                    const ReadMaps& maps);

struct MapErrorReport {
    std::uint64_t views = 0;
    MapErrors errors;
};
// "maps of manylods, 9 views, off2 12.3 %, ..."
std::string toText(const MapErrorReport& report, Method method);
// {"views", "texels", "badTexels", and mapMetricsTable()'s names in %}; null without texels.
nlohmann::ordered_json toJson(const MapErrorReport& report);

}  // namespace mv
