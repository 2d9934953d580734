#pragma once
// The traversal step by step, breadth first as the published queue runs it [Kol19 §3.2]: step k
// tests the pairs that step k - 1 subdivided into.

#include <array>
#include <optional>
#include <vector>

#include "megaviews/inspect/lines.h"
#include "megaviews/inspect/view_pairs.h"
#include "megaviews/settings/settings.h"
#include "megaviews/views/pick_view.h"

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
                         const MethodSettings& settings, const StepOptions& options);

// Which of a step's pairs are drawn.
struct StepChoice {
    StepPairs show = StepPairs::spread;
    std::array<bool, kOutcomeNames.size()> hidden{};  // outcomes that are not
    std::optional<NodePair> pair = {};                // picked: of StepPairs::ofPair
    std::vector<std::uint32_t> viewLeaves = {};       // that hold picked views: ofViews
};
struct ChosenPairs {
    std::vector<NodePair> pairs;
    std::uint64_t eligible = 0;  // that they were chosen from: not hidden, and of what was picked
};
// Evenly up to a cap; of the largest in texels no more than kMaxDrawnLinks, the largest first.
inline constexpr std::uint64_t kMaxDrawnLinks = 120;
ChosenPairs choosePairs(std::span<const NodePair> pairs, std::span<const SceneNode> sceneNodes,
                        const ViewHierarchy& views, const MethodSettings& settings,
                        const StepChoice& choice, std::uint64_t cap = kMaxDrawnNodes);

// Scene node's box, coloured by decision, and view node's box; boxes that several pairs have in
// common are drawn once. Of the lines between their centres, which soon fill the picture, at most
// kMaxDrawnLinks, evenly: what is counted.
DrawnCount appendStep(std::span<const NodePair> pairs, std::span<const SceneNode> sceneNodes,
                      const ViewHierarchy& views, std::vector<Line>& lines);
// One pair, to be seen among all others.
void appendPickedPair(const SceneNode& scene, const ViewNode& view, std::vector<Line>& lines);

// The pairs that a user points at, as indices: those whose boxes or link pass within the ray's
// radius, by their distance from its axis as a share of the radius there; of several that are as
// near, first the one whose link is nearest.
std::vector<std::size_t> pairsAlong(std::span<const NodePair> pairs,
                                    std::span<const SceneNode> sceneNodes,
                                    const ViewHierarchy& views, const PickRay& ray);

}  // namespace mv
