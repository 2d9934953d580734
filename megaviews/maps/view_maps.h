#pragma once
// Omnidirectional depth maps on the CPU: fusion down the view hierarchy [Kol19 §3.2].
// The parametrisation is shaders/shared/paraboloid.glsl.

#include <cstdint>
#include <span>
#include <vector>

#include "megaviews/hierarchy/view_hierarchy.h"
#include "shaders/shared/map_store.glsl"

namespace mv {

// Depth maps, 2 faces of R x R texels each, dual paraboloid, float distance from the map's centre
// in root-cube units stored as ordered uint bits; kNone = empty.
// Texel (face, j, i) is at map * 2R^2 + face * R^2 + j * R + i, i along u (y), j along v (z).
struct ViewMaps {
    int mapRes = 0;
    std::vector<std::uint32_t> texels;
    std::vector<glm::vec3> centers;  // of each map, root-cube units
};

// Maps with what names them: map k is centred at centers[k]. One for each leaf, or without fusion
// one for each view node, of which those above a leaf are there as well.
struct ReadMaps {
    ViewMaps maps;
    std::vector<std::uint32_t> mapOfSlot;  // by view slot; kNone for dead views
    std::vector<std::uint32_t> parents;    // without fusion: the map above, kNone for the root
};

// From the maps of all view nodes (node k at k * 2R^2) to one map a leaf: every map takes from its
// parent's fused map what is nearer, re-centred, from the root down. Flat hierarchies: copied.
ViewMaps fuseMaps(std::span<const std::uint32_t> nodeTexels, const ViewHierarchy& views,
                  int mapRes);

// Multi-pixel filling under the published rules: empty texels of the fused maps take the finest
// coarser level that is not empty. mips: mipTexels(R) texels a leaf map.
void pushMips(std::span<const std::uint32_t> mips, ViewMaps& maps);

}  // namespace mv
