#include "megaviews/methods/vir/point_maps.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "shaders/shared/map_store.glsl"

namespace mv {
namespace {

constexpr float kLeastSpacing = 1.0f / 2048;
constexpr float kParallelDensity = 2;  // points for a texel

struct Corners {
    vec3 a, b, c;
};
Corners cornersOf(const BvhTriangle& t) {
    return {vec3(t.ax, t.ay, t.az), vec3(t.bx, t.by, t.bz), vec3(t.cx, t.cy, t.cz)};
}

// The points of a level, as the GPU numbers them.
std::vector<VirPoint> makePoints(const TriangleBvh& bvh, float spacing) {
    const BvhData data = bvh.data();
    std::vector<VirPoint> points;
    for (uint triangle = 0; triangle < bvh.triangles.size(); ++triangle) {
        const BvhTriangle& t = bvh.triangles[triangle];
        if (!bvh.isFirst(triangle)) continue;
        const auto [a, b, c] = cornersOf(t);
        const VirLattice lattice = virLattice(a, b, c, spacing, triangle);
        for (uint k = 0; k < lattice.columns * lattice.rows; ++k) {
            const vec3 weights = virWeights(lattice, k);
            const bool cutOut =
                (t.material & kMaterialMask) != 0 &&
                bvhMaskedOut(data, t.triangle, t.material & ~kMaterialMask, weights.y, weights.z);
            const vec3 p = virPosition(a, b, c, weights);
            if (!cutOut) points.push_back({p.x, p.y, p.z, triangle});
        }
    }
    return points;
}

void splat(const VirPoint& p, const Corners& corners, vec2 range, float spacing, const View& view,
           uint res, std::span<uint> map) {
    const vec3 origin = viewPosition(view), position(p.x, p.y, p.z);
    const vec3 offset = position - origin, facing = viewNormal(view);
    const float l = length3(offset);
    if (!virServes(range, view.flags, facing, offset, l)) return;
    const auto& [a, b, c] = corners;
    const VirSplat splat = virSplat(a, b, c, position, spacing, origin);
    const float radius = spacing * kVirLatticeRadius;
    for (uint face = 0; face < kMapFaces; ++face) {
        const uvec4 area = pointTexels(face, offset, l, radius, kVirReach, res);
        for (uint row = area.y; row < area.w; ++row) {
            for (uint column = area.x; column < area.z; ++column) {
                const uint texel = texelAt(face, column, row, res);
                if (!texelReachable(texel, res)) continue;
                map[texel] = std::min(map[texel], virDepth(splat, texel, res));
            }
        }
    }
}

void splat(const VirPoint& p, const Corners& corners, const ParallelView& view, vec3 centre,
           float spacing, float radius, uint res, std::span<uint> map) {
    const auto& [a, b, c] = corners;
    const ParallelSplat splat = parallelSplat(view, a - centre, b - centre, c - centre,
                                              vec3(p.x, p.y, p.z) - centre, spacing, radius, res);
    const uvec4 area = parallelTexels(splat, res);
    for (uint row = area.y; row < area.w; ++row) {
        for (uint column = area.x; column < area.z; ++column) {
            uint& texel = map[row * res + column];
            texel = std::min(texel, parallelDepth(splat, column, row));
        }
    }
}

// No more points than this lie so far apart.
std::uint64_t mostPoints(const TriangleBvh& bvh, double spacing) {
    double area = 0;
    for (std::size_t slot = 0; slot < bvh.triangles.size(); ++slot) {
        if (!bvh.isFirst(slot)) continue;
        const auto [a, b, c] = cornersOf(bvh.triangles[slot]);
        area += 0.5 * glm::length(glm::cross(glm::dvec3(b - a), glm::dvec3(c - a)));
    }
    // Rounding up columns and rows takes more than one each: at most four times as many.
    return static_cast<std::uint64_t>(4 * area / (spacing * spacing)) + bvh.triangles.size();
}

}  // namespace

float virSpacing(const VirOptions& options, std::uint32_t level) {
    const float texel =
        4 * kVirNearest * static_cast<float>(1u << level) / static_cast<float>(options.mapRes);
    return std::max(texel / std::sqrt(options.density), kLeastSpacing);
}

std::uint64_t virMostPoints(const TriangleBvh& bvh, const VirOptions& options) {
    return mostPoints(bvh, double{virSpacing(options, 0)});
}

ViewMaps pointMaps(const TriangleBvh& bvh, std::span<const View> views, const VirOptions& options) {
    const auto res = static_cast<uint>(options.mapRes);
    const MapStore store{res};
    ViewMaps out;
    out.mapRes = options.mapRes;
    out.texels.assign(mapWords(store, views.size()), kNone);
    for (const View& v : views) out.centers.push_back(viewPosition(v));
    for (uint level = 0; level < kVirLevels; ++level) {
        const float spacing = virSpacing(options, level);
        const std::vector<VirPoint> points = makePoints(bvh, spacing);
        tbb::parallel_for(std::size_t{0}, views.size(), [&](std::size_t i) {
            const std::span<uint> map(out.texels.data() + mapWordOf(store, i, 0), mapTexels(res));
            for (const VirPoint& p : points) {
                splat(p, cornersOf(bvh.triangles[p.triangle]), virRange(level), spacing, views[i],
                      res, map);
            }
        });
    }
    return out;
}

float parallelSpacing(float radius, int mapRes) {
    const float texel = parallelTexel(radius, static_cast<uint>(mapRes));
    return std::max(texel / std::sqrt(kParallelDensity), kLeastSpacing);
}

std::uint64_t parallelMostPoints(const TriangleBvh& bvh, float radius, int mapRes) {
    return mostPoints(bvh, double{parallelSpacing(radius, mapRes)});
}

std::vector<std::uint32_t> parallelMaps(const TriangleBvh& bvh, std::span<const vec3> directions,
                                        vec3 centre, float radius, int mapRes) {
    const auto res = static_cast<uint>(mapRes);
    const std::size_t texels = std::size_t{res} * res;
    const float spacing = parallelSpacing(radius, mapRes);
    const std::vector<VirPoint> points = makePoints(bvh, spacing);
    std::vector<std::uint32_t> maps(directions.size() * texels, kNone);
    tbb::parallel_for(std::size_t{0}, directions.size(), [&](std::size_t i) {
        const ParallelView view = parallelView(directions[i]);
        const std::span<uint> map(maps.data() + i * texels, texels);
        for (const VirPoint& p : points) {
            splat(p, cornersOf(bvh.triangles[p.triangle]), view, centre, spacing, radius, res, map);
        }
    });
    return maps;
}

}  // namespace mv
