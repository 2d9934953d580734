#pragma once
// The traversal seen from one view: the pairs of the view nodes above it, in the order in which
// they are tested, and the maps that they leave (SceneHierarchy x ViewHierarchy -> pairs, maps).
// Decisions and splats are those of the traversal, shaders/shared/pair.glsl and splat.glsl.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/hierarchy/view_hierarchy.h"
#include "megaviews/methods/megaviews/traversal.h"

namespace mv {

struct ViewPairs {
    std::uint32_t sortedView = kNone;
    std::vector<std::uint32_t> chain;     // view nodes from the root to the view's leaf
    std::vector<std::size_t> chainBegin;  // chain.size() + 1 entries into pairs
    std::vector<NodePair> pairs;          // node by node down the chain
    PairCounts counts;

    std::span<const NodePair> pairsOf(std::size_t chainIndex) const {
        return {pairs.data() + chainBegin[chainIndex], pairs.data() + chainBegin[chainIndex + 1]};
    }
};

// The sorted view that holds a slot; nullopt for dead slots and slots that there are not.
std::optional<std::uint32_t> sortedViewOf(const ViewHierarchy& views, std::int64_t slot);

// sceneNodes must be those of settings.rules. No scene: no pairs, but the chain.
ViewPairs pairsOfView(std::span<const SceneNode> sceneNodes, const ViewHierarchy& views,
                      std::uint32_t sortedView, const MethodSettings& settings);

// A map with what won each of its 2R^2 texels.
struct InspectedMap {
    std::vector<std::uint32_t> depth;  // ordered float bits, kNone = empty
    std::vector<std::uint32_t> pair;   // index into ViewPairs::pairs; of equals the first
};

struct ViewMapsOfView {
    int mapRes = 0;
    std::vector<InspectedMap> own;  // before fusion, one a node of the chain
    InspectedMap fused;             // and filled: what the gather looks into
};

ViewMapsOfView mapsOfView(std::span<const SceneNode> sceneNodes, const ViewHierarchy& views,
                          const ViewPairs& pairs, const MethodSettings& settings);

}  // namespace mv
