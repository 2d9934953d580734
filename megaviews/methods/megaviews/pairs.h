#pragma once
// Pairs of scene and view nodes: how one is decided, what it is split into, and the loop over all
// pairs of a view node. The reference traversal and the instruments that show it run this one loop.
// Decisions come from shaders/shared/pair.glsl.

#include <cstdint>
#include <span>
#include <vector>

#include "megaviews/hierarchy/view_hierarchy.h"
#include "megaviews/settings/settings.h"
#include "megaviews/settings/statistics.h"
#include "shaders/shared/pair.glsl"

namespace mv {

// What decidePair takes.
inline float pairResolution(const MethodSettings& settings) {
    return pairResolution(static_cast<float>(settings.maps.resolution), settings.rules,
                          static_cast<float>(settings.pairs.size));
}

struct NodePair {
    std::uint32_t scene, view;  // node indices
    std::uint32_t decision;     // kPair*
    bool operator==(const NodePair&) const = default;
};
inline bool isRendered(const NodePair& pair) { return pairRendered(pair.decision); }

// Adds one tested pair and its decision.
void countPair(PairCounts& counts, std::uint32_t decision, std::uint32_t viewCount);

class PairTest {
  public:
    // sceneNodes must be those of the rules (SceneHierarchy::nodesUnder()).
    PairTest(std::span<const SceneNode> sceneNodes, std::span<const ViewNode> viewNodes,
             const MethodSettings& settings)
        : sceneNodes_(sceneNodes),
          viewNodes_(viewNodes),
          rules_(settings.rules),
          resolution_(pairResolution(settings)) {}

    NodePair operator()(std::uint32_t scene, std::uint32_t view) const {
        return {scene, view, decidePair(sceneNodes_[scene], viewNodes_[view], rules_, resolution_)};
    }

    // What a subdivided pair is replaced by: visit(scene, view) for each.
    template <typename Visit>
    void split(const NodePair& pair, Visit&& visit) const {
        const bool scene = pair.decision == kPairSplitScene;
        if (!scene && pair.decision != kPairSplitView) return;
        const uint children =
            scene ? sceneNodes_[pair.scene].children : viewNodes_[pair.view].children;
        for (uint k = 0; k < childCountOf(children); ++k) {
            const uint child = firstChildOf(children) + k;
            scene ? visit(child, pair.view) : visit(pair.scene, child);
        }
    }

    // All pairs of one view node, depth first: visit(pair). `open` holds the scene nodes that its
    // parent's pairs handed on by splitting the view; returned are those that this node hands on to
    // each of its children.
    template <typename Visit>
    std::vector<std::uint32_t> ofViewNode(std::uint32_t view, std::vector<std::uint32_t> open,
                                          Visit&& visit) const {
        std::vector<std::uint32_t> handedOn;
        while (!open.empty()) {
            const NodePair pair = (*this)(open.back(), view);
            open.pop_back();
            visit(pair);
            if (pair.decision == kPairSplitView) {
                handedOn.push_back(pair.scene);
            } else {
                split(pair, [&](std::uint32_t scene, std::uint32_t) { open.push_back(scene); });
            }
        }
        return handedOn;
    }

  private:
    std::span<const SceneNode> sceneNodes_;
    std::span<const ViewNode> viewNodes_;
    uint rules_;
    float resolution_;
};

}  // namespace mv
