#include "megaviews/measure/map_errors.h"

#include <spdlog/fmt/fmt.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "megaviews/settings/settings_table.h"
#include "shaders/shared/fuse.glsl"

namespace mv {
namespace {

constexpr double kRounding = 1e-5;
constexpr float kNoDepth = std::numeric_limits<float>::infinity();
constexpr float kOwnSurface = 10 * kVplOffset;

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
                  "Outside the depths that 5 x 5 rays through the whole texel find, or empty where "
                  "none of them leaves the scene.",
                  &E::outOfRange},
};

// What the map holds: without fusion the first texel that is not empty from the leaf up,
// measured from the leaf's centre.
float depthIn(const ReadMaps& read, std::uint32_t map, uint texel) {
    const uint res = static_cast<uint>(read.maps.mapRes);
    const auto at = [&](std::uint32_t m) {
        return read.maps.texels[std::size_t{m} * mapTexels(res) + texel];
    };
    uint bits = at(map);
    if (!read.parents.empty()) {
        std::uint32_t above = map;
        while (bits == kNone && (above = read.parents[above]) != kNone) {
            bits = recenterDepth(at(above), texel, res,
                                 read.maps.centers[above] - read.maps.centers[map]);
        }
    }
    return mapDepth(bits);
}

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

MapErrors mapErrors(const MapReferences& references, std::span<const View> views,
                    const ReadMaps& read) {
    const uint res = static_cast<uint>(references.mapRes);
    const std::size_t size = mapTexels(res);
    if (read.maps.mapRes != references.mapRes) return {};
    // Where both are infinite, nothing is compared.
    std::vector<float> exact(references.depth.size(), kNoDepth), found = exact;
    tbb::parallel_for(std::size_t{0}, references.slots.size(), [&](std::size_t k) {
        const std::uint32_t slot = references.slots[k];
        const std::uint32_t map = read.mapOfSlot.at(slot);
        if (map == kNone) return;
        const View& view = views[slot];
        const glm::vec3 normal = viewNormal(view);
        for (uint texel = 0; texel < size; ++texel) {
            const glm::vec3 direction = texelDirection(texel, res);
            const float depth = references.depth[k * size + texel];
            const bool behind =
                view.flags != kViewOmnidirectional && glm::dot(direction, normal) <= 0;
            if (behind || depth <= kOwnSurface || !texelReachable(texel, res)) continue;
            exact[k * size + texel] = depth;
            found[k * size + texel] = depthIn(read, map, texel);
        }
    });
    return compareMaps(found, exact, references.nearest, references.farthest);
}

std::string toText(const MapErrorReport& report, Method method) {
    std::string text = fmt::format("maps of {}, {} views", nameOf(method), report.views);
    for (const MapMetricInfo& info : mapMetricsTable()) {
        text += fmt::format(", {} {:.3g} %", info.name, info.percent(report.errors));
    }
    return text;
}

nlohmann::ordered_json toJson(const MapErrorReport& report) {
    nlohmann::ordered_json out = {{"views", report.views},
                                  {"texels", report.errors.texels},
                                  {"badTexels", report.errors.bad}};
    for (const MapMetricInfo& info : mapMetricsTable()) {
        out[std::string(info.name)] = report.errors.texels
                                          ? nlohmann::ordered_json(info.percent(report.errors))
                                          : nlohmann::ordered_json(nullptr);
    }
    return out;
}

}  // namespace mv
