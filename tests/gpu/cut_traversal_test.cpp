// Cuts that are kept on the GPU against those of the CPU: the same maps, pairs and statistics frame
// by frame, however views and nodes move, and however little room there was at first.

#include "renderer/methods/manylods/cut_traversal.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "megaviews/core/error.h"
#include "megaviews/methods/manylods/cuts.h"
#include "megaviews/methods/megaviews/traversal.h"
#include "renderer/gl/context.h"
#include "renderer/methods/megaviews/many_view_pass.h"
#include "support/synthetic.h"
#include "support/upload_views.h"

namespace mv {
namespace {

using testing::SyntheticScene;

class CutTraversalTest : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        try {
            context_ = std::make_unique<gl::HeadlessContext>();
        } catch (const Error& e) {
            reason_ = e.what();
        }
    }
    static void TearDownTestSuite() { context_.reset(); }
    void SetUp() override {
        if (!context_) GTEST_SKIP() << reason_;
        profiler_ = std::make_unique<gl::Profiler>();
        begin();
    }
    void TearDown() override {
        pass_.reset();
        profiler_.reset();
    }

    void begin() { pass_ = std::make_unique<ManyViewPass>(); }
    MethodStatistics render(const SyntheticScene& scene, const SceneNodes& nodes,
                            const std::vector<std::uint32_t>& movingBegin,
                            const ViewHierarchy& views, const ManyViewOptions& options) {
        scene_.nodes = {"scene nodes", nodes};
        scene_.levelBegin = scene.levelBegin;
        scene_.movingBegin = movingBegin;
        scene_.nodeCount = static_cast<std::uint32_t>(nodes.size());
        scene_.levels = scene.levels;
        MethodStatistics statistics;
        pass_->render(scene_, upload(views), options, *profiler_, maps_, statistics);
        return statistics;
    }
    void expectMaps(const ViewMaps& want) {
        ASSERT_EQ(maps_.mapCount, want.centers.size());
        EXPECT_EQ(maps_.texels.read(0, want.texels.size()), want.texels);
    }
    static void expectSame(const MethodStatistics& got, const CutUpdate& want) {
        EXPECT_EQ(got.cuts.nodes, want.cuts.nodes);
        EXPECT_EQ(got.cuts.kept, want.cuts.kept);
        EXPECT_EQ(got.cuts.culled, want.cuts.culled);
        EXPECT_EQ(got.cuts.coarse, want.cuts.coarse);
        EXPECT_EQ(got.cuts.split, want.cuts.split);
        EXPECT_EQ(got.cuts.merged, want.cuts.merged);
        EXPECT_EQ(got.cuts.iterations, want.cuts.iterations);
        EXPECT_EQ(got.pairs, want.counts);
    }

    static std::unique_ptr<gl::HeadlessContext> context_;
    static std::string reason_;
    std::unique_ptr<gl::Profiler> profiler_;
    std::unique_ptr<ManyViewPass> pass_;
    GpuSceneHierarchy scene_;
    GpuViewMaps maps_;
};
std::unique_ptr<gl::HeadlessContext> CutTraversalTest::context_;
std::string CutTraversalTest::reason_;

ManyViewOptions keptCuts(uint rules, int mapResolution, std::uint32_t lazyIterations = 0) {
    ManyViewOptions o;
    o.rules = rules;
    o.maps.resolution = mapResolution;
    o.pairs.cut = lazyIterations ? Cut::lazy : Cut::incremental;
    if (lazyIterations) o.pairs.lazyIterations = static_cast<int>(lazyIterations);
    return o;
}
MethodSettings methodWith(uint rules, int mapResolution) {
    return {.rules = rules, .maps = {mapResolution}};
}
ViewHierarchy flat(const std::vector<View>& views) {
    return ViewHierarchy::build(views, {.levels = 1, .flat = true});
}

TEST_F(CutTraversalTest, MapsPairsAndCountsAreTheCpus) {
    const SyntheticScene room = testing::makeRoom(6);
    struct Case {
        uint rules;
        int mapResolution;
        std::uint32_t iterations;  // 0: incremental
    };
    for (const Case& c :
         {Case{kCorrectedRules, 16, 0}, Case{kPublishedRules, 16, 0}, Case{kCorrectedRules, 32, 0},
          Case{kCorrectedRules, 16, 1}, Case{kPublishedRules, 8, 2}}) {
        const auto& nodes = testing::nodesOf(room, c.rules);
        ViewCuts twin(nodes);
        CutOptions cut{methodWith(c.rules, c.mapResolution)};
        if (c.iterations) cut.iterations = c.iterations;
        begin();
        std::mt19937 random(4);
        std::vector<View> views = testing::viewsOfAllKinds(room, 70, 1);
        std::uint64_t merged = 0, coarse = 0;
        // Small steps, large ones, none, and a leap across the room.
        for (const float far : {0.003f, 0.03f, 0.0f, 1.0f, 0.0f, 0.01f}) {
            SCOPED_TRACE("rules " + std::to_string(static_cast<int>(c.rules)) + " R=" +
                         std::to_string(c.mapResolution) + " q=" + std::to_string(c.iterations) +
                         ", then moved by " + std::to_string(far));
            const ViewHierarchy hierarchy = flat(views);
            const CutUpdate want = twin.update(nodes, hierarchy, cut);
            const MethodStatistics got = render(room, nodes, {}, hierarchy,
                                                keptCuts(c.rules, c.mapResolution, c.iterations));
            expectSame(got, want);
            expectMaps(want.leafMaps);
            merged += got.cuts.merged;
            coarse += got.cuts.coarse;
            testing::moveViews(views, far, random);
            // One view goes, one comes, one sees the other half of space.
            std::swap(views.back().flags, views[views.size() / 2].flags);
            if (views[3].flags == kViewDead) views[3] = views[4], views[3].slot = 3;
            views[views.size() % 7].flags = kViewDead;
        }
        EXPECT_GT(merged, 50u);
        EXPECT_EQ(coarse > 0, c.iterations > 0);
    }
}

TEST_F(CutTraversalTest, NodesThatMoveAreTestedAnew) {
    const SyntheticScene room = testing::makeRoom(6);
    const std::vector<std::uint32_t> moving = testing::lastSubtree(room);
    ViewCuts twin(room.nodes, moving);
    std::mt19937 random(6);
    std::vector<View> views = testing::viewsOfAllKinds(room, 50, 1);
    SceneNodes nodes = room.nodes;
    for (int frame = 0; frame < 5; ++frame) {
        const CutUpdate want = twin.update(nodes, flat(views), {});
        expectSame(render(room, nodes, moving, flat(views), keptCuts(kCorrectedRules, 16)), want);
        expectMaps(want.leafMaps);
        testing::moveSubtree(room, moving, random, nodes);
        if (frame % 2) testing::moveViews(views, 0.002f, random);
    }
}

TEST_F(CutTraversalTest, AwkwardScenesAndNoViews) {
    const SyntheticScene point = testing::makeScene({{vec3(0.5f), vec3(0), vec3(0)}}, 5);
    const SyntheticScene one = testing::makeScene({{vec3(0.5f), vec3(0.1f), vec3(0)}}, 1);
    const SyntheticScene empty = testing::makeEmptyScene();
    for (const SyntheticScene* scene : {&point, &one, &empty}) {
        begin();
        ViewCuts twin(scene->nodes);
        std::mt19937 random(1);
        std::vector<View> views = testing::particlesInside(20, 1);
        for (int frame = 0; frame < 3; ++frame) {
            const CutUpdate want = twin.update(scene->nodes, flat(views), {});
            const auto got =
                render(*scene, scene->nodes, {}, flat(views), keptCuts(kCorrectedRules, 16));
            if (!scene->nodes.empty()) expectSame(got, want);
            expectMaps(want.leafMaps);
            testing::moveViews(views, 0.3f, random);
        }
        const auto none = render(*scene, scene->nodes, {}, flat({}), keptCuts(kCorrectedRules, 16));
        EXPECT_EQ(none.cuts, CutCounts{});
    }
}

// More views than there was room for, other rules and sizes, another traversal in between.
TEST_F(CutTraversalTest, GrowsAndForgetsWhereItMust) {
    const SyntheticScene room = testing::makeRoom(8);
    const auto expectBasic = [&](const std::vector<View>& views, const ManyViewOptions& options) {
        const ViewHierarchy hierarchy = flat(views);
        const auto& nodes = testing::nodesOf(room, options.rules);
        const MethodStatistics got = render(room, nodes, {}, hierarchy, options);
        const TraversalResult want = traverse(nodes, hierarchy, options);
        expectMaps(want.leafMaps);
        if (options.pairs.cut != Cut::basic) {
            EXPECT_EQ(got.cuts.nodes, want.counts.processed - want.counts.subdivided);
        }
    };
    const std::vector<View> few = testing::viewsOfAllKinds(room, 4, 2);
    const std::vector<View> many = testing::viewsOfAllKinds(room, 160, 2);
    const ManyViewOptions kept = keptCuts(kCorrectedRules, 16);
    ManyViewOptions large = kept, basic = kept;
    large.pairs.size = 3;
    basic.pairs.cut = Cut::basic;
    expectBasic(few, kept);
    expectBasic(many, kept);
    expectBasic(many, large);
    expectBasic(many, basic);
    expectBasic(many, large);
    expectBasic(many, keptCuts(kPublishedRules, 16));
    expectBasic(few, kept);
}

TEST_F(CutTraversalTest, SaysWhatDoesNotFit) {
    const SyntheticScene room = testing::makeRoom(7);
    ManyViewOptions options = keptCuts(kCorrectedRules, 16);
    options.gpuMemoryBytes = 400'000;
    const ViewHierarchy views = flat(testing::viewsOfAllKinds(room, 100, 1));
    try {
        render(room, room.nodes, {}, views, options);
        FAIL() << "a hundred cuts in 150 KB";
    } catch (const Error& e) {
        EXPECT_EQ(e.code, ExitCode::impossible);
        EXPECT_NE(std::string(e.what()).find("--gpu-memory"), std::string::npos) << e.what();
    }
    // And goes on once there is room.
    options.gpuMemoryBytes = 64 << 20;
    render(room, room.nodes, {}, views, options);
    expectMaps(traverse(room.nodes, views, {}).leafMaps);
}

}  // namespace
}  // namespace mv
