// Both organisations of the GPU traversal against the CPU's reference: the same maps and counts,
// at awkward sizes, under both rule sets, however many passes the memory enforces.

#include "renderer/methods/megaviews/many_view_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "megaviews/core/error.h"
#include "megaviews/methods/megaviews/traversal.h"
#include "renderer/gl/context.h"
#include "renderer/passes/view_hierarchy_pass.h"
#include "support/synthetic.h"

namespace mv {
namespace {

using testing::SyntheticScene;

GpuSceneHierarchy uploadScene(const SyntheticScene& scene, uint rules) {
    GpuSceneHierarchy out;
    out.nodes = {"scene nodes", testing::nodesOf(scene, rules)};
    out.levelBegin = scene.levelBegin;
    out.nodeCount = static_cast<std::uint32_t>(scene.nodes.size());
    out.levels = scene.levels;
    return out;
}

std::string describe(const ManyViewOptions& o) {
    return std::string(o.pairs.traversal == Traversal::queue ? "queue" : "lists") +
           (o.rules == kPublishedRules ? " published" : " corrected") +
           " R=" + std::to_string(o.maps.resolution) + (o.pairs.fusion ? "" : " unfused") +
           (o.pairs.holeFill ? "" : " unfilled");
}

class ManyViewPassTest : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        try {
            context_ = std::make_unique<gl::HeadlessContext>();
        } catch (const Error& e) {
            reason_ = e.what();
        }
    }
    static void TearDownTestSuite() {
        programs_.reset();
        context_.reset();
    }
    void SetUp() override {
        if (!context_) GTEST_SKIP() << reason_;
        profiler_ = std::make_unique<gl::Profiler>();
        if (!programs_) programs_ = std::make_unique<ManyViewPass>();
        pass_ = programs_.get();
    }
    void TearDown() override {
        fresh_.reset();
        profiler_.reset();
    }

    // A pass that remembers nothing of the tests before.
    void startAfresh() {
        fresh_ = std::make_unique<ManyViewPass>();
        pass_ = fresh_.get();
    }
    MethodStatistics render(const SyntheticScene& scene, const ViewHierarchy& views,
                            const ManyViewOptions& options) {
        const GpuSceneHierarchy gpuScene = uploadScene(scene, options.rules);
        const GpuViewHierarchy gpuViews = upload(views);
        MethodStatistics statistics;
        pass_->render(gpuScene, gpuViews, options, *profiler_, maps_, statistics);
        return statistics;
    }
    std::vector<std::uint32_t> texels(int viewRes) const {
        return maps_.texels.read(
            0, std::uint64_t{maps_.mapCount} * mapTexels(static_cast<uint>(viewRes)));
    }

    // Renders by both organisations and compares with the CPU.
    void expectLikeCpu(const SyntheticScene& scene, const std::vector<View>& views,
                       ManyViewOptions options, ViewHierarchyOptions tree, int viewLevels = 6) {
        tree.levels = viewLevels;
        tree.rules = options.rules;
        const ViewHierarchy hierarchy = ViewHierarchy::build(views, tree);
        // Coarser levels are pushed into fused maps only.
        const bool fused = options.pairs.fusion || tree.flat;
        MethodSettings onCpu = options;
        onCpu.pairs.holeFill =
            options.pairs.holeFill && (fused || hasRule(options.rules, kRuleSurfaces));
        const TraversalResult want =
            traverse(testing::nodesOf(scene, options.rules), hierarchy, onCpu);
        for (const Traversal organisation : {Traversal::lists, Traversal::queue}) {
            options.pairs.traversal = organisation;
            SCOPED_TRACE(describe(options) + (tree.flat ? " flat " : " tree ") +
                         std::to_string(views.size()) + " views");
            const MethodStatistics got = render(scene, hierarchy, options);
            expectSameCounts(got.pairs, want.counts);
            if (options.countLevels) expectSameLevels(got, want, organisation);
            EXPECT_EQ(maps_.fused, fused);
            expectSameTexels(texels(options.maps.resolution),
                             fused ? want.leafMaps.texels : want.nodeTexels);
        }
    }

    static void expectSameCounts(const PairCounts& got, const PairCounts& want) {
        EXPECT_EQ(got.processed, want.processed);
        EXPECT_EQ(got.culled, want.culled);
        EXPECT_EQ(got.rendered, want.rendered);
        EXPECT_EQ(got.subdivided, want.subdivided);
        EXPECT_EQ(got.skipped, want.skipped);
        EXPECT_EQ(got.forced, want.forced);
        EXPECT_EQ(got.renderedViews, want.renderedViews);
    }
    static void expectSameLevels(const MethodStatistics& got, const TraversalResult& want,
                                 Traversal organisation) {
        if (got.pairs.processed == 0) return;
        ASSERT_EQ(got.pairsPerLevel.size(), want.countsPerLevel.size());
        for (std::size_t level = 0; level < got.pairsPerLevel.size(); ++level) {
            SCOPED_TRACE("scene level " + std::to_string(level));
            expectSameCounts(got.pairsPerLevel[level], want.countsPerLevel[level]);
        }
        // A queue holds every pair that is subdivided once.
        std::uint64_t entries = 0;
        for (const std::uint64_t n : got.occupancy) entries += n;
        if (organisation == Traversal::queue) {
            EXPECT_EQ(entries, want.counts.subdivided);
        }
    }
    // Bit for bit where division and square root are IEEE's; elsewhere a decision may fall the
    // other way within some ulp of its threshold.
    static void expectSameTexels(const std::vector<std::uint32_t>& got,
                                 const std::vector<std::uint32_t>& want) {
        ASSERT_EQ(got.size(), want.size());
        std::size_t different = 0, first = 0;
        for (std::size_t i = 0; i < got.size(); ++i) {
            if (got[i] == want[i]) continue;
            if (different++ == 0) first = i;
        }
        EXPECT_EQ(different, 0u) << "of " << got.size() << "; first at " << first << ": "
                                 << uintBitsToFloat(got[first]) << " for "
                                 << uintBitsToFloat(want[first]);
    }

    static std::unique_ptr<gl::HeadlessContext> context_;
    static std::string reason_;
    std::unique_ptr<gl::Profiler> profiler_;
    static std::unique_ptr<ManyViewPass> programs_;  // kept: shaders compile slowly
    std::unique_ptr<ManyViewPass> fresh_;
    ManyViewPass* pass_ = nullptr;
    GpuViewMaps maps_;
};
std::unique_ptr<gl::HeadlessContext> ManyViewPassTest::context_;
std::string ManyViewPassTest::reason_;
std::unique_ptr<ManyViewPass> ManyViewPassTest::programs_;

ManyViewOptions with(uint rules, int viewRes) {
    ManyViewOptions o;
    o.rules = rules;
    o.maps.resolution = viewRes;
    return o;
}
constexpr uint kBothRules[] = {kCorrectedRules, kPublishedRules};

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
    for (const Traversal organisation : {Traversal::queue, Traversal::lists}) {
        ManyViewOptions o = with(kCorrectedRules, 16);
        o.pairs.traversal = organisation;
        o.countLevels = true;
        startAfresh();
        const MethodStatistics whole = render(room, tree, o);
        EXPECT_EQ(whole.passes.made, 1u);
        EXPECT_EQ(*std::max_element(whole.occupancy.begin(), whole.occupancy.end()),
                  whole.queuePeakPairs);
        o.queueMemoryBytes = whole.queuePeakPairs / 5 * (organisation == Traversal::queue ? 18 : 8);
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
    for (const Traversal organisation : {Traversal::queue, Traversal::lists}) {
        for (const int res : {16, 64}) {
            for (const uint rules : kBothRules) {
                ManyViewOptions o = with(rules, res);
                o.pairs.traversal = organisation;
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

TEST_F(ManyViewPassTest, TakesMorePassesWhereListsOrQueuesAreSmall) {
    const SyntheticScene room = testing::makeRoom(6);
    const auto views = testing::viewsOnSurfaces(room, 120, 9);
    for (const uint rules : kBothRules) {
        for (const bool flat : {false, true}) {
            const ViewHierarchy tree = ViewHierarchy::build(views, {6, rules, flat});
            for (const Traversal organisation : {Traversal::queue, Traversal::lists}) {
                if (flat && organisation == Traversal::lists) continue;  // keeps no lists
                ManyViewOptions o = with(rules, 16);
                o.pairs.traversal = organisation;
                startAfresh();
                const MethodStatistics whole = render(room, tree, o);
                const auto wholeTexels = texels(16);
                EXPECT_EQ(whole.passes.made, 1u);
                EXPECT_GT(whole.queuePeakPairs, 0u);
                std::uint64_t last = 1;
                for (const std::uint64_t divisor : {3u, 11u}) {
                    SCOPED_TRACE(describe(o) + " 1/" + std::to_string(divisor));
                    // Bytes an entry of both buffers (and the queue's large splats).
                    o.queueMemoryBytes = whole.queuePeakPairs / divisor *
                                         (organisation == Traversal::queue ? 18 : 8);
                    startAfresh();
                    const MethodStatistics parts = render(room, tree, o);
                    EXPECT_GT(parts.passes.made, last);
                    EXPECT_LE(parts.queuePeakPairs, whole.queuePeakPairs / divisor);
                    last = parts.passes.made;
                    expectSameCounts(parts.pairs, whole.pairs);
                    expectSameTexels(texels(16), wholeTexels);
                }
                // What views took is remembered.
                const MethodStatistics again = render(room, tree, o);
                EXPECT_LE(again.passes.overflows, last / 4);
                expectSameTexels(texels(16), wholeTexels);
            }
        }
    }
}

TEST_F(ManyViewPassTest, TakesMorePassesWhereWorkingMapsDoNotFit) {
    const SyntheticScene room = testing::makeRoom(5);
    const auto views = testing::viewsOnSurfaces(room, 100, 10);
    const ViewHierarchy tree = ViewHierarchy::build(views, {.levels = 6});
    for (const Traversal organisation : {Traversal::queue, Traversal::lists}) {
        ManyViewOptions o = with(kCorrectedRules, 16);
        o.pairs.traversal = organisation;
        const MethodStatistics whole = render(room, tree, o);
        const auto wholeTexels = texels(16);
        o.gpuMemoryBytes = (tree.leafCount + 16) * 2048ull;
        startAfresh();
        const MethodStatistics parts = render(room, tree, o);
        EXPECT_GT(parts.passes.made, 1u) << describe(o);
        EXPECT_LE(parts.mapBytes, o.gpuMemoryBytes + 2048) << describe(o);
        expectSameCounts(parts.pairs, whole.pairs);
        expectSameTexels(texels(16), wholeTexels);
    }
}

TEST_F(ManyViewPassTest, MapsThatDoNotFitAreMadeSliceBySlice) {
    const SyntheticScene room = testing::makeRoom(5);
    const auto views = testing::viewsOnSurfaces(room, 100, 10);
    for (const bool flat : {false, true}) {
        const ViewHierarchy tree = ViewHierarchy::build(views, {6, kCorrectedRules, flat});
        const std::uint32_t maps = tree.leafCount;
        for (const Traversal organisation : {Traversal::queue, Traversal::lists}) {
            ManyViewOptions o = with(kCorrectedRules, 16);
            o.pairs.traversal = organisation;
            startAfresh();
            const MethodStatistics whole = render(room, tree, o);
            EXPECT_TRUE(maps_.slices.empty());
            const auto want = maps_.readTexels(0, maps);
            for (const std::uint64_t room16 : {60u, 30u}) {  // maps, working ones among them
                SCOPED_TRACE(describe(o) + (flat ? " flat " : " tree ") + std::to_string(room16));
                o.gpuMemoryBytes = room16 * 2048;
                startAfresh();
                // What makeSlice() reads outlives it.
                const GpuSceneHierarchy scene = uploadScene(room, o.rules);
                const GpuViewHierarchy gpuViews = upload(tree);
                MethodStatistics sliced;
                pass_->render(scene, gpuViews, o, *profiler_, maps_, sliced);
                EXPECT_GT(maps_.slices.size(), 1u);
                EXPECT_LE(sliced.mapBytes, o.gpuMemoryBytes + 64);
                expectSameCounts(sliced.pairs, whole.pairs);
                EXPECT_EQ(maps_.readTexels(0, maps), want);
                // In any order, and a part.
                const std::vector<std::uint32_t> part(want.begin() + 7 * 512,
                                                      want.begin() + 50 * 512);
                EXPECT_EQ(maps_.readTexels(7, 43), part);
                maps_ = {};
            }
        }
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
        for (const Traversal organisation : {Traversal::queue, Traversal::lists}) {
            for (const int res : {8, 16, 64}) {
                ManyViewOptions o = with(kCorrectedRules, res);
                o.pairs.traversal = organisation;
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

TEST_F(ManyViewPassTest, SmallStacksGiveTheSame) {
    const SyntheticScene room = testing::makeRoom(6);
    const auto views = testing::viewsOnSurfaces(room, 40, 11);
    for (const uint rules : kBothRules) {
        for (const std::uint32_t entries : {160u, 203u}) {
            ManyViewOptions o = with(rules, 16);
            o.sharedEntries = entries;
            expectLikeCpu(room, views, o, {});
            expectLikeCpu(room, views, o, {.flat = true});
        }
    }
}

// What does not fit one storage block is made range by range: the same maps, the same counts.
TEST_F(ManyViewPassTest, RangesOfMapsGiveTheSame) {
    const SyntheticScene room = testing::makeRoom(6);
    const auto views = testing::viewsOnSurfaces(room, 150, 12);
    for (const uint rules : kBothRules) {
        for (const std::uint32_t maps : {2u, 7u, 100u}) {
            startAfresh();
            ManyViewOptions o = with(rules, 16);
            o.mapsAtOnce = maps;
            expectLikeCpu(room, views, o, {}, 4);  // leaves hold several views
            expectLikeCpu(room, views, o, {.flat = true});
            const ViewHierarchy flat = ViewHierarchy::build(views, {.flat = true});
            EXPECT_EQ(render(room, flat, o).passes.made, (150 + maps - 1) / maps);
        }
    }
}

TEST_F(ManyViewPassTest, SuspendedWorkGroupsGoOnWhereTheyWere) {
    const SyntheticScene room = testing::makeRoom(6);
    const auto views = testing::viewsOnSurfaces(room, 40, 16);
    for (const int res : {16, 64}) {
        for (const std::uint32_t budget : {1u, 1500u, 9000u}) {
            ManyViewOptions o = with(kCorrectedRules, res);
            o.loopBudget = budget;
            expectLikeCpu(room, views, o, {});
            if (budget == 9000) expectLikeCpu(room, views, o, {.flat = true});
        }
    }
    ManyViewOptions o = with(kPublishedRules, 16);
    o.loopBudget = 2500;
    o.sharedEntries = 160;
    expectLikeCpu(room, views, o, {});
}

TEST_F(ManyViewPassTest, RefusesMapsThatCannotFitAndSaysWhatWould) {
    const SyntheticScene room = testing::makeRoom(5);
    const ViewHierarchy tree =
        ViewHierarchy::build(testing::viewsOnSurfaces(room, 100, 12), {.levels = 6});
    ManyViewOptions o = with(kCorrectedRules, 64);
    o.pairs.fusion = false;
    o.gpuMemoryBytes = 1 << 20;  // 32 maps of 64^2, 100 of 32^2 do not fit, 100 of 16^2 do
    try {
        render(room, tree, o);
        FAIL() << "rendered";
    } catch (const Error& e) {
        EXPECT_EQ(e.code, ExitCode::impossible);
        const std::string what = e.what();
        EXPECT_NE(what.find("about 32 views"), std::string::npos) << what;
        EXPECT_NE(what.find("--view-res 16"), std::string::npos) << what;
        EXPECT_NE(what.find("--gpu-memory"), std::string::npos) << what;
    }
    // The pass is usable afterwards.
    o.maps.resolution = 16;
    EXPECT_GT(render(room, tree, o).pairs.processed, 0u);
}

TEST_F(ManyViewPassTest, RefusesAQueueTooSmallForASingleView) {
    const SyntheticScene room = testing::makeRoom(5);
    const ViewHierarchy tree =
        ViewHierarchy::build(testing::viewsOnSurfaces(room, 5, 13), {.levels = 6});
    for (const Traversal organisation : {Traversal::queue, Traversal::lists}) {
        ManyViewOptions o = with(kPublishedRules, 16);
        o.pairs.traversal = organisation;
        o.queueMemoryBytes = 64;
        startAfresh();
        try {
            render(room, tree, o);
            FAIL() << "rendered";
        } catch (const Error& e) {
            EXPECT_EQ(e.code, ExitCode::impossible);
            EXPECT_NE(std::string(e.what()).find("--queue-memory"), std::string::npos) << e.what();
        }
    }
}

TEST_F(ManyViewPassTest, RepeatsItselfAndReusesBuffers) {
    const SyntheticScene room = testing::makeRoom(6);
    const auto many = testing::viewsOnSurfaces(room, 200, 14);
    const ViewHierarchy large = ViewHierarchy::build(many, {.levels = 6});
    const ViewHierarchy small =
        ViewHierarchy::build({many.begin(), many.begin() + 20}, {.levels = 6});
    for (const Traversal organisation : {Traversal::queue, Traversal::lists}) {
        ManyViewOptions o = with(kCorrectedRules, 16);
        o.pairs.traversal = organisation;
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
