#include "megaviews/views/view_spacing.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>

#include "shaders/shared/morton.glsl"
#include "shaders/shared/view_spacing.glsl"

namespace mv {

std::vector<float> clampDistances(std::span<const View> views) {
    std::vector<std::uint64_t> order;  // as the view hierarchy sorts them
    for (std::size_t i = 0; i < views.size(); ++i) {
        const View& v = views[i];
        if (v.flags == kViewDead) continue;
        const uint key = mortonKeyOf(vec3(v.positionX, v.positionY, v.positionZ));
        order.push_back(std::uint64_t{key} << 32 | i);
    }
    std::sort(order.begin(), order.end());
    const auto at = [&](std::size_t i) -> const View& { return views[order[i] & 0xFFFFFFFFu]; };

    std::vector<float> distances(views.size(), 0.0f);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, order.size(), 256), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            NearestViews nearest = noNearestViews();
            const std::size_t end = std::min(i + kSpacingWindow + 1, order.size());
            for (std::size_t j = i - std::min<std::size_t>(i, kSpacingWindow); j < end; ++j) {
                if (j != i) nearest = withNeighbour(nearest, at(i), at(j));
            }
            distances[order[i] & 0xFFFFFFFFu] = clampDistanceOf(at(i), nearest);
        }
    });
    return distances;
}

}  // namespace mv
