// The traversal step by step: all steps together are the traversal, and it stops when told to.

#include "megaviews/inspect/steps.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "inspect/inspect_scenes.h"

namespace mv {
namespace {

using testing::InspectCase;
using testing::PairKey;

TEST(TraversalStep, AllStepsTogetherAreTheTraversal) {
    testing::forAllCases(
        [](const InspectCase& c, const TraversalOptions& options, const ViewHierarchy& views) {
            const auto& nodes = testing::nodesOf(c, options.rules);
            if (options.viewRes != 16) return;
            std::set<PairKey> seen;
            std::uint64_t previousChildren = 0;  // the roots at first
            for (const ViewNode& node : views.nodes) previousChildren += parentOf(node) == kNone;
            StepResult result;
            for (int step = 1; step < 100 && !result.finished; ++step) {
                result = traversalStep(nodes, views, options, {.step = step});
                if (nodes.empty() || views.nodes.empty()) {
                    EXPECT_EQ(result.step, 0);
                    EXPECT_TRUE(result.pairs.empty());
                    return;
                }
                ASSERT_EQ(result.step, step);
                ASSERT_EQ(result.countsPerStep.size(), static_cast<std::size_t>(step));
                EXPECT_EQ(result.countsPerStep.back().processed, result.pairs.size());
                EXPECT_EQ(result.pairs.size(), previousChildren);
                previousChildren = 0;
                for (const NodePair& pair : result.pairs) {
                    EXPECT_TRUE(seen.insert(testing::keyOf(pair)).second);
                    if (pair.decision == kPairSplitScene)
                        previousChildren += childCountOf(nodes[pair.scene].children);
                    if (pair.decision == kPairSplitView)
                        previousChildren += childCountOf(views.nodes[pair.view].children);
                }
            }
            EXPECT_TRUE(result.finished);
            EXPECT_FALSE(result.stopped);
            EXPECT_EQ(seen, testing::allPairs(nodes, views, options));
            EXPECT_EQ(sumOf(result.countsPerStep), traverse(nodes, views, options).counts);
            // Beyond the last step there is nothing more.
            const StepResult beyond = traversalStep(nodes, views, options, {.step = 1000});
            EXPECT_EQ(beyond.step, result.step);
            EXPECT_EQ(beyond.pairs, result.pairs);
            EXPECT_TRUE(beyond.finished);
        });
}

TEST(TraversalStep, StartsFromAnyPair) {
    const InspectCase room = testing::inspectCases()[0];
    const ViewHierarchy views = ViewHierarchy::build(room.slots, {});
    const TraversalOptions options;
    for (const std::uint32_t scene : {0u, 3u, 40u}) {
        for (const std::uint32_t view : {1u, 5u, 17u}) {
            std::set<PairKey> expected, seen;
            testing::allPairs(room.scene.nodes, views, options, scene, view, expected);
            for (int step = 1;; ++step) {
                const StepResult result = traversalStep(
                    room.scene.nodes, views, options, {.step = step, .scene = scene, .view = view});
                if (step == 1) {
                    ASSERT_EQ(result.pairs.size(), 1u);
                    EXPECT_EQ(result.pairs[0].scene, scene);
                    EXPECT_EQ(result.pairs[0].view, view);
                }
                for (const NodePair& pair : result.pairs) seen.insert(testing::keyOf(pair));
                if (result.finished) break;
            }
            EXPECT_EQ(seen, expected);
        }
    }
    const auto none = [&](StepOptions o) {
        const StepResult r = traversalStep(room.scene.nodes, views, options, o);
        return r.step == 0 && r.pairs.empty() && r.countsPerStep.empty();
    };
    EXPECT_TRUE(none({.step = 0}));
    EXPECT_TRUE(none({.step = -3}));
    EXPECT_TRUE(none({.scene = static_cast<std::uint32_t>(room.scene.nodes.size())}));
    EXPECT_TRUE(none({.view = static_cast<std::uint32_t>(views.nodes.size())}));
    EXPECT_TRUE(none({.scene = kNone, .view = kNone}));
}

TEST(TraversalStep, NeverTestsMoreThanItsBound) {
    const InspectCase room = testing::inspectCases()[0];
    const ViewHierarchy views = ViewHierarchy::build(room.slots, {});
    // A bound that just holds the first k steps, and one that just does not.
    const StepResult all = traversalStep(room.scene.nodes, views, {}, {.step = 7});
    ASSERT_EQ(all.step, 7);
    std::uint64_t tested = 0;
    for (int k = 1; k <= 7; ++k) {
        tested += all.countsPerStep[static_cast<std::size_t>(k - 1)].processed;
        for (const int missing : {0, 1}) {
            const std::uint64_t bound = tested - static_cast<std::uint64_t>(missing);
            const StepResult result =
                traversalStep(room.scene.nodes, views, {}, {.step = 50, .maxPairs = bound});
            EXPECT_EQ(result.step, k - missing);
            EXPECT_TRUE(result.stopped);
            EXPECT_FALSE(result.finished);
            EXPECT_LE(sumOf(result.countsPerStep).processed, bound);
            EXPECT_EQ(result.countsPerStep.size(), static_cast<std::size_t>(result.step));
        }
    }
}

TEST(TraversalStep, DrawsBoxesOnceAndALinkForEachPairUpToACap) {
    const InspectCase room = testing::inspectCases()[0];
    const ViewHierarchy views = ViewHierarchy::build(room.slots, {});
    const auto linkOf = [&](const NodePair& pair) {
        return Line{boxCenter(room.scene.nodes[pair.scene]), boxCenter(views.nodes[pair.view]),
                    colourOfDecision(pair.decision)};
    };
    bool few = false, many = false;
    for (int step = 1; step < 6; ++step) {
        const StepResult result = traversalStep(room.scene.nodes, views, {}, {.step = step});
        const std::uint64_t pairs = result.pairs.size();
        std::vector<Line> lines;
        EXPECT_EQ(appendStep(result, room.scene.nodes, views, lines), (DrawnCount{pairs, pairs}));
        std::uint64_t links = 0;
        for (const NodePair& pair : result.pairs) {
            const auto found = std::count(lines.begin(), lines.end(), linkOf(pair));
            EXPECT_LE(found, 1);
            links += static_cast<std::uint64_t>(found);
        }
        EXPECT_EQ(links, std::min(pairs, kMaxDrawnLinks));
        few = few || (pairs > 8 && pairs < kMaxDrawnLinks);
        many = many || pairs > kMaxDrawnLinks;
        // Boxes in common are drawn once.
        EXPECT_TRUE(pairs < 20 || lines.size() < 25 * pairs);

        lines.clear();
        EXPECT_EQ(appendStep(result, room.scene.nodes, views, lines, 7),
                  (DrawnCount{pairs, std::min<std::uint64_t>(pairs, 7)}));
        EXPECT_LE(lines.size(), 7u * 25u);
    }
    EXPECT_TRUE(few && many);
    std::vector<Line> lines;
    EXPECT_EQ(appendStep({}, room.scene.nodes, views, lines), DrawnCount{});
    EXPECT_TRUE(lines.empty());
}

}  // namespace
}  // namespace mv
