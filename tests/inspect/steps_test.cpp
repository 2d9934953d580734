// The traversal step by step: all steps together are the traversal, and it stops when told to.

#include "megaviews/inspect/steps.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "inspect/inspect_scenes.h"
#include "megaviews/inspect/pair_explanation.h"

namespace mv {
namespace {

using testing::InspectCase;
using testing::PairKey;

TEST(TraversalStep, AllStepsTogetherAreTheTraversal) {
    testing::forAllCases(
        [](const InspectCase& c, const MethodSettings& options, const ViewHierarchy& views) {
            const auto& nodes = testing::nodesOf(c, options.rules);
            if (options.maps.resolution != 16) return;
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
    const MethodSettings options;
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

class StepDrawing : public ::testing::Test {
  protected:
    const InspectCase room = testing::inspectCases()[0];
    const ViewHierarchy views = ViewHierarchy::build(room.slots, {});
    const SceneNodes& nodes = room.scene.nodes;

    std::vector<NodePair> pairsOf(int step) const {
        return traversalStep(nodes, views, {}, {.step = step}).pairs;
    }
    ChosenPairs choose(const std::vector<NodePair>& pairs, const StepChoice& choice,
                       std::uint64_t cap = kMaxDrawnNodes) const {
        return choosePairs(pairs, nodes, views, {}, choice, cap);
    }
    Line linkOf(const NodePair& pair) const {
        return {boxCenter(nodes[pair.scene]), boxCenter(views.nodes[pair.view]),
                colourOfDecision(pair.decision)};
    }
};

TEST_F(StepDrawing, BoxesOnceAndALinkForEachPairUpToACap) {
    bool few = false, many = false;
    for (int step = 1; step < 6; ++step) {
        const std::vector<NodePair> all = pairsOf(step);
        const std::uint64_t pairs = all.size();
        const ChosenPairs chosen = choose(all, {});
        EXPECT_EQ(chosen.pairs, all);
        EXPECT_EQ(chosen.eligible, pairs);
        std::vector<Line> lines;
        EXPECT_EQ(appendStep(all, nodes, views, lines),
                  (DrawnCount{pairs, std::min(pairs, kMaxDrawnLinks)}));
        std::uint64_t links = 0;
        for (const NodePair& pair : all) {
            const auto found = std::count(lines.begin(), lines.end(), linkOf(pair));
            EXPECT_LE(found, 1);
            links += static_cast<std::uint64_t>(found);
        }
        EXPECT_EQ(links, std::min(pairs, kMaxDrawnLinks));
        few = few || (pairs > 8 && pairs < kMaxDrawnLinks);
        many = many || pairs > kMaxDrawnLinks;
        // Boxes in common are drawn once.
        EXPECT_TRUE(pairs < 20 || lines.size() < 25 * pairs);

        const ChosenPairs seven = choose(all, {}, 7);
        EXPECT_EQ(seven.eligible, pairs);
        EXPECT_EQ(seven.pairs.size(), std::min<std::uint64_t>(pairs, 7));
    }
    EXPECT_TRUE(few && many);
    std::vector<Line> lines;
    EXPECT_EQ(appendStep({}, nodes, views, lines), DrawnCount{});
    EXPECT_TRUE(lines.empty());
}

TEST_F(StepDrawing, HiddenOutcomesAreLeftOut) {
    for (int step = 1; step < 12; ++step) {
        const std::vector<NodePair> all = pairsOf(step);
        std::uint64_t together = 0;
        for (std::uint32_t outcome = 0; outcome < kOutcomeNames.size(); ++outcome) {
            StepChoice choice;
            choice.hidden.fill(true);
            choice.hidden[outcome] = false;
            const ChosenPairs chosen = choose(all, choice);
            for (const NodePair& pair : chosen.pairs) {
                EXPECT_EQ(pair.decision, outcome + kPairCulled);
            }
            together += chosen.eligible;
        }
        EXPECT_EQ(together, all.size());
    }
}

TEST_F(StepDrawing, TheLargestComeFirst) {
    const std::vector<NodePair> all = pairsOf(7);
    ASSERT_GT(all.size(), kMaxDrawnLinks);
    const auto sizeOf = [&](const NodePair& pair) {
        return projectedTexels(nodes[pair.scene], views.nodes[pair.view], {});
    };
    const ChosenPairs chosen = choose(all, {.show = StepPairs::largest});
    EXPECT_EQ(chosen.eligible, all.size());
    ASSERT_EQ(chosen.pairs.size(), kMaxDrawnLinks) << "each with its link";
    for (std::size_t i = 1; i < chosen.pairs.size(); ++i) {
        EXPECT_GE(sizeOf(chosen.pairs[i - 1]), sizeOf(chosen.pairs[i]));
    }
    const double least = sizeOf(chosen.pairs.back());
    const auto larger =
        std::count_if(all.begin(), all.end(), [&](const NodePair& p) { return sizeOf(p) > least; });
    EXPECT_LE(static_cast<std::uint64_t>(larger), kMaxDrawnLinks);
}

// Above and below the picked pair: what it came from and what becomes of it, told by recursion.
TEST_F(StepDrawing, OfAPickedPairItsAncestorsAndDescendants) {
    const auto isBelow = [](const auto& tree, std::uint32_t node, std::uint32_t above) {
        std::vector<std::uint32_t> open{above};
        while (!open.empty()) {
            const std::uint32_t n = open.back();
            open.pop_back();
            if (n == node) return true;
            for (uint k = 0; k < childCountOf(tree[n].children); ++k) {
                open.push_back(firstChildOf(tree[n].children) + k);
            }
        }
        return false;
    };
    const std::vector<NodePair> middle = pairsOf(5);
    std::uint64_t found = 0;
    for (std::size_t i = 0; i < middle.size(); i += 17) {
        const NodePair& picked = middle[i];
        for (const int step : {1, 3, 5, 6, 8}) {
            const std::vector<NodePair> all = pairsOf(step);
            std::vector<NodePair> expected;
            for (const NodePair& p : all) {
                const bool above = isBelow(nodes, picked.scene, p.scene) &&
                                   isBelow(views.nodes, picked.view, p.view);
                const bool below = isBelow(nodes, p.scene, picked.scene) &&
                                   isBelow(views.nodes, p.view, picked.view);
                if (above || below) expected.push_back(p);
            }
            EXPECT_EQ(choose(all, {.show = StepPairs::ofPair, .pair = picked}).pairs, expected)
                << "step " << step << ", pair " << i;
            found += expected.size();
        }
    }
    EXPECT_GT(found, 3 * middle.size() / 17) << "at least itself and what it came from";
    EXPECT_TRUE(choose(middle, {.show = StepPairs::ofPair}).pairs.empty()) << "none is picked";
}

TEST_F(StepDrawing, OfPickedViewsThoseOfTheNodesThatHoldThem) {
    const std::uint32_t leaf = views.leafOfView[7];
    const std::vector<NodePair> all = pairsOf(8);
    std::vector<NodePair> expected;
    for (const NodePair& p : all) {
        const ViewNode& node = views.nodes[p.view];
        if (node.firstView <= 7 && 7 < node.firstView + node.viewCount) expected.push_back(p);
    }
    EXPECT_EQ(choose(all, {.show = StepPairs::ofViews, .viewLeaves = {leaf}}).pairs, expected);
    EXPECT_FALSE(expected.empty());
    EXPECT_TRUE(choose(all, {.show = StepPairs::ofViews}).pairs.empty());
}

TEST_F(StepDrawing, APairIsPickedByItsLinkOrItsBoxes) {
    const std::vector<NodePair> all = pairsOf(3);
    const vec3 eye(0.4f, 0.45f, 3);
    const auto at = [&](vec3 point) {
        PickRay ray;
        ray.origin = eye;
        ray.direction = normalizeOr(point - eye, vec3(0, 0, -1));
        ray.spread = 0.002f;
        return pairsAlong(all, nodes, views, ray);
    };
    for (const NodePair& pair : all) {
        const vec3 scene = boxCenter(nodes[pair.scene]), view = boxCenter(views.nodes[pair.view]);
        const auto picked = at(scene + (view - scene) * 0.37f);
        ASSERT_FALSE(picked.empty());
        EXPECT_TRUE(std::ranges::count(picked, static_cast<std::size_t>(&pair - all.data())));
        ASSERT_FALSE(at(scene + boxHalf(nodes[pair.scene])).empty());
        // Of those whose lines cross there one is taken: what is near it is near the point.
        EXPECT_EQ(pairsAlong(std::span(&pair, 1), nodes, views,
                             {eye, normalizeOr(scene - eye, vec3(0)), 0, 0.002f}),
                  std::vector<std::size_t>{0});
    }
    std::size_t itself = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const vec3 scene = boxCenter(nodes[all[i].scene]),
                   view = boxCenter(views.nodes[all[i].view]);
        itself += at(scene + (view - scene) * 0.37f).front() == i;
    }
    EXPECT_GT(itself, all.size() / 2);
    EXPECT_TRUE(at(vec3(0.5f, 8, 0.5f)).empty()) << "nothing is there";
    PickRay away;
    away.origin = eye;
    away.direction = {0, 0, 1};
    away.spread = 0.02f;
    EXPECT_TRUE(pairsAlong(all, nodes, views, away).empty()) << "all of it lies behind";
}

}  // namespace
}  // namespace mv
