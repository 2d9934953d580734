#include "megaviews/inspect/steps.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "megaviews/inspect/pair_explanation.h"

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

// A node with its ancestors and all that is below it: of each level the nodes of a range, since
// nodes lie level by level and children together.
class Family {
  public:
    template <typename Node>
    Family(std::span<const Node> nodes, std::uint32_t node) {
        if (node >= nodes.size()) return;
        const std::uint32_t level = nodes[node].level;
        // Down from the root, always to the child that has the node below it.
        for (std::uint32_t at = 0; nodes[at].level < level;) {
            ranges_.push_back({at, at + 1});
            Range child{firstChildOf(nodes[at].children), 0};
            child.end = child.begin + childCountOf(nodes[at].children);
            for (at = child.begin; at + 1 < child.end; ++at) {
                Range below{at, at + 1};
                while (!below.empty() && nodes[below.begin].level < level) {
                    below = childrenOf(nodes, below);
                }
                if (below.holds(node)) break;
            }
        }
        for (Range below{node, node + 1}; !below.empty(); below = childrenOf(nodes, below)) {
            ranges_.push_back(below);
        }
    }

    bool holds(std::uint32_t level, std::uint32_t node) const {
        return level < ranges_.size() && ranges_[level].holds(node);
    }

  private:
    struct Range {
        std::uint32_t begin = 0, end = 0;
        bool empty() const { return begin >= end; }
        bool holds(std::uint32_t node) const { return node >= begin && node < end; }
    };
    template <typename Node>
    static Range childrenOf(std::span<const Node> nodes, Range of) {
        while (!of.empty() && isLeaf(nodes[of.begin])) ++of.begin;
        while (!of.empty() && isLeaf(nodes[of.end - 1])) --of.end;
        if (of.empty()) return {};
        const uint last = nodes[of.end - 1].children;
        return {firstChildOf(nodes[of.begin].children), firstChildOf(last) + childCountOf(last)};
    }
    std::vector<Range> ranges_;  // by level
};

// How far a line passes from a ray's axis, as a share of the ray's radius, which turns lines into
// lines again; infinite where all of it lies behind.
float aside(Line line, const PickRay& ray) {
    const auto along = [&](vec3 p) { return dot3(p - ray.origin, ray.direction); };
    const float nearest = 1e-4f;
    float a = along(line.a), b = along(line.b);
    if (a < b) {
        std::swap(a, b);
        std::swap(line.a, line.b);
    }
    if (!(a > nearest)) return std::numeric_limits<float>::infinity();
    if (b < nearest) {
        line.b = line.a + (line.b - line.a) * ((a - nearest) / (a - b));
        b = nearest;
    }
    // Within the plane across the ray.
    const auto across = [&](vec3 p, float distance) {
        return (p - ray.origin - ray.direction * distance) / ray.radiusAt(distance);
    };
    const vec3 from = across(line.a, a), way = across(line.b, b) - from;
    const float length2 = dot3(way, way);
    const float t = length2 > 0 ? clamp(-dot3(from, way) / length2, 0.0f, 1.0f) : 0.0f;
    return length3(from + way * t);
}

}  // namespace

StepResult traversalStep(std::span<const SceneNode> sceneNodes, const ViewHierarchy& views,
                         const MethodSettings& settings, const StepOptions& options) {
    StepResult out;
    if (options.step < 1 || options.scene >= sceneNodes.size() ||
        options.view >= views.nodes.size()) {
        return out;
    }
    const PairTest test(sceneNodes, views.nodes, settings);

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

ChosenPairs choosePairs(std::span<const NodePair> pairs, std::span<const SceneNode> sceneNodes,
                        const ViewHierarchy& views, const MethodSettings& settings,
                        const StepChoice& choice, std::uint64_t cap) {
    const std::span viewNodes(views.nodes);
    std::vector<Family> scene, view;
    if (choice.show == StepPairs::ofPair && choice.pair) {
        scene.emplace_back(sceneNodes, choice.pair->scene);
        view.emplace_back(viewNodes, choice.pair->view);
    }
    if (choice.show == StepPairs::ofViews) {
        for (const std::uint32_t leaf : choice.viewLeaves) view.emplace_back(viewNodes, leaf);
    }
    const bool ofFamily = choice.show == StepPairs::ofPair || choice.show == StepPairs::ofViews;
    const auto holds = [](const std::vector<Family>& families, const auto& node, std::uint32_t i) {
        return std::any_of(families.begin(), families.end(),
                           [&](const Family& family) { return family.holds(node.level, i); });
    };

    std::vector<NodePair> eligible;
    for (const NodePair& pair : pairs) {
        if (choice.hidden.at(pair.decision - kPairCulled)) continue;
        if (ofFamily && !holds(view, viewNodes[pair.view], pair.view)) continue;
        if (!scene.empty() && !holds(scene, sceneNodes[pair.scene], pair.scene)) continue;
        eligible.push_back(pair);
    }

    ChosenPairs out;
    out.eligible = eligible.size();
    if (choice.show == StepPairs::largest) {
        // Where nothing bounds the size, the larger scene node first.
        std::vector<std::tuple<double, float, std::size_t>> bySize;
        for (std::size_t i = 0; i < eligible.size(); ++i) {
            const SceneNode& node = sceneNodes[eligible[i].scene];
            bySize.emplace_back(-projectedTexels(node, viewNodes[eligible[i].view], settings),
                                -length3(boxHalf(node)), i);
        }
        const std::size_t count = std::min({eligible.size(), static_cast<std::size_t>(cap),
                                            static_cast<std::size_t>(kMaxDrawnLinks)});
        std::partial_sort(bySize.begin(), bySize.begin() + static_cast<std::ptrdiff_t>(count),
                          bySize.end());
        for (std::size_t i = 0; i < count; ++i) {
            out.pairs.push_back(eligible[std::get<std::size_t>(bySize[i])]);
        }
    } else {
        drawEvenly(eligible.size(), cap,
                   [&](std::uint64_t i) { out.pairs.push_back(eligible[i]); });
    }
    return out;
}

DrawnCount appendStep(std::span<const NodePair> pairs, std::span<const SceneNode> sceneNodes,
                      const ViewHierarchy& views, std::vector<Line>& lines) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sceneBoxes, viewBoxes;
    for (const NodePair& pair : pairs) {
        sceneBoxes.emplace_back(pair.scene, colourOfDecision(pair.decision));
        viewBoxes.emplace_back(pair.view, kViewNodeColour);
    }
    const DrawnCount links = drawEvenly(pairs.size(), kMaxDrawnLinks, [&](std::uint64_t i) {
        const NodePair& pair = pairs[i];
        lines.push_back({boxCenter(sceneNodes[pair.scene]), boxCenter(views.nodes[pair.view]),
                         colourOfDecision(pair.decision)});
    });
    appendBoxesOnce(sceneBoxes, lines, [&](std::uint32_t i) { return sceneNodes[i]; });
    appendBoxesOnce(viewBoxes, lines, [&](std::uint32_t i) { return views.nodes[i]; });
    return links;
}

void appendPickedPair(const SceneNode& scene, const ViewNode& view, std::vector<Line>& lines) {
    // Twice, so that boxes in other colours do not hide it.
    for (const float size : {1.0f, 1.01f}) {
        appendBox(boxCenter(scene), boxHalf(scene) * size, kPickedPairColour, lines);
        appendBox(boxCenter(view), boxHalf(view) * size, kPickedPairColour, lines);
    }
    lines.push_back({boxCenter(scene), boxCenter(view), kPickedPairColour});
}

std::vector<std::size_t> pairsAlong(std::span<const NodePair> pairs,
                                    std::span<const SceneNode> sceneNodes,
                                    const ViewHierarchy& views, const PickRay& ray) {
    std::vector<std::tuple<float, float, std::size_t>> found;
    std::vector<Line> lines;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const SceneNode& scene = sceneNodes[pairs[i].scene];
        const ViewNode& view = views.nodes[pairs[i].view];
        const float link = aside({boxCenter(scene), boxCenter(view), 0}, ray);
        float nearest = link;
        lines.clear();
        appendBox(boxCenter(scene), boxHalf(scene), 0, lines);
        appendBox(boxCenter(view), boxHalf(view), 0, lines);
        for (const Line& line : lines) nearest = std::min(nearest, aside(line, ray));
        if (nearest <= 1) found.emplace_back(nearest, link, i);
    }
    std::ranges::sort(found);
    std::vector<std::size_t> indices;
    for (const auto& [nearest, link, index] : found) indices.push_back(index);
    return indices;
}

}  // namespace mv
