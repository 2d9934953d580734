#pragma once
// The reference traversal (SceneHierarchy x ViewHierarchy -> ViewMaps), readable and slow: it
// defines the set of pairs, the counts and the maps that both GPU organisations must reproduce.
// Pair decisions come from shaders/shared/pair.glsl, splats from shaders/shared/splat.glsl.

#include <cstdint>
#include <vector>

#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/hierarchy/view_hierarchy.h"
#include "megaviews/maps/view_maps.h"
#include "megaviews/settings/settings.h"
#include "megaviews/settings/statistics.h"

namespace mv {

// Adds one tested pair and its decision, kPair* of shaders/shared/pair.glsl.
void countPair(PairCounts& counts, std::uint32_t decision, std::uint32_t viewCount);

struct TraversalOptions {
    Rules rules = Rules::corrected;
    int viewRes = 16;  // R: power of two, 8..256
    // Multi-pixel filling. corrected: surface elements. published: coarser levels, pushed after
    // fusion, above 16 texels only, as in the paper.
    bool holeFill = true;
    float pairSize = 1;  // times the rules' threshold of a pair's size
};
// What decidePair takes.
float pairResolution(const TraversalOptions& options);

struct TraversalResult {
    std::vector<std::uint32_t> nodeTexels;  // unfused map of every view node, before fusion
    ViewMaps leafMaps;                      // fused and filled, one a leaf view node
    PairCounts counts;
    std::vector<PairCounts> countsPerLevel;  // by scene level
};

// MegaViews when the hierarchy is a tree, ManyLoDs [HREB11 §3.1] when it is flat: then every view
// is a leaf without a parent and starts at the scene's root.
// sceneNodes must be those of the rules (hierarchy.nodes or publishedNodes()); the root is first.
TraversalResult traverse(const std::vector<SceneNode>& sceneNodes, const ViewHierarchy& views,
                         const TraversalOptions& options);

}  // namespace mv
