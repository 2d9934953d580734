#include "megaviews/maps/view_maps.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "shaders/shared/fuse.glsl"
#include "shaders/shared/pair.glsl"

namespace mv {
namespace {

constexpr float kEmptyDepth = std::numeric_limits<float>::infinity();

float depthOf(std::uint32_t bits) { return bits == kNone ? kEmptyDepth : uintBitsToFloat(bits); }

}  // namespace

ViewMaps fuseMaps(std::span<const std::uint32_t> nodeTexels, const ViewHierarchy& views,
                  int viewRes) {
    const uint res = static_cast<uint>(viewRes);
    const std::size_t size = mapTexels(res);
    assert(nodeTexels.size() == views.nodes.size() * size);

    std::vector<std::uint32_t> fused(nodeTexels.begin(), nodeTexels.end());
    for (std::size_t node = 0; node < views.nodes.size(); ++node) {  // parents come first
        const ViewNode& v = views.nodes[node];
        const uint parent = parentOf(v);
        if (parent == kNone) continue;
        const vec3 offset = minus3(boxCenter(views.nodes[parent]), boxCenter(v));
        for (uint texel = 0; texel < size; ++texel) {
            const uint seen = recenterDepth(fused[parent * size + texel], texel, res, offset);
            std::uint32_t& own = fused[node * size + texel];
            own = std::min(own, seen);
        }
    }

    ViewMaps maps;
    maps.viewRes = viewRes;
    maps.texels.resize(views.leafCount * size);
    maps.centers.resize(views.leafCount);
    for (std::size_t node = 0; node < views.nodes.size(); ++node) {
        const std::uint32_t map = views.mapOfNode[node];
        if (map == kNone) continue;
        std::copy_n(fused.begin() + static_cast<std::ptrdiff_t>(node * size), size,
                    maps.texels.begin() + static_cast<std::ptrdiff_t>(map * size));
        maps.centers[map] = boxCenter(views.nodes[node]);
    }
    return maps;
}

void pushMips(std::span<const std::uint32_t> mips, ViewMaps& maps) {
    const uint res = static_cast<uint>(maps.viewRes);
    const std::size_t size = mapTexels(res);
    for (std::size_t map = 0; map < maps.centers.size(); ++map) {
        const std::uint32_t* levels = mips.data() + map * mipTexels(res);
        for (uint texel = 0; texel < size; ++texel) {
            std::uint32_t& own = maps.texels[map * size + texel];
            for (uint level = 1; own == kNone && (res >> level) > 0; ++level) {
                own = levels[mipTexelOf(texel, level, res)];
            }
        }
    }
}

float queryFused(const ViewMaps& maps, std::uint32_t map, glm::vec3 direction) {
    const uint res = static_cast<uint>(maps.viewRes);
    const std::size_t first = std::size_t{map} * mapTexels(res);
    return depthOf(maps.texels[first + texelOfDirection(direction, res)]);
}

float queryUnfused(std::span<const std::uint32_t> nodeTexels, const ViewHierarchy& views,
                   int viewRes, std::uint32_t sortedView, glm::vec3 direction, bool recentered) {
    const uint res = static_cast<uint>(viewRes);
    const uint texel = texelOfDirection(direction, res);
    const std::uint32_t leaf = views.leafOfView[sortedView];
    // The last on the way down is the first on the way up.
    for (std::uint32_t node = leaf; node != kNone; node = parentOf(views.nodes[node])) {
        const std::uint32_t bits = nodeTexels[std::size_t{node} * mapTexels(res) + texel];
        if (bits == kNone) continue;
        if (!recentered) return depthOf(bits);
        const vec3 offset = minus3(boxCenter(views.nodes[node]), boxCenter(views.nodes[leaf]));
        return depthOf(recenterDepth(bits, texel, res, offset));
    }
    return kEmptyDepth;
}

}  // namespace mv
