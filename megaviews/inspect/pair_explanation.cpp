#include "megaviews/inspect/pair_explanation.h"

#include <spdlog/fmt/fmt.h>

#include <limits>

namespace mv {
namespace {

// Below this many texels a pair is rendered.
double thresholdOf(const MethodSettings& settings) {
    return settings.maps.resolution / static_cast<double>(pairResolution(settings));
}

double texelsOf(const PairTerms& terms, double threshold) {
    if (!(terms.sizeMost > 0)) return std::numeric_limits<double>::infinity();
    return static_cast<double>(terms.size) / static_cast<double>(terms.sizeMost) * threshold;
}

std::string sizeText(double texels, double threshold) {
    return std::isinf(texels)
               ? "so near that nothing bounds its size"
               : fmt::format("{:.3g} texels wide, not below {:.3g}", texels, threshold);
}

// A pair, what decided it, and what is said of that.
struct Decided {
    const SceneNode& s;
    const ViewNode& v;
    const MethodSettings& settings;
    PairTerms terms;
    double threshold = 0, texels = 0;
    PairExplanation& out;
    void add(std::string_view what, double value, std::string_view relation, double limit) const {
        out.comparisons.push_back({what, value, relation, limit});
    }
};

std::string whyCulled(const Decided& d) {
    const double hidden = static_cast<double>(d.terms.hidden);
    const double hiddenLeast = static_cast<double>(d.terms.hiddenLeast);
    if (hasRule(d.settings.rules, kRuleBoxes)) {
        return fmt::format(
            "No view can see it: all of it lies {:.3g} or more below the horizon of every view; "
            "more than {:.3g} is needed.",
            hidden, hiddenLeast);
    }
    return fmt::format(
        "No view can see it: its centre lies {:.3g} outside the cone of what the views see, more "
        "than both radii, {:.3g}.",
        hidden, hiddenLeast);
}

std::string whyRendered(const Decided& d) {
    const auto views = d.v.viewCount;
    return fmt::format("It fills the same texel in {}: {:.3g} texels wide, below {:.3g}.",
                       views == 1 ? "its view" : fmt::format("all {} views", views), d.texels,
                       d.threshold);
}

// Neither node can be split.
std::string whyEnded(const Decided& d) {
    const PairTerms& t = d.terms;
    const double distance = static_cast<double>(t.distance);
    const double radius = static_cast<double>(t.radius);
    const bool outside = t.distance > t.radius;
    d.add("distance, radius", distance, outside ? ">" : "<=", radius);
    if (outside) {
        return fmt::format("Both nodes are leaves, so it is rendered as it is: {}.",
                           sizeText(d.texels, d.threshold));
    }
    std::string reason = fmt::format(
        "Both nodes are leaves, and the view lies within the ball of the scene node, {:.3g} from "
        "its centre, radius {:.3g}",
        distance, radius);
    const bool asked = hasRule(d.settings.rules, kRuleSurfaces) && surfaceUsable(d.s.surface);
    if (!asked) return reason + ": it has neither size nor direction.";
    const double off = static_cast<double>(t.off);
    const double offLeast = static_cast<double>(t.offLeast);
    const bool clear = t.off > t.offLeast;
    d.add("off its surface", off, clear ? ">" : "<=", offLeast);
    return reason + fmt::format("; it {} the surface, {:.3g} off its plane where {:.3g} is clear.",
                                clear                                ? "stands off"
                                : d.out.pair.decision == kPairForced ? "is near, but looks at,"
                                                                     : "lies on",
                                off, offLeast);
}

std::string whySplit(const Decided& d) {
    const bool sceneFirst = d.out.pair.decision == kPairSplitScene;
    const std::string split =
        fmt::format("{} is split: {}; ", sceneFirst ? "The scene node" : "The view node",
                    sizeText(d.texels, d.threshold));
    if (isLeaf(d.s) || isLeaf(d.v)) {
        return split + fmt::format("the {} node is a leaf.", isLeaf(d.s) ? "scene" : "view");
    }
    if (!hasRule(d.settings.rules, kRuleRadius)) {
        d.add("level", d.s.level + 1, sceneFirst ? "<" : ">=", d.v.level + 1);
        return split + fmt::format("its level {} {} the view node's level {}.", d.s.level + 1,
                                   sceneFirst ? "is above" : "is not above", d.v.level + 1);
    }
    const double radius = static_cast<double>(d.terms.radius);
    const double viewRadius = static_cast<double>(d.terms.viewRadius);
    d.add("radius, twice the views'", radius, sceneFirst ? ">=" : "<", 2 * viewRadius);
    return split + fmt::format("the scene node's radius {:.3g} is {} twice the views', {:.3g}.",
                               radius, sceneFirst ? "at least" : "below", 2 * viewRadius);
}

}  // namespace

double projectedTexels(const SceneNode& s, const ViewNode& v, const MethodSettings& settings) {
    PairTerms terms = noTerms();
    equivalentViews(minus3(boxCenter(s), boxCenter(v)), length3(boxHalf(s)), length3(boxHalf(v)),
                    settings.rules, pairResolution(settings), terms);
    return texelsOf(terms, thresholdOf(settings));
}

PairExplanation explainPair(std::span<const SceneNode> sceneNodes,
                            std::span<const ViewNode> viewNodes, const MethodSettings& settings,
                            std::uint32_t scene, std::uint32_t view) {
    PairExplanation out;
    Decided d{sceneNodes[scene], viewNodes[view], settings, {}, 0, 0, out};
    const uint decision = decidePair(d.s, d.v, settings.rules, pairResolution(settings), d.terms);
    out.pair = {scene, view, decision};
    const bool culled = decision == kPairCulled, rendered = decision == kPairRendered;
    if ((d.v.flags & kViewNodeNoCull) == 0) {
        d.add(hasRule(settings.rules, kRuleBoxes) ? "below the horizon" : "out of sight",
              static_cast<double>(d.terms.hidden),
              culled ? ">" : "<=", static_cast<double>(d.terms.hiddenLeast));
    }
    if (!culled) {
        d.threshold = thresholdOf(settings);
        d.texels = texelsOf(d.terms, d.threshold);
        d.add("size, texels", d.texels, rendered ? "<" : ">=", d.threshold);
    }
    out.reason = culled                       ? whyCulled(d)
                 : rendered                   ? whyRendered(d)
                 : isLeaf(d.s) && isLeaf(d.v) ? whyEnded(d)
                                              : whySplit(d);
    return out;
}

std::string sceneNodeText(std::span<const SceneNode> nodes, std::int64_t node) {
    const auto i = static_cast<std::size_t>(node);
    if (i >= nodes.size()) return "no such node";
    return fmt::format("node {}, level {}{}", node, nodes[i].level + 1,
                       isLeaf(nodes[i]) ? ", a leaf" : "");
}

std::string viewNodeText(std::span<const ViewNode> nodes, std::int64_t node) {
    const auto i = static_cast<std::size_t>(node);
    if (i >= nodes.size()) return "no such node";
    const ViewNode& v = nodes[i];
    return fmt::format("node {}, level {}, {} view{}{}", node, v.level + 1, v.viewCount,
                       v.viewCount == 1 ? "" : "s", isLeaf(v) ? ", a leaf" : "");
}

}  // namespace mv
