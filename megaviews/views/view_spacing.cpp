#include "megaviews/views/view_spacing.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "shaders/shared/morton.glsl"
#include "shaders/shared/view_spacing.glsl"

namespace mv {

std::vector<std::uint32_t> alongMortonCurve(std::span<const View> views) {
    std::vector<std::uint64_t> keys;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const View& v = views[i];
        if (v.flags == kViewDead) continue;
        const uint key = mortonKeyOf(viewPosition(v));
        keys.push_back(std::uint64_t{key} << 32 | i);
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> order;
    order.reserve(keys.size());
    for (const std::uint64_t key : keys) order.push_back(static_cast<std::uint32_t>(key));
    return order;
}

float leastClampDistance(std::span<const View> views, const std::vector<std::uint32_t>& order) {
    if (order.empty()) return 0;
    const auto count = static_cast<uint>(order.size());
    const auto positionOf = [&](uint i) {
        return viewPosition(views[order[spreadView(i, count)]]);
    };
    std::array<float, kSpreadPairs> distances2{};
    for (uint i = 0; i < kSpreadPairs; ++i) {
        distances2[i] = spreadDistance2(positionOf(i), positionOf(i + kSpreadPairs));
    }
    const auto median = distances2.begin() + kSpreadPairs / 2;
    std::nth_element(distances2.begin(), median, distances2.end());
    return leastClampDistance(*median, count);
}

std::vector<float> clampDistances(std::span<const View> views) {
    const std::vector<std::uint32_t> order = alongMortonCurve(views);
    std::vector<float> distances(views.size(), 0.0f);
    const float least = leastClampDistance(views, order);
    const auto keyOf = [&](std::uint32_t i) { return mortonKeyOf(viewPosition(views[i])); };
    const auto crowdAt = [&](std::size_t i, std::size_t begin, std::size_t end) {
        const uint key = keyOf(order[i]);
        const auto looked = static_cast<uint>(end - begin);
        if (keyOf(order[begin]) != key || keyOf(order[end - 1]) != key) {
            return crowdOf(looked, 0, least);
        }
        const auto first = std::partition_point(order.begin(), order.end(),
                                                [&](std::uint32_t j) { return keyOf(j) < key; });
        const auto last = std::partition_point(first, order.end(),
                                               [&](std::uint32_t j) { return keyOf(j) == key; });
        return crowdOf(looked, static_cast<uint>(last - first), least);
    };
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, order.size(), 256), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                const View& view = views[order[i]];
                NearestViews nearest = noNearestViews();
                const std::size_t begin = i - std::min<std::size_t>(i, kSpacingWindow);
                const std::size_t end = std::min(i + kSpacingWindow + 1, order.size());
                for (std::size_t j = begin; j < end; ++j) {
                    if (j != i) nearest = withNeighbour(nearest, view, views[order[j]]);
                }
                distances[order[i]] = clampDistanceOf(view, nearest, crowdAt(i, begin, end));
            }
        });
    return distances;
}

}  // namespace mv
