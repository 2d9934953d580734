#pragma once
// The GPU traversals beside the CPU's reference: the same maps and counts by both traversals.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "megaviews/core/error.h"
#include "megaviews/methods/megaviews/traversal.h"
#include "renderer/gl/context.h"
#include "renderer/methods/megaviews/many_view_pass.h"
#include "support/synthetic.h"
#include "support/upload_views.h"

namespace mv::test {

using mv::testing::SyntheticScene;

inline GpuSceneHierarchy uploadScene(const SyntheticScene& scene, uint rules) {
    GpuSceneHierarchy out;
    out.nodes = {"scene nodes", mv::testing::nodesOf(scene, rules)};
    out.levelBegin = scene.levelBegin;
    out.nodeCount = static_cast<std::uint32_t>(scene.nodes.size());
    out.levels = scene.levels;
    return out;
}

inline std::string describe(const ManyViewOptions& o) {
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
    std::vector<std::uint32_t> texels(int mapRes) const {
        return maps_.texels.read(
            0, std::uint64_t{maps_.mapCount} * mapTexels(static_cast<uint>(mapRes)));
    }

    // Renders by both traversals and compares with the CPU.
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
            traverse(mv::testing::nodesOf(scene, options.rules), hierarchy, onCpu);
        for (const Traversal traversal : {Traversal::lists, Traversal::queue}) {
            options.pairs.traversal = traversal;
            SCOPED_TRACE(describe(options) + (tree.flat ? " flat " : " tree ") +
                         std::to_string(views.size()) + " views");
            const MethodStatistics got = render(scene, hierarchy, options);
            expectSameCounts(got.pairs, want.counts);
            if (options.countLevels) expectSameLevels(got, want, traversal);
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
                                 Traversal traversal) {
        if (got.pairs.processed == 0) return;
        ASSERT_EQ(got.pairsPerLevel.size(), want.countsPerLevel.size());
        for (std::size_t level = 0; level < got.pairsPerLevel.size(); ++level) {
            SCOPED_TRACE("scene level " + std::to_string(level));
            expectSameCounts(got.pairsPerLevel[level], want.countsPerLevel[level]);
        }
        // A queue holds every pair that is subdivided once.
        std::uint64_t entries = 0;
        for (const std::uint64_t n : got.occupancy) entries += n;
        if (traversal == Traversal::queue) {
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

    static inline std::unique_ptr<gl::HeadlessContext> context_;
    static inline std::string reason_;
    std::unique_ptr<gl::Profiler> profiler_;
    static inline std::unique_ptr<ManyViewPass> programs_;  // kept: shaders compile slowly
    std::unique_ptr<ManyViewPass> fresh_;
    ManyViewPass* pass_ = nullptr;
    GpuViewMaps maps_;
};

inline ManyViewOptions with(uint rules, int mapRes) {
    ManyViewOptions o;
    o.rules = rules;
    o.maps.resolution = mapRes;
    return o;
}
inline constexpr uint kBothRules[] = {kCorrectedRules, kPublishedRules};

}  // namespace mv::test
