// Cuts that are kept from frame to frame against those that start from the root: the same maps,
// however views and nodes move; what a clearance promises; how lazy cuts catch up.

#include "megaviews/methods/manylods/cuts.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>

#include "megaviews/methods/megaviews/traversal.h"
#include "support/synthetic.h"

namespace mv {
namespace {

using testing::flat;
using testing::kBothRules;
using testing::nodesOf;
using testing::SyntheticScene;

void expectBasicMaps(const CutUpdate& got, const SceneNodes& nodes, const ViewHierarchy& views,
                     const MethodSettings& options) {
    const TraversalResult want = traverse(nodes, views, options);
    EXPECT_EQ(got.leafMaps.texels, want.leafMaps.texels);
    // The nodes at which the descents from the root ended.
    EXPECT_EQ(got.cuts.nodes, want.counts.processed - want.counts.subdivided);
    EXPECT_EQ(got.cuts.coarse, 0u);
    EXPECT_EQ(got.counts.processed,
              got.counts.culled + got.counts.rendered + got.counts.subdivided + got.counts.skipped);
}

// Within its clearance a view may go anywhere, and turn: no decision changes.
TEST(CutTest, ClearancesHold) {
    const SyntheticScene room = testing::makeRoom(7);
    std::mt19937 random(5);
    const float pairRes = pairResolution(MethodSettings{});
    std::array<int, 8> held{};
    for (const uint rules : kBothRules) {
        const auto& nodes = nodesOf(room, rules);
        for (const ViewNode& view : flat(testing::viewsOfAllKinds(room, 400, 2)).nodes) {
            for (int k = 0; k < 300; ++k) {
                const auto index = std::uniform_int_distribution<std::size_t>(
                    0, k % 2 ? nodes.size() - 1 : nodes.size() / 8)(random);
                PairTerms terms;
                const uint decision = decidePair(nodes[index], view, rules, pairRes, terms);
                const float clearance = pairClearance(nodes[index], view, decision, pairRes, terms);
                if (clearance <= 0) continue;
                ++held[decision];
                ViewNode moved = view;
                const vec3 way = testing::randomDirection(random) * clearance *
                                 (k % 3 ? 0.999f : testing::randomIn(random, 0, 1));
                moved.centerX += way.x;
                moved.centerY += way.y;
                moved.centerZ += way.z;
                if (k % 5 == 0) {
                    const vec3 axis = glm::normalize(
                        axisOf(view) + testing::randomDirection(random) * clearance * 0.3f);
                    moved.axisX = axis.x;
                    moved.axisY = axis.y;
                    moved.axisZ = axis.z;
                }
                if (displacementOf(moved, cutViewOf(view, kCutBelow)) > clearance) continue;
                ASSERT_EQ(decidePair(nodes[index], moved, rules, pairRes), decision)
                    << "node " << index << " clearance " << clearance << " way "
                    << glm::length(way);
            }
        }
    }
    for (const uint decision : {kPairCulled, kPairRendered, kPairForced, kPairSplitScene})
        EXPECT_GT(held[decision], 200) << decision;
}

TEST(CutTest, WhatIsLeftOfAClearanceNeverGrows) {
    EXPECT_EQ(clearanceLeft(0.5f, 0.0f), 0.5f);
    EXPECT_LE(clearanceLeft(0.5f, 1e-9f), 0.5f);
    EXPECT_LT(clearanceLeft(0.5f, 0.5f), 0.0f);
    EXPECT_LT(clearanceLeft(-1.0f, 0.1f), 0.0f);
    EXPECT_GT(clearanceLeft(kInfinity, 1.0f), 1.0f);
    EXPECT_LT(clearanceLeft(kInfinity, kInfinity), 0.0f);  // another kind of view
}

// Why ancestors must be known: validity is not monotone, so that the rule of a node and its parent
// alone may stand still at more than one cut. A wall two cells thick, of which a child holds the
// side towards the view: hardly smaller, but nearer.
TEST(CutTest, DescendantsOfValidNodesMayBeTooLarge) {
    SceneNode wall{};
    wall.children = packChildren(1, 2);
    wall.centerX = wall.centerY = wall.centerZ = 0.5f;
    wall.halfY = 0.02f, wall.halfX = 0.002f;
    SceneNode side = wall;
    side.halfX = 0.001f;
    side.centerX -= 0.001f;
    const float pairRes = pairResolution(MethodSettings{});
    int notMonotone = 0;
    for (float away = 0.05f; away < 0.3f; away += 1e-6f) {
        const View view = testing::makeView(vec3(0.5f - away, 0.5f, 0.5f), vec3(0), 0, true);
        const ViewNode node = flat({view}).nodes[0];
        notMonotone += decidePair(wall, node, kCorrectedRules, pairRes) == kPairRendered &&
                       decidePair(side, node, kCorrectedRules, pairRes) == kPairSplitScene;
    }
    EXPECT_GT(notMonotone, 100);
}

TEST(CutTest, IncrementalCutsAreThoseFromTheRoot) {
    const SyntheticScene room = testing::makeRoom(7);
    for (const uint rules : kBothRules) {
        for (const int res : {8, 16}) {
            const MethodSettings options{.rules = rules, .maps = {res}};
            ViewCuts cuts(nodesOf(room, rules));
            std::mt19937 random(4);
            std::vector<View> views = testing::viewsOfAllKinds(room, 60, 1);
            std::uint64_t merged = 0;
            // Small steps, large ones, none, and a leap across the room.
            for (const float far : {0.001f, 0.01f, 0.1f, 0.0f, 0.003f, 1.0f, 0.02f}) {
                SCOPED_TRACE("R=" + std::to_string(res) + ", then moved by " + std::to_string(far));
                const ViewHierarchy hierarchy = flat(views);
                const CutUpdate got = cuts.update(nodesOf(room, rules), hierarchy, {options});
                expectBasicMaps(got, nodesOf(room, rules), hierarchy, options);
                merged += got.cuts.merged;
                testing::moveViews(views, far, random);
                // One view goes, one comes, one sees the other half of space.
                std::swap(views.back().flags, views[views.size() / 2].flags);
                if (views[3].flags == kViewDead) views[3] = views[4], views[3].slot = 3;
                views[views.size() % 7].flags = kViewDead;
            }
            EXPECT_GT(merged, 100u);
        }
    }
}

TEST(CutTest, AwkwardScenes) {
    const SyntheticScene point = testing::makeScene({{vec3(0.5f), vec3(0), vec3(0)}}, 5);
    const SyntheticScene one = testing::makeScene({{vec3(0.5f), vec3(0.1f), vec3(0)}}, 1);
    const SyntheticScene empty = testing::makeEmptyScene();
    for (const SyntheticScene* scene : {&point, &one, &empty}) {
        ViewCuts cuts(scene->nodes);
        std::mt19937 random(1);
        std::vector<View> views = testing::particlesInside(20, 1);
        for (int frame = 0; frame < 3; ++frame) {
            const CutUpdate got = cuts.update(scene->nodes, flat(views), {});
            expectBasicMaps(got, scene->nodes, flat(views), {});
            testing::moveViews(views, 0.3f, random);
        }
        EXPECT_EQ(cuts.update(scene->nodes, flat({}), {}).cuts, CutCounts{});
    }
}

TEST(CutTest, OtherRulesOrSizesStartFromTheRoot) {
    const SyntheticScene room = testing::makeRoom(6);
    const ViewHierarchy views = flat(testing::viewsOfAllKinds(room, 20, 1));
    ViewCuts cuts(room.nodes);
    for (const MethodSettings& options :
         {MethodSettings{}, MethodSettings{.maps = {8}}, MethodSettings{.pairs = {.size = 2}}}) {
        expectBasicMaps(cuts.update(room.nodes, views, {options}), room.nodes, views, options);
    }
}

// A subtree that an animation moves, and the boxes above it that grow and shrink with it.
TEST(CutTest, NodesThatMoveAreTestedAnew) {
    const SyntheticScene room = testing::makeRoom(7);
    const std::vector<std::uint32_t> begin = testing::lastSubtree(room);
    ViewCuts cuts(room.nodes, begin);
    std::mt19937 random(6);
    std::vector<View> views = testing::viewsOfAllKinds(room, 60, 1);
    SceneNodes nodes = room.nodes;
    for (int frame = 0; frame < 6; ++frame) {
        const ViewHierarchy hierarchy = flat(views);
        expectBasicMaps(cuts.update(nodes, hierarchy, {}), nodes, hierarchy, {});
        testing::moveSubtree(room, begin, random, nodes);
        if (frame % 2) testing::moveViews(views, 0.002f, random);
    }
}

TEST(CutTest, SmallStepsTestFewPairs) {
    const SyntheticScene room = testing::makeRoom(8);
    std::mt19937 random(7);
    std::vector<View> views = testing::viewsOnSurfaces(room, 40, 1);
    ViewCuts cuts(room.nodes);
    const std::uint64_t fromRoot = cuts.update(room.nodes, flat(views), {}).counts.processed;
    for (int frame = 0; frame < 4; ++frame) {
        testing::moveViews(views, 0.001f, random);
        const CutUpdate got = cuts.update(room.nodes, flat(views), {});
        EXPECT_LT(got.counts.processed * 2, fromRoot);
        EXPECT_GT(got.cuts.kept * 2, got.cuts.nodes);
    }
    const CutUpdate still = cuts.update(room.nodes, flat(views), {});
    EXPECT_LT(still.counts.processed * 50, fromRoot);
    EXPECT_EQ(still.cuts.split + still.cuts.merged, 0u);
    EXPECT_EQ(still.cuts.iterations, 1u);
}

// Lazy cuts lag behind views that leap, are too coarse where they do, and catch up by a level an
// update and iteration while the views stand still.
TEST(CutTest, LazyCutsCatchUp) {
    const SyntheticScene room = testing::makeRoom(7);
    std::uint64_t coarse[2];
    for (const std::uint32_t iterations : {1u, 2u}) {
        std::mt19937 random(8);
        std::vector<View> views = testing::viewsOfAllKinds(room, 60, 1);
        ViewCuts cuts(room.nodes);
        const CutOptions options{{}, iterations};
        // Views without a cut are not lazy.
        expectBasicMaps(cuts.update(room.nodes, flat(views), options), room.nodes, flat(views), {});
        testing::moveViews(views, 0.5f, random);
        const ViewHierarchy hierarchy = flat(views);
        CutUpdate last = cuts.update(room.nodes, hierarchy, options);
        coarse[iterations - 1] = last.cuts.coarse;
        EXPECT_GT(last.cuts.coarseShare(), 0.0);
        EXPECT_LE(last.cuts.iterations, iterations + 1);
        int updates = 1;
        for (; last.cuts.coarse > 0 && updates < room.levels; ++updates) {
            const std::uint64_t nodes = last.cuts.nodes;
            last = cuts.update(room.nodes, hierarchy, options);
            EXPECT_GT(last.cuts.nodes, nodes);
        }
        EXPECT_GT(updates, 1);
        expectBasicMaps(last, room.nodes, hierarchy, {});
    }
    EXPECT_GT(coarse[0], coarse[1]);
}

}  // namespace
}  // namespace mv
