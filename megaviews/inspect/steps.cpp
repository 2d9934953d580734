#include "megaviews/inspect/steps.h"

#include <algorithm>
#include <utility>

namespace mv {
namespace {

std::uint64_t childPairs(const InspectedPair& pair, std::span<const SceneNode> sceneNodes,
                         const ViewHierarchy& views) {
    if (pair.decision == kPairSplitScene) return childCountOf(sceneNodes[pair.scene].children);
    if (pair.decision == kPairSplitView) return childCountOf(views.nodes[pair.view].children);
    return 0;
}

// Draws what several pairs have in common once.
void appendBoxesOnce(std::vector<std::pair<std::uint32_t, std::uint32_t>>& nodesAndColours,
                     std::vector<Line>& lines, auto&& nodeOf) {
    std::sort(nodesAndColours.begin(), nodesAndColours.end());
    nodesAndColours.erase(std::unique(nodesAndColours.begin(), nodesAndColours.end()),
                          nodesAndColours.end());
    for (const auto& [index, colour] : nodesAndColours) {
        const auto& node = nodeOf(index);
        appendBox(boxCenter(node), boxHalf(node), colour, lines);
    }
}

}  // namespace

StepResult traversalStep(std::span<const SceneNode> sceneNodes, const ViewHierarchy& views,
                         const TraversalOptions& traversal, const StepOptions& options) {
    StepResult out;
    if (options.step < 1 || options.scene >= sceneNodes.size() ||
        options.view >= views.nodes.size()) {
        return out;
    }
    const bool published = traversal.rules == Rules::published;
    const float pairRes = pairResolution(traversal);
    std::uint64_t tested = 0;
    std::vector<InspectedPair> pairs;
    const auto test = [&](std::uint32_t scene, std::uint32_t view) {
        pairs.push_back(
            {scene, view, decidePair(sceneNodes[scene], views.nodes[view], published, pairRes)});
    };

    // The first step.
    const bool fromRoots = options.view == 0;
    std::uint64_t next = 1;
    if (fromRoots) {
        next = 0;
        for (const ViewNode& node : views.nodes) next += parentOf(node) == kNone ? 1 : 0;
    }
    if (next > options.maxPairs) {
        out.stopped = true;
        return out;
    }
    for (std::uint32_t view = 0; fromRoots && view < views.nodes.size(); ++view) {
        if (parentOf(views.nodes[view]) == kNone) test(options.scene, view);
    }
    if (!fromRoots) test(options.scene, options.view);

    for (;;) {
        ++out.step;
        tested += pairs.size();
        PairCounts& counts = out.countsPerStep.emplace_back();
        next = 0;
        for (const InspectedPair& pair : pairs) {
            countPair(counts, pair.decision, views.nodes[pair.view].viewCount);
            next += childPairs(pair, sceneNodes, views);
        }
        out.pairs = std::move(pairs);
        out.finished = next == 0;
        if (out.finished || out.step == options.step) break;
        out.stopped = tested + next > options.maxPairs;
        if (out.stopped) break;

        pairs.clear();
        pairs.reserve(next);
        for (const InspectedPair& pair : out.pairs) {
            if (pair.decision == kPairSplitScene) {
                const uint children = sceneNodes[pair.scene].children;
                for (uint k = 0; k < childCountOf(children); ++k) {
                    test(firstChildOf(children) + k, pair.view);
                }
            } else if (pair.decision == kPairSplitView) {
                const uint children = views.nodes[pair.view].children;
                for (uint k = 0; k < childCountOf(children); ++k) {
                    test(pair.scene, firstChildOf(children) + k);
                }
            }
        }
    }
    return out;
}

DrawnCount appendStep(const StepResult& result, std::span<const SceneNode> sceneNodes,
                      const ViewHierarchy& views, std::vector<Line>& lines, std::uint64_t cap) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sceneBoxes, viewBoxes;
    const DrawnCount count = drawEvenly(result.pairs.size(), cap, [&](std::uint64_t i) {
        const InspectedPair& pair = result.pairs[i];
        sceneBoxes.emplace_back(pair.scene, colourOfDecision(pair.decision));
        viewBoxes.emplace_back(pair.view, kViewNodeColour);
    });
    drawEvenly(result.pairs.size(), std::min(cap, kMaxDrawnLinks), [&](std::uint64_t i) {
        const InspectedPair& pair = result.pairs[i];
        lines.push_back({boxCenter(sceneNodes[pair.scene]), boxCenter(views.nodes[pair.view]),
                         colourOfDecision(pair.decision)});
    });
    appendBoxesOnce(sceneBoxes, lines, [&](std::uint32_t i) { return sceneNodes[i]; });
    appendBoxesOnce(viewBoxes, lines, [&](std::uint32_t i) { return views.nodes[i]; });
    return count;
}

}  // namespace mv
