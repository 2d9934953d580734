// The binary tree over samples on the GPU: maps, pairs and kept cuts are the CPU's to the bit by
// every traversal and both rules, and pictures of it are those of the octree, nearly.

#include <algorithm>
#include <cmath>

#include "gpu/frame_fixture.h"
#include "megaviews/hierarchy/sample_tree.h"
#include "megaviews/methods/manylods/cuts.h"
#include "megaviews/methods/megaviews/traversal.h"
#include "megaviews/scene/rigged_scene.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/methods/megaviews/many_view_pass.h"
#include "support/binary_scene.h"
#include "support/upload_views.h"

namespace mv {
namespace {

class SampleTreeOnGpu : public test::FrameTest {
  protected:
    MethodStatistics renderMaps(const testing::BinaryScene& scene, const ViewHierarchy& views,
                                const ManyViewOptions& options) {
        GpuSceneHierarchy gpu;
        gpu.nodes = {"scene nodes", scene.nodes(options.rules)};
        gpu.levelBegin = scene.tree().levelBegin;
        gpu.movingBegin = scene.movingBegin();
        gpu.nodeCount = static_cast<std::uint32_t>(scene.tree().nodes.size());
        gpu.levels = scene.tree().levels;
        MethodStatistics statistics;
        pass_->render(gpu, upload(views), options, *profiler_, maps_, statistics);
        return statistics;
    }
    void expectMaps(const ViewMaps& want) {
        ASSERT_EQ(maps_.mapCount, want.centers.size());
        EXPECT_EQ(maps_.texels.read(0, want.texels.size()), want.texels);
    }
    void SetUp() override {
        FrameTest::SetUp();
        if (IsSkipped()) return;
        profiler_ = std::make_unique<gl::Profiler>();
        pass_ = std::make_unique<ManyViewPass>();
    }
    void TearDown() override {
        maps_ = {};
        pass_.reset();
        profiler_.reset();
        FrameTest::TearDown();
    }

    std::unique_ptr<gl::Profiler> profiler_;
    std::unique_ptr<ManyViewPass> pass_;
    GpuViewMaps maps_;
};

TEST_F(SampleTreeOnGpu, GivesTheCpusMapsAndCounts) {
    const testing::BinaryScene cornell("builtin:cornell", 6);
    ASSERT_GT(cornell.tree().levels, static_cast<int>(kTreeLevels));
    const std::vector<View> views = testing::viewsOfAllKinds(cornell.tree(), 90, 3);
    for (const uint rules : {kCorrectedRules, kPublishedRules}) {
        for (const bool isFlat : {false, true}) {
            const ViewHierarchy hierarchy = ViewHierarchy::build(views, {6, rules, isFlat});
            ManyViewOptions options;
            options.rules = rules;
            options.countLevels = true;
            const TraversalResult want = traverse(cornell.nodes(rules), hierarchy, options);
            for (const Traversal traversal : {Traversal::lists, Traversal::queue}) {
                SCOPED_TRACE(nameOfRules(rules) + " " + std::string(nameOf(traversal)) +
                             (isFlat ? " flat" : " tree"));
                options.pairs.traversal = traversal;
                const MethodStatistics got = renderMaps(cornell, hierarchy, options);
                EXPECT_EQ(got.pairs, want.counts);
                EXPECT_EQ(got.pairsPerLevel, want.countsPerLevel);
                expectMaps(want.leafMaps);
            }
        }
    }
}

TEST_F(SampleTreeOnGpu, KeepsTheCpusCuts) {
    testing::BinaryScene door("builtin:door", 6);
    ASSERT_FALSE(door.movingBegin().empty());
    for (const std::uint32_t iterations : {0u, 1u}) {
        ManyViewOptions options;
        options.pairs.cut = iterations ? Cut::lazy : Cut::incremental;
        options.pairs.lazyIterations = static_cast<int>(std::max(iterations, 1u));
        CutOptions onCpu;
        if (iterations) onCpu.iterations = iterations;
        std::mt19937 random(5);
        std::vector<View> views = testing::viewsOfAllKinds(door.tree(), 50, 2);
        ViewCuts twin(door.nodes(kCorrectedRules), door.movingBegin());
        std::uint64_t coarse = 0;
        int frame = 0;
        for (const float far : {0.003f, 0.03f, 0.0f, 0.6f, 0.01f}) {
            SCOPED_TRACE("q=" + std::to_string(iterations) + " frame " + std::to_string(frame));
            door.pose(1 + frame++ / 10.0);
            const ViewHierarchy hierarchy =
                ViewHierarchy::build(views, {.levels = 1, .flat = true});
            const CutUpdate want = twin.update(door.nodes(kCorrectedRules), hierarchy, onCpu);
            const MethodStatistics got = renderMaps(door, hierarchy, options);
            EXPECT_EQ(got.cuts, want.cuts);
            EXPECT_EQ(got.pairs, want.counts);
            expectMaps(want.leafMaps);
            coarse += got.cuts.coarse;
            testing::moveViews(views, far, random);
        }
        EXPECT_EQ(coarse > 0, iterations > 0);
        pass_ = std::make_unique<ManyViewPass>();
    }
}

// Mean, and root of the mean squared difference, over the first's mean.
struct Off {
    double mean, rms;
};
Off compare(const std::vector<float>& a, const std::vector<float>& b) {
    double sumA = 0, sumB = 0, squared = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (i % 4 == 3) continue;
        const double x = a[i], y = b[i];
        sumA += x;
        sumB += y;
        squared += (x - y) * (x - y);
    }
    const double n = 0.75 * static_cast<double>(a.size());
    return {sumB / sumA, std::sqrt(squared / n) / (sumA / n)};
}

// The same views and samples: what differs is visibility alone.
TEST_F(SampleTreeOnGpu, LightOfACornellBoxIsTheOctrees) {
    settings.picture.view = DebugView::indirect;
    settings.side[0].method = Method::shadowRays;
    settings.gather.samples = 0;  // all views
    const SceneHierarchy octree = SceneHierarchy::build(scene(), bvh(), 8);
    const SceneHierarchy binary = buildSampleTree(scene(), bvh(), 8);
    renderer->setScene(scene(), bvh(), octree);
    render();
    const std::vector<float> exact = radiance();
    for (const Method method : {Method::megaviews, Method::manylods}) {
        SCOPED_TRACE(nameOf(method));
        settings.side[0].method = method;
        renderer->setScene(scene(), bvh(), octree);
        render();
        const std::vector<float> ofOctree = radiance();
        renderer->setScene(scene(), bvh(), binary);
        render();
        const std::vector<float> ofBinary = radiance();
        const Off each = compare(ofOctree, ofBinary);
        const Off octreeOff = compare(exact, ofOctree), binaryOff = compare(exact, ofBinary);
        // Measured: 0.8 % and 4.8 %; off exact light 7.4 %, the octree's 6.7 and 7.4 %.
        EXPECT_NEAR(each.mean, 1, 0.02);
        EXPECT_LT(each.rms, 0.07);
        EXPECT_LT(binaryOff.rms, 1.2 * octreeOff.rms);
    }
}

// Frames of a scene that moves, by cuts that are kept and from the root.
TEST_F(SampleTreeOnGpu, KeptCutsHaveThePicturesOfBasicOnes) {
    Scene moving = makeBuiltin("door", {});
    TriangleBvh tree = TriangleBvh::build(moving);
    SceneHierarchy binary = buildSampleTree(moving, tree, 6);
    settings.side[0].method = Method::manylods;
    settings.picture.view = DebugView::indirect;
    input.camera = frameCamera(moving.camerasAt(0, 0).front(), moving.root);
    input.animation = 0;
    input.reuse = false;
    for (const uint rules : {kCorrectedRules, kPublishedRules}) {
        settings.side[0].rules = rules;
        std::vector<std::vector<float>> basic;
        for (const Cut cut : {Cut::basic, Cut::incremental}) {
            settings.side[0].pairs.cut = cut;
            renderer = std::make_unique<FrameRenderer>();
            renderer->setScene(moving, tree, binary);
            for (std::size_t k = 0; k < 3; ++k) {
                input.timeS = static_cast<double>(k) / 30;
                input.pose = [&] {
                    if (!poseScene(moving, input.timeS)) return;
                    tree.refit();
                    binary.refit(moving);
                };
                const FrameStatistics got = render();
                if (cut == Cut::basic) {
                    basic.push_back(radiance());
                } else {
                    EXPECT_EQ(radiance(), basic[k]) << nameOfRules(rules) << " frame " << k;
                    EXPECT_EQ(k > 0, got.methods[0].cuts.kept > 0);
                }
            }
        }
        EXPECT_NE(basic[0], basic[2]);
    }
    renderer.reset();
}

// Methods that march or show the tree take it as well.
TEST_F(SampleTreeOnGpu, OtherMethodsTakeIt) {
    settings.picture.view = DebugView::indirect;
    settings.side[0].method = Method::rays;
    const SceneHierarchy binary = buildSampleTree(scene(), bvh(), 8);
    render();
    const std::vector<float> ofOctree = radiance();
    renderer->setScene(scene(), bvh(), binary);
    render();
    const Off d = compare(ofOctree, radiance());
    EXPECT_NEAR(d.mean, 1, 0.02);
    EXPECT_LT(d.rms, 0.05);
    settings.side[0].method = Method::megaviews;
    settings.picture.view = DebugView::sharing;
    render();
    const std::vector<float> shown = radiance();
    EXPECT_TRUE(std::all_of(shown.begin(), shown.end(), [](float x) { return std::isfinite(x); }));
}

}  // namespace
}  // namespace mv
