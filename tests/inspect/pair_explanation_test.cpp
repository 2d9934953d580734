// Why pairs are decided as they are: what is said agrees with the decision, of every pair.

#include "megaviews/inspect/pair_explanation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "inspect/inspect_scenes.h"
#include "megaviews/inspect/steps.h"
#include "support/sanitized.h"

namespace mv {
namespace {

using testing::InspectCase;

bool isTrue(const PairComparison& c) {
    if (c.relation == "<") return c.value < c.limit;
    if (c.relation == ">=") return c.value >= c.limit;
    if (c.relation == ">") return c.value > c.limit;
    return c.relation == "<=" && c.value <= c.limit;
}

TEST(PairExplanation, AgreesWithTheDecisionOfEveryPair) {
    std::map<std::pair<uint, std::uint32_t>, std::uint64_t> found;
    std::uint64_t bySurface = 0;
    testing::forAllCases([&](const InspectCase& c, const MethodSettings& options,
                             const ViewHierarchy& views) {
        const auto& nodes = testing::nodesOf(c, options.rules);
        if (nodes.empty() || views.nodes.empty()) return;
        for (int step = 1; step < 14; step += testing::kSanitized ? 4 : 1) {
            const StepResult result = traversalStep(nodes, views, options, {.step = step});
            for (const NodePair& pair : result.pairs) {
                const PairExplanation e =
                    explainPair(nodes, views.nodes, options, pair.scene, pair.view);
                ASSERT_EQ(e.pair, pair);
                ASSERT_FALSE(e.reason.empty());
                const SceneNode& s = nodes[pair.scene];
                const ViewNode& v = views.nodes[pair.view];
                std::map<std::string_view, std::string_view> said;
                for (const PairComparison& comparison : e.comparisons) {
                    EXPECT_TRUE(isTrue(comparison))
                        << e.reason << ": " << comparison.what << " " << comparison.value
                        << comparison.relation << comparison.limit;
                    said[comparison.what] = comparison.relation;
                    if (comparison.what == "size, texels") {
                        EXPECT_EQ(comparison.value, projectedTexels(s, v, options));
                    }
                    EXPECT_TRUE(std::isfinite(comparison.limit));
                }
                const bool boxes = hasRule(options.rules, kRuleBoxes);
                const bool byRadius = hasRule(options.rules, kRuleRadius);
                const auto horizon = boxes ? "below the horizon" : "out of sight";
                const bool culled = pair.decision == kPairCulled;
                EXPECT_EQ(said.contains(horizon), (v.flags & kViewNodeNoCull) == 0);
                if (said.contains(horizon)) {
                    EXPECT_EQ(said[horizon], culled ? ">" : "<=");
                }
                EXPECT_EQ(said.contains("size, texels"), !culled);
                if (!culled) {
                    EXPECT_EQ(said["size, texels"], pair.decision == kPairRendered ? "<" : ">=");
                }
                const bool leaves = isLeaf(s) && isLeaf(v);
                const bool last = !culled && pair.decision != kPairRendered;
                EXPECT_EQ(said.contains("distance, radius"), last && leaves);
                if (said.contains("distance, radius") && said["distance, radius"] == ">") {
                    EXPECT_EQ(pair.decision, kPairForced);
                }
                if (pair.decision == kPairSkipped) {
                    EXPECT_EQ(said["distance, radius"], "<=");
                    EXPECT_NE(said["off its surface"], ">");
                }
                if (said.contains("off its surface")) {
                    ++bySurface;
                    if (said["off its surface"] == ">") {
                        EXPECT_EQ(pair.decision, kPairForced);
                    }
                }
                const auto subdivision = byRadius ? "radius, twice the views'" : "level";
                EXPECT_EQ(said.contains(subdivision), last && !isLeaf(s) && !isLeaf(v));
                if (said.contains(subdivision)) {
                    const bool scene = said[subdivision] == (byRadius ? ">=" : "<");
                    EXPECT_EQ(pair.decision, scene ? kPairSplitScene : kPairSplitView);
                }
                ++found[{options.rules, pair.decision}];
            }
        }
    });
    for (const uint rules : {kPublishedRules, kCorrectedRules}) {
        for (std::uint32_t decision = kPairCulled; decision <= kPairSkipped; ++decision) {
            EXPECT_GT((found[{rules, decision}]), 0u) << decision;
        }
    }
    EXPECT_GT(bySurface, 0u);
}

TEST(PairExplanation, SizesAreInTexelsOfTheMap) {
    const InspectCase room = testing::inspectCases()[0];
    const ViewHierarchy views = ViewHierarchy::build(room.slots, {});
    const auto& nodes = room.scene.nodes;
    const StepResult step = traversalStep(nodes, views, {}, {.step = 8});
    int compared = 0;
    for (const NodePair& pair : step.pairs) {
        const auto texels = [&](const MethodSettings& options) {
            return projectedTexels(nodes[pair.scene], views.nodes[pair.view], options);
        };
        const double size = texels({});
        if (!std::isfinite(size)) continue;
        EXPECT_NEAR(texels({.maps = {64}}) / size, 4, 1e-5) << "of a map four times as fine";
        EXPECT_NEAR(texels({.pairs = {.size = 3}}) / size, 1, 1e-5) << "whatever the threshold";
        const PairExplanation e =
            explainPair(nodes, views.nodes, {.pairs = {.size = 3}}, pair.scene, pair.view);
        for (const PairComparison& comparison : e.comparisons) {
            if (comparison.what != "size, texels") continue;
            EXPECT_NEAR(comparison.limit, 6, 1e-5) << "three times the rules' two texels";
            ++compared;
        }
    }
    EXPECT_GT(compared, 10);
}

}  // namespace
}  // namespace mv
