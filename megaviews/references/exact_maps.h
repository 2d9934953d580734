#pragma once
// Ground truth for the many-view methods' maps: the depth that rays find from each view's true
// position, in the parametrisation and units of megaviews/maps (shaders/shared/paraboloid.glsl).

#include <span>
#include <vector>

#include "megaviews/core/progress.h"
#include "megaviews/references/embree_scene.h"

namespace mv {

// Distances in root-cube units, infinity (std::numeric_limits) where a ray leaves the scene.
// Texel (face, j, i) of map m is at m * 2R^2 + face * R^2 + j * R + i, as in ViewMaps. The corners
// of a face that no direction falls into (texelReachable) are infinity.
struct ExactMaps {
    int mapRes = 0;
    std::vector<float> depth;  // through the texel's centre
    // Depths of 5 x 5 rays, evenly through the texel; the middle one is the centre's. Empty if they
    // were not asked for. Where a texel reaches beyond the rim of its face, its rays go on into the
    // other face as its centre's does.
    std::vector<float> nearest, farthest;
};

inline constexpr int kExactMapSamples = 5;  // a side

// One map for each position, root-cube units. Alpha masks are honoured; nothing is excluded, so a
// VPL sees its own surface behind it at the distance it was lifted off.
ExactMaps exactMaps(const EmbreeScene& embree, std::span<const glm::vec3> positions, int mapRes,
                    bool ranges, const Progress& progress = {});

}  // namespace mv
