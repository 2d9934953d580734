#pragma once
// The reference traversal (SceneHierarchy x ViewHierarchy -> ViewMaps), readable and slow: it
// defines the set of pairs, the counts and the maps that both GPU organisations must reproduce.
// Pair decisions come from shaders/shared/pair.glsl, splats from shaders/shared/splat.glsl.

#include <cstdint>
#include <vector>

#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/hierarchy/view_hierarchy.h"
#include "megaviews/settings/settings.h"
#include "megaviews/settings/statistics.h"

namespace mv {

struct TraversalOptions {
    Rules rules = Rules::corrected;
    int viewRes = 16;       // R: power of two, 8..256
    bool holeFill = true;   // multi-pixel filling
};

// Depth maps, 2 faces of R x R texels each, dual paraboloid, float distance from the map's centre
// in root-cube units stored as ordered uint bits; kNone = empty.
// Texel (face, j, i) is at map * 2R^2 + face * R^2 + j * R + i, i along u (y), j along v (z).
struct ViewMaps {
    int viewRes = 0;
    std::vector<std::uint32_t> texels;
    std::vector<glm::vec3> centers;          // of each map, root-cube units
};

struct TraversalResult {
    std::vector<std::uint32_t> nodeTexels;   // unfused map of every view node, before fusion
    ViewMaps leafMaps;                       // fused, one a leaf view node
    PairCounts counts;
    std::vector<PairCounts> countsPerLevel;  // by scene level
};

// MegaViews when the hierarchy is a tree, ManyLoDs [HREB11 §3.1] when it is flat.
// sceneNodes must be those of the rules (hierarchy.nodes or publishedNodes()).
TraversalResult traverse(const std::vector<SceneNode>& sceneNodes, const ViewHierarchy& views,
                         const TraversalOptions& options);

// Unfused query [Kol19 §3.2]: the last non-empty texel on the way from the root to the leaf.
// Returns the depth, or infinity if all are empty.
float queryUnfused(const TraversalResult& result, const ViewHierarchy& views, int viewRes,
                   std::uint32_t sortedView, glm::vec3 direction);

}  // namespace mv
