#include "megaviews/maps/view_maps.h"

#include <cassert>

#include "shaders/shared/fuse.glsl"
#include "shaders/shared/pair.glsl"

namespace mv {

ViewMaps fuseMaps(std::span<const std::uint32_t> nodeTexels, const ViewHierarchy& views,
                  int mapRes) {
    const uint res = static_cast<uint>(mapRes);
    const MapStore store{res};
    assert(nodeTexels.size() == mapWords(store, views.nodes.size()));

    std::vector<std::uint32_t> fused(nodeTexels.begin(), nodeTexels.end());
    for (std::size_t node = 0; node < views.nodes.size(); ++node) {  // parents come first
        const ViewNode& v = views.nodes[node];
        const uint parent = parentOf(v);
        if (parent == kNone) continue;
        const vec3 offset = minus3(boxCenter(views.nodes[parent]), boxCenter(v));
        for (uint texel = 0; texel < mapTexels(res); ++texel) {
            const uint seen = loadMapTexel(store, fused, parent, texel);
            lowerMapTexel(store, fused, node, texel, recenterDepth(seen, texel, res, offset));
        }
    }

    ViewMaps maps;
    maps.mapRes = mapRes;
    maps.texels.resize(mapWords(store, views.leafCount));
    maps.centers.resize(views.leafCount);
    for (std::size_t node = 0; node < views.nodes.size(); ++node) {
        const std::uint32_t map = views.mapOfNode[node];
        if (map == kNone) continue;
        for (uint texel = 0; texel < mapTexels(res); ++texel) {
            storeMapTexel(store, maps.texels, map, texel, loadMapTexel(store, fused, node, texel));
        }
        maps.centers[map] = boxCenter(views.nodes[node]);
    }
    return maps;
}

void pushMips(std::span<const std::uint32_t> mips, ViewMaps& maps) {
    const uint res = static_cast<uint>(maps.mapRes);
    const MapStore store{static_cast<uint>(maps.mapRes)};
    for (std::size_t map = 0; map < maps.centers.size(); ++map) {
        for (uint texel = 0; texel < mapTexels(res); ++texel) {
            uint bits = loadMapTexel(store, maps.texels, map, texel);
            for (uint level = 1; bits == kNone && (res >> level) > 0; ++level) {
                bits = mips[mipWordOf(store, map, mipTexelOf(texel, level, res))];
            }
            storeMapTexel(store, maps.texels, map, texel, bits);
        }
    }
}

}  // namespace mv
