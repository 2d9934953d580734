#pragma once
// Small scenes, views and hierarchies for the tests of the instruments, and every pair of a
// traversal by naive recursion.

#include <functional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "megaviews/inspect/view_pairs.h"
#include "megaviews/methods/megaviews/traversal.h"
#include "support/synthetic.h"

namespace mv::testing {

struct InspectCase {
    std::string name;
    SyntheticScene scene;
    std::vector<View> slots;
};

inline std::vector<InspectCase> inspectCases() {
    std::vector<InspectCase> cases;
    cases.push_back({"room", makeRoom(5), {}});
    cases.back().slots = viewsOnSurfaces(cases.back().scene, 60, 1);
    for (const View& p : particlesInside(7, 2)) cases.back().slots.push_back(p);
    // Several views in one leaf, and dead slots between them.
    for (int k = 0; k < 5; ++k) {
        cases.back().slots.push_back(
            makeView({0.51f, 0.3f, 0.51f}, {0, k % 2 ? 1.0f : -1.0f, 0}, 0));
        cases.back().slots.push_back({});
    }
    for (std::size_t i = 0; i < cases.back().slots.size(); ++i) {
        if (cases.back().slots[i].flags != kViewDead)
            cases.back().slots[i].slot = static_cast<std::uint32_t>(i);
    }
    cases.push_back({"fibres", makeFibres(6, 20, 3), particlesInside(20, 4)});
    cases.push_back({"one patch",
                     makeScene({{{0.3f, 0.2f, 0.4f}, {0.01f, 0, 0}, {0, 0, 0.01f}}}, 4),
                     {makeView({0.6f, 0.7f, 0.5f}, {0, -1, 0}, 0)}});
    cases.push_back({"no views", makeRoom(3), {}});
    cases.push_back({"empty scene", makeEmptyScene(), particlesInside(3, 5)});
    return cases;
}

inline const SceneNodes& nodesOf(const InspectCase& c, uint rules) {
    return nodesOf(c.scene, rules);
}

using PairKey = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;
inline PairKey keyOf(const NodePair& p) { return {p.view, p.scene, p.decision}; }

// Every pair that the traversal tests, from (scene, view) on.
inline void allPairs(const SceneNodes& scene, const ViewHierarchy& views,
                     const MethodSettings& options, std::uint32_t s, std::uint32_t v,
                     std::set<PairKey>& out) {
    const uint decision =
        decidePair(scene[s], views.nodes[v], options.rules, pairResolution(options));
    out.insert({v, s, decision});
    if (decision == kPairSplitScene)
        for (uint k = 0; k < childCountOf(scene[s].children); ++k)
            allPairs(scene, views, options, firstChildOf(scene[s].children) + k, v, out);
    if (decision == kPairSplitView)
        for (uint k = 0; k < childCountOf(views.nodes[v].children); ++k)
            allPairs(scene, views, options, s, firstChildOf(views.nodes[v].children) + k, out);
}
inline std::set<PairKey> allPairs(const SceneNodes& scene, const ViewHierarchy& views,
                                  const MethodSettings& options) {
    std::set<PairKey> out;
    for (std::uint32_t v = 0; v < views.nodes.size() && !scene.empty(); ++v)
        if (parentOf(views.nodes[v]) == kNone) allPairs(scene, views, options, 0, v, out);
    return out;
}

// Runs test(case, options, hierarchy) for all cases, rules, trees and a few resolutions.
inline void forAllCases(const std::function<void(const InspectCase&, const MethodSettings&,
                                                 const ViewHierarchy&)>& test) {
    for (const InspectCase& c : inspectCases()) {
        for (const uint rules : {kCorrectedRules, kPublishedRules}) {
            for (const bool flat : {false, true}) {
                const ViewHierarchy views = ViewHierarchy::build(c.slots, {6, rules, flat});
                for (const auto& [res, fill] : {std::pair{8, true}, {32, true}, {16, false}}) {
                    SCOPED_TRACE(c.name + (rules == kPublishedRules ? ", published" : "") +
                                 (flat ? ", flat" : "") + ", R = " + std::to_string(res));
                    test(c, {.rules = rules, .maps = {res}, .pairs = {.holeFill = fill}}, views);
                }
            }
        }
    }
}

}  // namespace mv::testing
