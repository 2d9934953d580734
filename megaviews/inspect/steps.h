#pragma once
// The traversal step by step, breadth first as the published queue runs it [Kol19 §3.2]: step k
// tests the pairs that step k - 1 subdivided into.

#include "megaviews/inspect/lines.h"
#include "megaviews/inspect/view_pairs.h"

namespace mv {

struct StepOptions {
    int step = 1;                        // 1 = the pairs that it starts from
    std::uint32_t scene = 0;             // where it starts: node of the scene octree,
    std::uint32_t view = 0;              // node of the view octree; 0: every root of a flat one
    std::uint64_t maxPairs = 2'000'000;  // tested in all steps together
};

struct StepResult {
    int step = 0;                 // of the pairs below: the one asked for or the last there is
    std::vector<NodePair> pairs;  // of that step, in the order of the queue
    std::vector<PairCounts> countsPerStep;  // up to it
    bool finished = false;                  // its pairs subdivide no further
    bool stopped = false;                   // the next step would have gone beyond maxPairs
};

// An index that the trees do not have gives nothing.
StepResult traversalStep(std::span<const SceneNode> sceneNodes, const ViewHierarchy& views,
                         const TraversalOptions& traversal, const StepOptions& options);

// Scene node's box, coloured by decision, and view node's box; boxes that several pairs have in
// common are drawn once. Of the lines between their centres, which soon fill the picture, at most
// kMaxDrawnLinks, evenly.
inline constexpr std::uint64_t kMaxDrawnLinks = 120;
DrawnCount appendStep(const StepResult& result, std::span<const SceneNode> sceneNodes,
                      const ViewHierarchy& views, std::vector<Line>& lines,
                      std::uint64_t cap = kMaxDrawnNodes);

}  // namespace mv
