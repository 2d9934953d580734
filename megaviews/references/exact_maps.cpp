#include "megaviews/references/exact_maps.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "shaders/shared/paraboloid.glsl"

namespace mv {
namespace {

using glm::dvec2;
using glm::dvec3;
constexpr float kNothing = std::numeric_limits<float>::infinity();
constexpr std::size_t kMostTexelsAtOnce = 1 << 14;

// The direction of any point of a face, unit: texelRay for more than centres.
dvec3 rayThrough(dvec2 uv, bool back) {
    const double rho2 = glm::dot(uv, uv);
    return dvec3(back ? rho2 - 1 : 1 - rho2, 2 * uv.x, 2 * uv.y) / (1 + rho2);
}

// Embree finds the triangle; where along the ray its plane stands is computed again in double.
float depthAlong(const EmbreeScene& embree, glm::vec3 origin, dvec3 direction) {
    const auto hit = embree.intersect(origin, glm::vec3(direction), 0, kInfinity);
    if (!hit) return kNothing;
    const BvhTriangle& t = embree.bvh().triangles[hit->slot];
    const dvec3 a(t.ax, t.ay, t.az), b(t.bx, t.by, t.bz), c(t.cx, t.cy, t.cz);
    const dvec3 normal = glm::cross(b - a, c - a);
    const double slope = glm::dot(normal, direction);
    const double exact = glm::dot(normal, a - dvec3(origin)) / slope;
    // A sliver seen edge-on has no plane to speak of.
    const double found = hit->t;
    if (!(std::abs(exact - found) <= 1e-4 * found + 1e-6)) return hit->t;
    return static_cast<float>(exact);
}

}  // namespace

ExactMaps exactMaps(const EmbreeScene& embree, std::span<const glm::vec3> positions, int mapRes,
                    bool ranges, const Progress& progress) {
    const auto res = static_cast<uint>(mapRes);
    const std::size_t texels = mapTexels(res);
    ExactMaps out;
    out.mapRes = mapRes;
    out.depth.assign(positions.size() * texels, kNothing);
    if (ranges) {
        out.nearest = out.depth;
        out.farthest = out.depth;
    }
    const auto texel = [&](std::size_t map, uint k) {
        if (!texelReachable(k, res)) return;
        const std::size_t at = map * texels + k;
        const dvec2 center(texelCenter(k, res));
        const bool back = k >= res * res;
        out.depth[at] = depthAlong(embree, positions[map], rayThrough(center, back));
        if (!ranges) return;
        out.nearest[at] = out.farthest[at] = out.depth[at];
        const double step = 2.0 / (static_cast<double>(mapRes) * kExactMapSamples);
        const int half = kExactMapSamples / 2;
        for (int j = -half; j <= half; ++j) {
            for (int i = -half; i <= half; ++i) {
                if (i == 0 && j == 0) continue;
                const float d = depthAlong(embree, positions[map],
                                           rayThrough(center + step * dvec2(i, j), back));
                out.nearest[at] = std::min(out.nearest[at], d);
                out.farthest[at] = std::max(out.farthest[at], d);
            }
        }
    };

    // Blocks of texels, between which the work can be cancelled: some tens, but none that takes
    // long.
    const std::size_t all = out.depth.size();
    const std::size_t block = std::clamp<std::size_t>(all / 64, 1, kMostTexelsAtOnce);
    for (std::size_t first = 0; first < all; first += block) {
        report(progress, "exact maps", static_cast<float>(first) / static_cast<float>(all));
        using Range = tbb::blocked_range<std::size_t>;
        tbb::parallel_for(Range(first, std::min(first + block, all), 64), [&](const Range& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                texel(i / texels, static_cast<uint>(i % texels));
            }
        });
    }
    report(progress, "exact maps", 1);
    return out;
}

}  // namespace mv
