#include "megaviews/views/view_spacing.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>

#include "shaders/shared/morton.glsl"
#include "shaders/shared/view_spacing.glsl"

namespace mv {

std::vector<std::uint32_t> alongMortonCurve(std::span<const View> views) {
    std::vector<std::uint64_t> keys;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const View& v = views[i];
        if (v.flags == kViewDead) continue;
        const uint key = mortonKeyOf(vec3(v.positionX, v.positionY, v.positionZ));
        keys.push_back(std::uint64_t{key} << 32 | i);
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> order;
    order.reserve(keys.size());
    for (const std::uint64_t key : keys) order.push_back(static_cast<std::uint32_t>(key));
    return order;
}

std::vector<float> clampDistances(std::span<const View> views) {
    const std::vector<std::uint32_t> order = alongMortonCurve(views);
    std::vector<float> distances(views.size(), 0.0f);
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, order.size(), 256), [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                const View& view = views[order[i]];
                NearestViews nearest = noNearestViews();
                const std::size_t end = std::min(i + kSpacingWindow + 1, order.size());
                for (std::size_t j = i - std::min<std::size_t>(i, kSpacingWindow); j < end; ++j) {
                    if (j != i) nearest = withNeighbour(nearest, view, views[order[j]]);
                }
                distances[order[i]] =
                    clampDistanceOf(view, nearest, static_cast<uint>(order.size()));
            }
        });
    return distances;
}

}  // namespace mv
