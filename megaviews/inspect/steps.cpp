#include "megaviews/inspect/steps.h"

#include <algorithm>
#include <utility>

namespace mv {
namespace {

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
    const PairTest test(sceneNodes, views.nodes, traversal);

    // The first step.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> next;
    for (std::uint32_t view = 0; options.view == 0 && view < views.nodes.size(); ++view) {
        if (parentOf(views.nodes[view]) == kNone) next.emplace_back(options.scene, view);
    }
    if (options.view != 0) next.emplace_back(options.scene, options.view);

    for (std::uint64_t tested = 0; !out.finished && out.step < options.step;) {
        tested += next.size();
        out.stopped = tested > options.maxPairs;
        if (out.stopped) break;
        ++out.step;
        PairCounts& counts = out.countsPerStep.emplace_back();
        out.pairs.clear();
        for (const auto& [scene, view] : next) {
            out.pairs.push_back(test(scene, view));
            countPair(counts, out.pairs.back().decision, views.nodes[view].viewCount);
        }
        next.clear();
        for (const NodePair& pair : out.pairs) {
            test.split(pair, [&](std::uint32_t scene, std::uint32_t view) {
                next.emplace_back(scene, view);
            });
        }
        out.finished = next.empty();
    }
    return out;
}

DrawnCount appendStep(const StepResult& result, std::span<const SceneNode> sceneNodes,
                      const ViewHierarchy& views, std::vector<Line>& lines, std::uint64_t cap) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sceneBoxes, viewBoxes;
    const DrawnCount count = drawEvenly(result.pairs.size(), cap, [&](std::uint64_t i) {
        const NodePair& pair = result.pairs[i];
        sceneBoxes.emplace_back(pair.scene, colourOfDecision(pair.decision));
        viewBoxes.emplace_back(pair.view, kViewNodeColour);
    });
    drawEvenly(result.pairs.size(), std::min(cap, kMaxDrawnLinks), [&](std::uint64_t i) {
        const NodePair& pair = result.pairs[i];
        lines.push_back({boxCenter(sceneNodes[pair.scene]), boxCenter(views.nodes[pair.view]),
                         colourOfDecision(pair.decision)});
    });
    appendBoxesOnce(sceneBoxes, lines, [&](std::uint32_t i) { return sceneNodes[i]; });
    appendBoxesOnce(viewBoxes, lines, [&](std::uint32_t i) { return views.nodes[i]; });
    return count;
}

}  // namespace mv
