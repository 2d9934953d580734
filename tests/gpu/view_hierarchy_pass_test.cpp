// The GPU's view hierarchy against its CPU twin: same structure everywhere, same bits where the
// device's arithmetic is IEEE.

#include "renderer/passes/view_hierarchy_pass.h"

#include <cstring>

#include "gl/gl_fixture.h"
#include "hierarchy/test_views.h"
#include "renderer/passes/prefix_sum.h"
#include "renderer/passes/radix_sort.h"
#include "shaders/shared/map_borrowing.glsl"
#include "shaders/shared/morton.glsl"
#include "support/upload_views.h"

namespace mv {
namespace {

using test::makeViews;
using test::viewKinds;

GpuViews uploadViews(const std::vector<View>& views) {
    GpuViews out;
    out.views = {"views", views};
    out.count = static_cast<std::uint32_t>(views.size());
    return out;
}

template <typename T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void expectClose(float a, float b, float tolerance, const char* what) {
    ASSERT_LE(std::abs(a - b), tolerance) << what;
}

// Structure equal; boxes and cones equal to the bit in software, to rounding elsewhere.
void expectSame(const ViewHierarchy& cpu, const GpuViewHierarchy& gpu) {
    ASSERT_EQ(gpu.aliveCount, cpu.sortedViews.size());
    ASSERT_EQ(gpu.nodeCount, cpu.nodes.size());
    ASSERT_EQ(gpu.leafCount, cpu.leafCount);
    ASSERT_EQ(gpu.levelBegin, cpu.levelBegin);
    ASSERT_TRUE(sameBytes(gpu.sortedViews.read(0, gpu.aliveCount), cpu.sortedViews));
    ASSERT_EQ(gpu.mortonKeys.read(0, gpu.aliveCount), cpu.mortonKeys);
    ASSERT_EQ(gpu.leafOfView.read(0, gpu.aliveCount), cpu.leafOfView);
    ASSERT_EQ(gpu.mapOfNode.read(0, gpu.nodeCount), cpu.mapOfNode);
    const std::vector<ViewNode> nodes = gpu.nodes.read(0, gpu.nodeCount);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        SCOPED_TRACE(k);
        const ViewNode &a = nodes[k], &b = cpu.nodes[k];
        ASSERT_EQ(a.children, b.children);
        ASSERT_EQ(a.level, b.level);
        ASSERT_EQ(a.firstView, b.firstView);
        ASSERT_EQ(a.viewCount, b.viewCount);
        ASSERT_EQ(a.flags, b.flags);
        expectClose(a.centerX, b.centerX, 0, "centre");
        expectClose(a.centerY, b.centerY, 0, "centre");
        expectClose(a.centerZ, b.centerZ, 0, "centre");
        expectClose(a.halfX, b.halfX, 0, "half");
        expectClose(a.halfY, b.halfY, 0, "half");
        expectClose(a.halfZ, b.halfZ, 0, "half");
        const float tolerance = gl::limits().software ? 0.0f : 1e-5f;
        expectClose(a.axisX, b.axisX, tolerance, "axis");
        expectClose(a.axisY, b.axisY, tolerance, "axis");
        expectClose(a.axisZ, b.axisZ, tolerance, "axis");
        expectClose(a.cosPsi, b.cosPsi, tolerance, "cosPsi");
        expectClose(a.sinPsi, b.sinPsi, tolerance, "sinPsi");
    }
    if (gl::limits().software) {
        ASSERT_TRUE(sameBytes(nodes, cpu.nodes));
    }
}

class ViewHierarchyPassTest : public GlTest {
  protected:
    void expectBuilt(const std::vector<View>& views, const ViewHierarchyOptions& options) {
        if (!pass_) pass_ = std::make_unique<ViewHierarchyPass>();
        if (!profiler_) profiler_ = std::make_unique<gl::Profiler>();
        const GpuViews gpuViews = uploadViews(views);
        pass_->sort(gpuViews, *profiler_);
        pass_->build(options, *profiler_, out_);
        expectSame(ViewHierarchy::build(views, options), out_);
    }
    void TearDown() override {
        expectNoGlErrors();
        pass_.reset();
        profiler_.reset();
        out_ = {};
    }
    std::unique_ptr<ViewHierarchyPass> pass_;
    std::unique_ptr<gl::Profiler> profiler_;
    GpuViewHierarchy out_;  // one for all, as from frame to frame: it grows and shrinks
};

TEST_F(ViewHierarchyPassTest, equalsItsTwinForEveryKindAndSize) {
    const auto group = static_cast<std::size_t>(gl::limits().workGroupSize);
    for (const std::string& kind : viewKinds())
        for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{2}, group - 1,
                                        group, group + 1, std::size_t{31}, std::size_t{32},
                                        std::size_t{33}, std::size_t{1025}, std::size_t{5000}})
            for (const int mode : {0, 1, 2}) {
                SCOPED_TRACE(kind + ", " + std::to_string(count) + " views, mode " +
                             std::to_string(mode));
                expectBuilt(makeViews(kind, count, 9),
                            {.levels = 11,
                             .rules = mode == 1 ? kPublishedRules : kCorrectedRules,
                             .flat = mode == 2});
                if (HasFatalFailure()) return;
            }
}

TEST_F(ViewHierarchyPassTest, equalsItsTwinAtEveryDepth) {
    for (int levels = 1; levels <= 11; ++levels)
        for (const uint rules : {kCorrectedRules, kRuleBoxes, kRuleLoneViews, kPublishedRules}) {
            SCOPED_TRACE(std::to_string(levels) + " levels, rules " + std::to_string(rules));
            expectBuilt(makeViews("walls", 700, 4), {.levels = levels, .rules = rules});
            if (HasFatalFailure()) return;
        }
}

TEST_F(ViewHierarchyPassTest, takesManyViews) {
    for (const char* kind : {"walls", "point"}) {
        SCOPED_TRACE(kind);
        expectBuilt(makeViews(kind, 100001, 2), {.levels = 11});
    }
}

TEST_F(ViewHierarchyPassTest, oneSortServesSeveralTrees) {
    const std::vector<View> views = makeViews("walls", 3000, 8);
    ViewHierarchyPass pass;
    gl::Profiler profiler;
    const GpuViews gpuViews = uploadViews(views);
    pass.sort(gpuViews, profiler);
    const ViewHierarchyOptions tree{.levels = 9}, flat{.levels = 9, .flat = true};
    GpuViewHierarchy a, b, again;
    pass.build(tree, profiler, a);
    pass.build(flat, profiler, b);
    pass.build(tree, profiler, again);
    expectSame(ViewHierarchy::build(views, tree), a);
    expectSame(ViewHierarchy::build(views, flat), b);
    EXPECT_TRUE(sameBytes(a.nodes.read(0, a.nodeCount), again.nodes.read(0, again.nodeCount)));
    EXPECT_TRUE(b.flat);
    EXPECT_GE(a.bytes(), a.nodeCount * sizeof(ViewNode));
}

TEST_F(ViewHierarchyPassTest, uploadedTwinIsTheSame) {
    for (const bool flat : {false, true}) {
        const ViewHierarchy cpu =
            ViewHierarchy::build(makeViews("volume", 300, 1), {.levels = 8, .flat = flat});
        const GpuViewHierarchy gpu = upload(cpu);
        expectSame(cpu, gpu);
        EXPECT_EQ(gpu.flat, flat);
    }
}

// Those that have maps are the middles of runs along the curve, in a tree as of them alone; every
// view takes the map of whom mapDistance() says among the runs around.
TEST_F(ViewHierarchyPassTest, viewsBorrowMapsAsTheirTwinSays) {
    ViewHierarchyPass pass, mapPass;
    gl::Profiler profiler;
    for (const std::string& kind : viewKinds()) {
        for (const std::uint32_t most : {1u, 7u, 64u, 500u}) {
            SCOPED_TRACE(kind + ", " + std::to_string(most) + " maps");
            const std::vector<View> views = makeViews(kind, 1500, 4);
            const GpuViews gpuViews = uploadViews(views);
            GpuMapViews mapViews;
            GpuViewHierarchy all;
            pass.sort(gpuViews, profiler);
            pass.chooseForMaps(most, profiler, mapViews.views);
            mapPass.sort(mapViews.views, profiler);
            pass.build({}, profiler, all);
            mapPass.build({}, profiler, mapViews.tree);
            pass.borrowMaps(all, profiler, mapViews);

            const ViewHierarchy twin = ViewHierarchy::build(views, {});
            const auto alive = static_cast<uint>(twin.sortedViews.size());
            const uint maps = mapsOfViews(alive, most), length = runLength(alive, maps);
            std::vector<View> withMaps;
            for (uint run = 0; run < maps; ++run) {
                withMaps.push_back(twin.sortedViews[viewWithMap(run, length)]);
            }
            expectSame(ViewHierarchy::build(withMaps, {}), mapViews.tree);

            const auto places = mapViews.places.read(0, alive);
            const auto at = [](const View& v) {
                return vec3(v.positionX, v.positionY, v.positionZ);
            };
            const auto facing = [](const View& v) { return vec3(v.normalX, v.normalY, v.normalZ); };
            std::size_t others = 0, worse = 0;
            for (uint v = 0; v < alive; ++v) {
                const View& view = twin.sortedViews[v];
                const uint run = runOfView(v, length, maps);
                const auto far = [&](uint of) {
                    return mapDistance(at(withMaps[of]) - at(view), facing(view),
                                       facing(withMaps[of]));
                };
                uint best = run;
                for (uint of = run - std::min(run, kMapRuns); of < std::min(run + 5, maps); ++of) {
                    if (far(of) < far(best)) best = of;
                }
                ASSERT_LT(places[v], maps);
                worse += far(places[v]) > far(best) * 1.0001f;
                others += places[v] != run;
                if (viewWithMap(run, length) == v) {
                    EXPECT_LE(far(places[v]), 0);
                }
            }
            EXPECT_EQ(worse, 0u);
            if (most == 64 && kind == "planes") {
                EXPECT_GT(others, alive / 10);
            }
        }
    }
}

class RadixSortTest : public GlTest {};

TEST_F(RadixSortTest, isStableAndDropsTheDead) {
    std::mt19937 random(3);
    RadixSort sort;
    for (const std::uint32_t count : {0u, 1u, 31u, 32u, 33u, 1000u, 65537u}) {
        for (const std::uint32_t keyMask : {0u, 7u, 0x3FFFFFFFu}) {
            std::vector<glm::uvec2> pairs;
            for (std::uint32_t i = 0; i < count; ++i)
                pairs.emplace_back(random() % 5 == 0 ? kMortonDead : random() & keyMask, i);
            sort.resize(count);
            sort.pairs().write(0, pairs);
            sort.sort();
            std::erase_if(pairs, [](glm::uvec2 p) { return p.x == kMortonDead; });
            std::stable_sort(pairs.begin(), pairs.end(),
                             [](glm::uvec2 a, glm::uvec2 b) { return a.x < b.x; });
            ASSERT_EQ(sort.alive().read(0, 1)[0], pairs.size());
            ASSERT_TRUE(sort.pairs().read(0, pairs.size()) == pairs)
                << count << " keys under mask " << keyMask;
        }
    }
    expectNoGlErrors();
}

class PrefixSumTest : public GlTest {};

TEST_F(PrefixSumTest, equalsASerialSum) {
    std::mt19937 random(3);
    PrefixSum sum;
    for (const std::uint32_t count : {0u, 1u, 63u, 64u, 65u, 4096u, 4097u, 300000u}) {
        std::vector<std::uint32_t> counts(count), expected(count);
        std::uint32_t running = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            counts[i] = static_cast<std::uint32_t>(random() % 100);
            expected[i] = running;
            running += counts[i];
        }
        gl::TexelBuffer<std::uint32_t> in;
        in.ensure("counts", count + 4);
        in.write(0, counts);
        const gl::Buffer out("sums", count * 4);
        sum.exclusive(in, count, out);
        ASSERT_TRUE(out.read<std::uint32_t>(0, count) == expected) << count;
    }
    expectNoGlErrors();
}

}  // namespace
}  // namespace mv
