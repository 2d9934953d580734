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
    const SceneNode& s = sceneNodes[scene];
    const ViewNode& v = viewNodes[view];
    const bool boxes = hasRule(settings.rules, kRuleBoxes);
    PairTerms t;
    const uint decision = decidePair(s, v, settings.rules, pairResolution(settings), t);

    PairExplanation out;
    out.pair = {scene, view, decision};
    const auto add = [&](std::string_view what, double value, std::string_view relation,
                         double limit) {
        out.comparisons.push_back({what, value, relation, limit});
    };
    const double hidden = static_cast<double>(t.hidden);
    const double hiddenLeast = static_cast<double>(t.hiddenLeast);
    const bool culled = decision == kPairCulled;
    if ((v.flags & kViewNodeNoCull) == 0) {
        add(boxes ? "below the horizon" : "out of sight", hidden, culled ? ">" : "<=", hiddenLeast);
    }
    if (culled) {
        out.reason =
            boxes ? fmt::format(
                        "No view can see it: all of it lies {:.3g} or more below the horizon of "
                        "every view; more than {:.3g} is needed.",
                        hidden, hiddenLeast)
                  : fmt::format(
                        "No view can see it: its centre lies {:.3g} outside the cone of what the "
                        "views see, more than both radii, {:.3g}.",
                        hidden, hiddenLeast);
        return out;
    }

    const double threshold = thresholdOf(settings), texels = texelsOf(t, threshold);
    const bool rendered = decision == kPairRendered;
    add("size, texels", texels, rendered ? "<" : ">=", threshold);
    if (rendered) {
        out.reason =
            fmt::format("It fills the same texel in {}: {:.3g} texels wide, below {:.3g}.",
                        v.viewCount == 1 ? "its view" : fmt::format("all {} views", v.viewCount),
                        texels, threshold);
        return out;
    }
    const std::string size = sizeText(texels, threshold);
    const double radius = static_cast<double>(t.radius);
    const double viewRadius = static_cast<double>(t.viewRadius);

    if (isLeaf(s) && isLeaf(v)) {
        const double distance = static_cast<double>(t.distance);
        const bool outside = t.distance > t.radius;
        add("distance, radius", distance, outside ? ">" : "<=", radius);
        if (outside) {
            out.reason =
                fmt::format("Both nodes are leaves, so it is rendered as it is: {}.", size);
            return out;
        }
        out.reason = fmt::format(
            "Both nodes are leaves, and the view lies within the ball of the scene node, {:.3g} "
            "from its centre, radius {:.3g}",
            distance, radius);
        const bool asked = hasRule(settings.rules, kRuleSurfaces) && surfaceUsable(s.surface);
        if (asked) {
            const double off = static_cast<double>(t.off);
            const double offLeast = static_cast<double>(t.offLeast);
            const bool clear = t.off > t.offLeast;
            add("off its surface", off, clear ? ">" : "<=", offLeast);
            out.reason +=
                fmt::format("; it {} the surface, {:.3g} off its plane where {:.3g} is clear.",
                            clear                     ? "stands off"
                            : decision == kPairForced ? "is near, but looks at,"
                                                      : "lies on",
                            off, offLeast);
        } else {
            out.reason += ": it has neither size nor direction.";
        }
        return out;
    }

    const bool sceneFirst = decision == kPairSplitScene;
    out.reason =
        fmt::format("{} is split: {}; ", sceneFirst ? "The scene node" : "The view node", size);
    if (isLeaf(s) || isLeaf(v)) {
        out.reason += fmt::format("the {} node is a leaf.", isLeaf(s) ? "scene" : "view");
    } else if (!hasRule(settings.rules, kRuleRadius)) {
        add("level", s.level + 1, sceneFirst ? "<" : ">=", v.level + 1);
        out.reason += fmt::format("its level {} {} the view node's level {}.", s.level + 1,
                                  sceneFirst ? "is above" : "is not above", v.level + 1);
    } else {
        add("radius, twice the views'", radius, sceneFirst ? ">=" : "<", 2 * viewRadius);
        out.reason += fmt::format("the scene node's radius {:.3g} is {} twice the views', {:.3g}.",
                                  radius, sceneFirst ? "at least" : "below", 2 * viewRadius);
    }
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
