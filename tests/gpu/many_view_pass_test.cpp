// Both traversals of the GPU against the CPU's reference: the same maps and counts,
// at awkward sizes and under both rule sets.

#include "gpu/many_view_fixture.h"

namespace mv {
namespace {

using test::describe;
using test::kBothRules;
using test::ManyViewPassTest;
using test::uploadScene;
using test::with;
using testing::SyntheticScene;

TEST_F(ManyViewPassTest, GivesTheCpusMapsAndCounts) {
    const SyntheticScene room = testing::makeRoom(6);
    const auto views = testing::viewsOnSurfaces(room, 150, 1);
    for (const uint rules : kBothRules) {
        for (const bool flat : {false, true}) {
            expectLikeCpu(room, views, with(rules, 16), {.flat = flat});
            expectLikeCpu(room, views, with(rules, 8), {.flat = flat});
        }
    }
}

// Kernels are compiled for each: a few of them.
TEST_F(ManyViewPassTest, TakesRulesBetween) {
    const SyntheticScene room = testing::makeRoom(5);
    const auto views = testing::viewsOnSurfaces(room, 60, 4);
    for (const uint rules : {kRuleCentroid | kRuleBoxes, kRuleLoneViews | kRuleBound,
                             kRuleRadius | kRuleTwoTexels | kRuleSurfaces}) {
        expectLikeCpu(room, views, with(rules, 16), {});
    }
}

TEST_F(ManyViewPassTest, TakesLargerAndSmallerPairs) {
    const SyntheticScene room = testing::makeRoom(6);
    const auto views = testing::viewsOnSurfaces(room, 60, 4);
    for (const uint rules : kBothRules) {
        for (const float size : {0.4f, 2.5f}) {
            ManyViewOptions o = with(rules, 16);
            o.pairs.size = size;
            expectLikeCpu(room, views, o, {});
        }
    }
}

TEST_F(ManyViewPassTest, CountsByLevelAsTheCpu) {
    const SyntheticScene room = testing::makeRoom(6);
    for (const uint rules : kBothRules) {
        ManyViewOptions o = with(rules, 16);
        o.countLevels = true;
        for (const std::size_t n : {1u, 9u, 150u}) {
            const auto views = testing::viewsOnSurfaces(room, n, 21);
            expectLikeCpu(room, views, o, {});
            expectLikeCpu(room, views, o, {.flat = true});
        }
        o.loopBudget = 2500;  // suspended work groups store their counts more than once
        expectLikeCpu(room, testing::viewsOnSurfaces(room, 40, 22), o, {});
    }
    // In several passes: nodes that two share count once.
    const ViewHierarchy tree =
        ViewHierarchy::build(testing::viewsOnSurfaces(room, 120, 9), {.levels = 6});
    const TraversalResult want =
        traverse(room.nodes, tree, {.rules = kCorrectedRules, .maps = {16}});
    for (const Traversal traversal : {Traversal::queue, Traversal::lists}) {
        ManyViewOptions o = with(kCorrectedRules, 16);
        o.pairs.traversal = traversal;
        o.countLevels = true;
        startAfresh();
        const MethodStatistics whole = render(room, tree, o);
        EXPECT_EQ(whole.passes.made, 1u);
        EXPECT_EQ(*std::max_element(whole.occupancy.begin(), whole.occupancy.end()),
                  whole.queuePeakPairs);
        o.queueMemoryBytes = whole.queuePeakPairs / 5 * (traversal == Traversal::queue ? 18 : 8);
        startAfresh();
        const MethodStatistics parts = render(room, tree, o);
        EXPECT_GT(parts.passes.made, 1u);
        for (std::size_t level = 0; level < want.countsPerLevel.size(); ++level) {
            expectSameCounts(whole.pairsPerLevel.at(level), want.countsPerLevel[level]);
            expectSameCounts(parts.pairsPerLevel.at(level), want.countsPerLevel[level]);
        }
    }
}

TEST_F(ManyViewPassTest, PredictsItsMemory) {
    const SyntheticScene room = testing::makeRoom(6);
    const ViewHierarchy tree =
        ViewHierarchy::build(testing::viewsOnSurfaces(room, 150, 1), {.levels = 6});
    for (const Traversal traversal : {Traversal::queue, Traversal::lists}) {
        for (const int res : {16, 64}) {
            for (const uint rules : kBothRules) {
                ManyViewOptions o = with(rules, res);
                o.pairs.traversal = traversal;
                startAfresh();
                maps_ = {};
                const MethodStatistics got = render(room, tree, o);
                SCOPED_TRACE(describe(o));
                EXPECT_EQ(got.predictedMapBytes, maps_.texels.bytes());
                EXPECT_GT(got.workingMapBytes, 0u);
                EXPECT_EQ(got.predictedWorkingMapBytes, got.workingMapBytes);
                EXPECT_GT(got.predictedQueueBytes, 0u);
                // What overflowed has grown.
                EXPECT_GE(got.queueBytes, got.predictedQueueBytes);
                if (res == 16) {
                    EXPECT_EQ(got.queueBytes, got.predictedQueueBytes);
                }
                EXPECT_EQ(got.mapBytes, maps_.texels.bytes() + got.workingMapBytes);
            }
        }
    }
}

TEST_F(ManyViewPassTest, GivesTheCpusMapsAtEveryResolution) {
    const SyntheticScene room = testing::makeRoom(6);
    const auto views = testing::viewsOnSurfaces(room, 20, 2);
    for (const uint rules : kBothRules) {
        for (const int res : {32, 64, 128}) {
            expectLikeCpu(room, views, with(rules, res), {.flat = false});
        }
        expectLikeCpu(room, views, with(rules, 64), {.flat = true});
        ManyViewOptions unfilled = with(rules, 64);
        unfilled.pairs.holeFill = false;
        expectLikeCpu(room, views, unfilled, {});
    }
    expectLikeCpu(room, testing::viewsOnSurfaces(room, 2, 3), with(kCorrectedRules, 256), {});
}

TEST_F(ManyViewPassTest, KeepsTheMapsOfAllNodesWithoutFusion) {
    const SyntheticScene room = testing::makeRoom(5);
    for (const uint rules : kBothRules) {
        for (const int res : {16, 64}) {
            ManyViewOptions o = with(rules, res);
            o.pairs.fusion = false;
            expectLikeCpu(room, testing::viewsOnSurfaces(room, 30, 4), o, {});
            expectLikeCpu(room, testing::viewsOnSurfaces(room, 9, 4), o, {.flat = true});
        }
    }
}

TEST_F(ManyViewPassTest, TakesAwkwardNumbersOfViews) {
    const SyntheticScene room = testing::makeRoom(5);
    for (const uint rules : kBothRules) {
        for (const std::size_t n : {0u, 1u, 2u, 7u, 8u, 9u, 63u, 64u, 65u}) {
            expectLikeCpu(room, testing::viewsOnSurfaces(room, n, 5), with(rules, 8), {});
        }
        for (const std::size_t n : {0u, 1u, 9u, 65u}) {
            expectLikeCpu(room, testing::viewsOnSurfaces(room, n, 5), with(rules, 8),
                          {.flat = true});
        }
    }
}

TEST_F(ManyViewPassTest, TakesAwkwardScenes) {
    const SyntheticScene empty = testing::makeEmptyScene();
    const SyntheticScene one =
        testing::makeScene({{vec3(0.3f, 0.4f, 0.2f), vec3(0.01f, 0, 0), vec3(0, 0.01f, 0)}}, 6);
    const SyntheticScene point = testing::makeScene({{vec3(0.5f), vec3(0), vec3(0)}}, 6);
    const SyntheticScene rootOnly =
        testing::makeScene({{vec3(0.3f, 0.4f, 0.2f), vec3(0.01f, 0, 0), vec3(0, 0.01f, 0)}}, 1);
    const auto particles = testing::particlesInside(40, 6);
    for (const uint rules : kBothRules) {
        for (const bool flat : {false, true}) {
            for (const SyntheticScene* scene : {&empty, &one, &point, &rootOnly}) {
                expectLikeCpu(*scene, particles, with(rules, 16), {.flat = flat});
            }
        }
    }
}

TEST_F(ManyViewPassTest, TakesCrowdedAndDeadViews) {
    const SyntheticScene room = testing::makeRoom(5);
    std::vector<View> point, leaf, dead;
    for (uint i = 0; i < 70; ++i) {
        const float t = static_cast<float>(i) * 1e-4f;
        point.push_back(testing::makeView(vec3(0.4f, 0.3f, 0.5f), vec3(0, 1, 0), i));
        leaf.push_back(testing::makeView(vec3(0.4f + t, 0.3f, 0.5f), vec3(0, 0, 1), i, i % 3 == 0));
        dead.push_back(leaf.back());
        if (i % 4) dead.back().flags = kViewDead;
    }
    for (const uint rules : kBothRules) {
        for (const bool flat : {false, true}) {
            for (const auto* views : {&point, &leaf, &dead}) {
                expectLikeCpu(room, *views, with(rules, 16), {.flat = flat});
            }
            // Shallow trees: view leaves above scene leaves, and the other way round.
            expectLikeCpu(room, testing::viewsOnSurfaces(room, 80, 7), with(rules, 16),
                          {.flat = flat}, 2);
            expectLikeCpu(room, testing::viewsOnSurfaces(room, 80, 7), with(rules, 16),
                          {.flat = flat}, 10);
        }
    }
}

TEST_F(ManyViewPassTest, ParticlesAmongFibres) {
    const SyntheticScene fibres = testing::makeFibres(7, 60, 1);
    for (const uint rules : kBothRules) {
        expectLikeCpu(fibres, testing::particlesInside(100, 8), with(rules, 16), {});
    }
}

// The depths of maps of 32 bits, rounded: at once, in passes, and slice by slice.
TEST_F(ManyViewPassTest, PacksDepthsTo16Bits) {
    const SyntheticScene room = testing::makeRoom(5);
    const auto views = testing::viewsOnSurfaces(room, 100, 10);
    for (const bool flat : {false, true}) {
        const ViewHierarchy tree = ViewHierarchy::build(views, {6, kCorrectedRules, flat});
        const std::uint32_t count = tree.leafCount;
        const GpuSceneHierarchy scene = uploadScene(room, kCorrectedRules);
        const GpuViewHierarchy gpuViews = upload(tree);
        for (const Traversal traversal : {Traversal::queue, Traversal::lists}) {
            for (const int res : {8, 16, 64}) {
                ManyViewOptions o = with(kCorrectedRules, res);
                o.pairs.traversal = traversal;
                SCOPED_TRACE(describe(o) + (flat ? " flat" : " tree"));
                startAfresh();
                maps_ = {};
                const MethodStatistics wide = render(room, tree, o);
                std::vector<std::uint32_t> want = maps_.readTexels(0, count);
                const std::uint64_t bytes = maps_.texels.bytes();
                for (std::uint32_t& bits : want) bits = unpackTexel(packTexel(bits), 0);
                o.maps.depthBits = 16;
                for (const bool isShort : {false, true}) {
                    for (const std::uint32_t atOnce : {0u, 7u}) {
                        SCOPED_TRACE(std::to_string(isShort) + " " + std::to_string(atOnce));
                        o.gpuMemoryBytes = isShort ? bytes * 9 / 20 : 1u << 30;
                        o.mapsAtOnce = atOnce;
                        startAfresh();
                        maps_ = {};
                        MethodStatistics got;
                        pass_->render(scene, gpuViews, o, *profiler_, maps_, got);
                        EXPECT_EQ(maps_.readTexels(0, count), want);
                        expectSameCounts(got.pairs, wide.pairs);
                        EXPECT_EQ(got.predictedMapBytes, maps_.texels.bytes());
                        EXPECT_NEAR(double(got.predictedWorkingMapBytes),
                                    double(got.workingMapBytes),
                                    32);  // a buffer has 16 bytes at least
                        EXPECT_LE(got.mapBytes, o.gpuMemoryBytes + 32);
                        EXPECT_TRUE(isShort || 2 * maps_.texels.bytes() == bytes);
                        EXPECT_TRUE(!isShort || maps_.slices.size() > 1);
                    }
                }
            }
        }
    }
    ManyViewOptions o = with(kPublishedRules, 32);  // filled by coarser levels
    o.maps.depthBits = 16;
    EXPECT_THROW(render(room, ViewHierarchy::build(views, {.levels = 6}), o), Error);
    o = with(kCorrectedRules, 16);
    o.maps.depthBits = 16;
    o.pairs.fusion = false;
    EXPECT_THROW(render(room, ViewHierarchy::build(views, {.levels = 6}), o), Error);
}

TEST_F(ManyViewPassTest, RepeatsItselfAndReusesBuffers) {
    const SyntheticScene room = testing::makeRoom(6);
    const auto many = testing::viewsOnSurfaces(room, 200, 14);
    const ViewHierarchy large = ViewHierarchy::build(many, {.levels = 6});
    const ViewHierarchy small =
        ViewHierarchy::build({many.begin(), many.begin() + 20}, {.levels = 6});
    for (const Traversal traversal : {Traversal::queue, Traversal::lists}) {
        ManyViewOptions o = with(kCorrectedRules, 16);
        o.pairs.traversal = traversal;
        render(room, large, o);
        const auto first = texels(16);
        render(room, small, o);
        render(room, large, o);
        expectSameTexels(texels(16), first);
        o.countPairs = false;
        EXPECT_EQ(render(room, large, o).pairs.processed, 0u);
        expectSameTexels(texels(16), first);
    }
}

}  // namespace
}  // namespace mv