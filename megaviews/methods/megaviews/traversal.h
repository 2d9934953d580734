#pragma once
// The reference traversal (SceneHierarchy x ViewHierarchy -> ViewMaps), readable and slow: it
// defines the set of pairs, the counts and the maps that both traversals of the GPU must reproduce.
// Pairs are those of pairs.h, splats from shaders/shared/splat.glsl.

#include <cstdint>
#include <span>
#include <vector>

#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/hierarchy/view_hierarchy.h"
#include "megaviews/maps/view_maps.h"
#include "megaviews/methods/megaviews/pairs.h"

namespace mv {

struct TraversalResult {
    std::vector<std::uint32_t> nodeTexels;  // unfused map of every view node, before fusion
    ViewMaps leafMaps;                      // fused and filled, one a leaf view node
    PairCounts counts;
    std::vector<PairCounts> countsPerLevel;  // by scene level
};

// MegaViews when the hierarchy is a tree, ManyLoDs [HREB11 §3.1] when it is flat: then every view
// is a leaf without a parent and starts at the scene's root.
// sceneNodes must be those of the rules (SceneHierarchy::nodesUnder()); the root is first.
// Holes are filled by surface elements under the corrected rules; under the published ones by
// coarser levels, pushed after fusion and above 16 texels only, as in the paper.
TraversalResult traverse(std::span<const SceneNode> sceneNodes, const ViewHierarchy& views,
                         const MethodSettings& settings);

}  // namespace mv
