#include "megaviews/views/pick_view.h"

#include <tuple>

namespace mv {

std::optional<std::uint32_t> pickView(std::span<const View> views, const PickRay& ray,
                                      float surfaceDistance) {
    // A surface slanted by 75 degrees is this much farther at the ray's border than at its axis.
    const float deepest = surfaceDistance + 4 * ray.radiusAt(surfaceDistance) + 1e-4f;
    std::optional<std::tuple<float, float, std::uint32_t>> best;
    for (const View& view : views) {
        if (view.flags == kViewDead) continue;
        const glm::vec3 way = viewPosition(view) - ray.origin;
        const float along = glm::dot(way, ray.direction);
        if (!(along > 0) || along > deepest) continue;
        const float aside = glm::length(way - ray.direction * along);
        const float radius = ray.radiusAt(along);
        if (!(aside <= radius)) continue;
        const std::tuple candidate(radius > 0 ? aside / radius : 0.0f, along, view.slot);
        if (!best || candidate < *best) best = candidate;
    }
    if (!best) return std::nullopt;
    return std::get<2>(*best);
}

}  // namespace mv
