#pragma once
// Maps asked by direction, before fusion and after it, and what a node covers of them.

#include <cstdint>
#include <limits>
#include <span>

#include "megaviews/maps/view_maps.h"
#include "shaders/shared/fuse.glsl"
#include "shaders/shared/pair.glsl"

namespace mv {

// Depth that a fused map holds in a direction of any length; infinity where it is empty.
inline float queryFused(const ViewMaps& maps, std::uint32_t map, glm::vec3 direction) {
    const MapStore store{static_cast<uint>(maps.mapRes)};
    return mapDepth(
        loadMapTexel(store, maps.texels, map, texelOfDirection(direction, store.mapRes)));
}

// The last texel that is not empty on the way from the root to the leaf of a sorted view, in maps
// before fusion; infinity if all are empty. recentered: measured from the leaf's centre instead of
// the centre of the node that saw it.
inline float queryUnfused(std::span<const std::uint32_t> nodeTexels, const ViewHierarchy& views,
                          int mapRes, std::uint32_t sortedView, glm::vec3 direction,
                          bool recentered = true) {
    const uint res = static_cast<uint>(mapRes);
    const uint texel = texelOfDirection(direction, res);
    const std::uint32_t leaf = views.leafOfView[sortedView];
    // The last on the way down is the first on the way up.
    for (std::uint32_t node = leaf; node != kNone; node = parentOf(views.nodes[node])) {
        const std::uint32_t bits = loadMapTexel(MapStore{res}, nodeTexels, node, texel);
        if (bits == kNone) continue;
        if (!recentered) return mapDepth(bits);
        const vec3 offset = minus3(boxCenter(views.nodes[node]), boxCenter(views.nodes[leaf]));
        return mapDepth(recenterDepth(bits, texel, res, offset));
    }
    return std::numeric_limits<float>::infinity();
}

// The diameter of a ball at distance l by a divisor of shaders/shared/pair.glsl; kInfinity around
// it.
inline float diameterTexels(float mapRes, float rs, float l, float divisor) {
    return divisor > 0.0f ? mapRes * rs * l / divisor : kInfinity;
}

}  // namespace mv
