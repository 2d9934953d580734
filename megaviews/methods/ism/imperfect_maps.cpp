#include "megaviews/methods/ism/imperfect_maps.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "shaders/shared/map_store.glsl"

namespace mv {
namespace {

void splat(const SurfacePoints& surface, const View& view, const IsmOptions& options, float radius,
           std::span<uint> map) {
    const auto res = static_cast<uint>(options.mapRes);
    const uint stratum = ismStratum(surface.points.size(), options.pointsPerView);
    for (uint k = 0; k < options.pointsPerView && stratum > 0; ++k) {
        const SurfacePoint& p = surface.points[ismPoint(view.slot, k, stratum, options.seed)];
        const vec3 offset(p.x - view.positionX, p.y - view.positionY, p.z - view.positionZ);
        const vec3 normal = viewNormal(view);
        const float l = length3(offset);
        if (!ismSees(p.present, view.flags, normal, offset, l)) continue;
        const uint bits = floatBitsToUint(l);
        for (uint face = 0; face < kMapFaces; ++face) {
            const uvec4 area = pointTexels(face, offset, l, radius, kIsmReach, res);
            for (uint row = area.y; row < area.w; ++row) {
                for (uint column = area.x; column < area.z; ++column) {
                    const uint texel = texelAt(face, column, row, res);
                    if (texelReachable(texel, res)) map[texel] = std::min(map[texel], bits);
                }
            }
        }
    }
}

// Texel (i, j) of a face of a level; level 0 is the map itself.
struct Pyramid {
    std::span<uint> map, mips;
    uint res;
    uint& at(uint level, uint face, uint i, uint j) const {
        const uint r = res >> level;
        const uint texel = (face * r + j) * r + i;
        return level == 0 ? map[texel] : mips[mipOffset(level, res) + texel];
    }
};

void pullPush(const Pyramid& p) {
    uint levels = 0;
    while ((p.res >> levels) > 1) ++levels;
    for (uint level = 1; level <= levels; ++level) {
        const uint r = p.res >> level;
        for (uint face = 0; face < kMapFaces; ++face) {
            for (uint j = 0; j < r; ++j) {
                for (uint i = 0; i < r; ++i) {
                    const auto finer = [&](uint di, uint dj) {
                        return p.at(level - 1, face, 2 * i + di, 2 * j + dj);
                    };
                    p.at(level, face, i, j) =
                        ismPull(uvec4(finer(0, 0), finer(1, 0), finer(0, 1), finer(1, 1)), level);
                }
            }
        }
    }
    for (uint level = levels; level-- > 0;) {
        const uint r = p.res >> level;
        for (uint face = 0; face < kMapFaces; ++face) {
            for (uint j = 0; j < r; ++j) {
                for (uint i = 0; i < r; ++i) {
                    const uvec2 a = ismNeighbours(i, r / 2), b = ismNeighbours(j, r / 2);
                    const auto coarser = [&](uint x, uint y) {
                        return p.at(level + 1, face, x, y);
                    };
                    uint& texel = p.at(level, face, i, j);
                    texel = ismPush(texel,
                                    uvec4(coarser(a.x, b.x), coarser(a.y, b.x), coarser(a.x, b.y),
                                          coarser(a.y, b.y)),
                                    level);
                }
            }
        }
    }
}

}  // namespace

float ismRadius(double area, std::uint32_t pointsPerView) {
    return static_cast<float>(std::sqrt(area / (double{kPi} * pointsPerView)));
}

ViewMaps imperfectMaps(const SurfacePoints& surface, std::span<const View> views,
                       const IsmOptions& options) {
    assert(options.pointsPerView > 0);
    const auto res = static_cast<uint>(options.mapRes);
    const MapStore store{res};
    ViewMaps out;
    out.mapRes = options.mapRes;
    out.texels.assign(mapWords(store, views.size()), kNone);
    out.centers.resize(views.size());
    const float radius = ismRadius(surface.area, options.pointsPerView);
    using Range = tbb::blocked_range<std::size_t>;
    tbb::parallel_for(Range(0, views.size()), [&](const Range& range) {
        std::vector<uint> mips(mipTexels(res));
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const View& view = views[i];
            out.centers[i] = viewPosition(view);
            const std::span<uint> map(out.texels.data() + mapWordOf(store, i, 0), mapTexels(res));
            splat(surface, view, options, radius, map);
            if (options.fill) pullPush({map, mips, res});
        }
    });
    return out;
}

}  // namespace mv
