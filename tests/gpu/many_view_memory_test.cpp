// The GPU traversal with little memory: more passes, maps in slices and ranges, small stacks give
// the same maps, and what cannot fit is refused.

#include "gpu/many_view_fixture.h"

namespace mv {
namespace {

using test::describe;
using test::kBothRules;
using test::ManyViewPassTest;
using test::uploadScene;
using test::with;
using testing::SyntheticScene;

TEST_F(ManyViewPassTest, TakesMorePassesWhereListsOrQueuesAreSmall) {
    const SyntheticScene room = testing::makeRoom(6);
    const auto views = testing::viewsOnSurfaces(room, 120, 9);
    for (const uint rules : kBothRules) {
        for (const bool flat : {false, true}) {
            const ViewHierarchy tree = ViewHierarchy::build(views, {6, rules, flat});
            for (const Traversal traversal : {Traversal::queue, Traversal::lists}) {
                if (flat && traversal == Traversal::lists) continue;  // keeps no lists
                ManyViewOptions o = with(rules, 16);
                o.pairs.traversal = traversal;
                startAfresh();
                const MethodStatistics whole = render(room, tree, o);
                const auto wholeTexels = texels(16);
                EXPECT_EQ(whole.passes.made, 1u);
                EXPECT_GT(whole.queuePeakPairs, 0u);
                std::uint64_t last = 1;
                for (const std::uint64_t divisor : {3u, 11u}) {
                    SCOPED_TRACE(describe(o) + " 1/" + std::to_string(divisor));
                    // Bytes an entry of both buffers (and the queue's large splats).
                    o.queueMemoryBytes =
                        whole.queuePeakPairs / divisor * (traversal == Traversal::queue ? 18 : 8);
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
    for (const Traversal traversal : {Traversal::queue, Traversal::lists}) {
        ManyViewOptions o = with(kCorrectedRules, 16);
        o.pairs.traversal = traversal;
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
        for (const Traversal traversal : {Traversal::queue, Traversal::lists}) {
            ManyViewOptions o = with(kCorrectedRules, 16);
            o.pairs.traversal = traversal;
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
    for (const Traversal traversal : {Traversal::queue, Traversal::lists}) {
        ManyViewOptions o = with(kPublishedRules, 16);
        o.pairs.traversal = traversal;
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

}  // namespace
}  // namespace mv
