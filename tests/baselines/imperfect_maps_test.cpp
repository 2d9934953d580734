// Imperfect shadow maps: the GPU's are the CPU's bit for bit, points lie where surface is, splats
// and pull-push do what they say.

#include "megaviews/methods/ism/imperfect_maps.h"

#include <array>
#include <limits>
#include <utility>

#include "baselines/baseline_scenes.h"
#include "megaviews/core/error.h"
#include "renderer/methods/ism/ism_pass.h"
#include "support/upload_views.h"

namespace mv {
namespace {

using testing::randomPoints;
using testing::Soup;

constexpr float kEmptyDepth = std::numeric_limits<float>::infinity();
float depthOf(uint bits) { return bits == kNone ? kEmptyDepth : uintBitsToFloat(bits); }
uint bitsOf(float depth) { return depth == kEmptyDepth ? kNone : floatBitsToUint(depth); }

TEST(SurfacePoints, AreSpreadEvenlyAndMaskedOutWhereCutOut) {
    // Two quads, of one area unit and of three, and one whose mask leaves half of it.
    testing::RoomBuilder room;
    const int white = room.material(vec3(1));
    Material screen;
    screen.alphaCutoff = 0.5f;
    screen.baseTexture = room.texture(2, 1, {9, 9, 9, 255, 9, 9, 9, 0});
    room.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, white);
    room.quad({0, 0, 1}, {3, 0, 0}, {0, 1, 0}, white);
    room.quad({0, 0, 2}, {1, 0, 0}, {0, 1, 0}, room.material(screen));
    const testing::Lit lit(room.finish());
    const double unit = 1 / lit.scene.root.edge;
    const SurfacePoints points = makeSurfacePoints(lit.bvh, 20000, 3);
    EXPECT_NEAR(points.area, 5 * unit * unit, 1e-6);
    ASSERT_EQ(points.points.size(), 20000u);
    std::array<int, 3> found{};
    double sumX = 0;
    int absent = 0;
    for (const SurfacePoint& p : points.points) {
        if (p.present == 0) {
            ++absent;
            continue;
        }
        const glm::dvec3 world = lit.scene.root.worldFromRoot({p.x, p.y, p.z});
        const auto quad = static_cast<std::size_t>(std::lround(world.z));
        ASSERT_NEAR(world.z, std::round(world.z), 1e-5);
        ASSERT_GE(world.x, -1e-5);
        ASSERT_LE(world.x, (quad == 1 ? 3 : quad == 2 ? 0.5 : 1) + 1e-5);
        ASSERT_GE(world.y, -1e-5);
        ASSERT_LE(world.y, 1 + 1e-5);
        ++found.at(quad);
        if (quad == 1) sumX += world.x;
    }
    for (const auto& [quad, share] : {std::pair{0, 0.2}, {1, 0.6}, {2, 0.1}})
        EXPECT_NEAR(found.at(static_cast<std::size_t>(quad)), share * 20000, quad == 2 ? 150 : 3);
    EXPECT_EQ(absent + found[0] + found[1] + found[2], 20000);
    EXPECT_NEAR(sumX / found[1], 1.5, 0.02);
    EXPECT_TRUE(makeSurfacePoints(Soup({}).bvh, 10, 0).points.empty());
    const Soup line({{0.1f, 0.1f, 0.1f}, {0.9f, 0.9f, 0.9f}, {0.5f, 0.5f, 0.5f}});
    EXPECT_TRUE(makeSurfacePoints(line.bvh, 10, 0).points.empty());
}

TEST(SurfacePoints, OfAStratumAreDrawnByEachViewForItself) {
    std::array<int, 4> drawn{};
    int differ = 0;
    for (uint slot = 0; slot < 1000; ++slot) {
        const uint p = ismPoint(slot, 5, 4, 7);
        ASSERT_GE(p, 20u);
        ASSERT_LT(p, 24u);
        ++drawn.at(p - 20);
        differ += p != ismPoint(slot, 5, 4, 8);
    }
    for (const int n : drawn) EXPECT_NEAR(n, 250, 60);
    EXPECT_NEAR(differ, 750, 60);
}

TEST(IsmTexels, HoldThePointAndGrowWithItsDisc) {
    testing::Random random(4);
    for (int i = 0; i < 20000; ++i) {
        const vec3 offset = random.direction() * random.uniform(0.01f, 1.5f);
        const float l = length3(offset), radius = random.uniform(0, 0.05f);
        const uint res = 8u << random.index(4);
        const uint texel = texelOfDirection(offset, res);
        const bool back = offset.x < 0;
        const uvec4 area = pointTexels(offset.x < 0 ? 1 : 0, offset, l, radius, kIsmReach, res);
        const uint column = texel % res, row = texel / res % res;
        ASSERT_TRUE(column >= area.x && column < area.z && row >= area.y && row < area.w)
            << offset.x << " " << offset.y << " " << offset.z << " R = " << res;
        ASSERT_EQ(back, texel >= res * res);
        const uint widest = area.z - area.x;
        const float disc =
            static_cast<float>(res) *
            std::min(radius / (l + std::abs(offset.x)), 2 * kIsmReach / static_cast<float>(res));
        ASSERT_LE(static_cast<float>(widest), disc + 1.01f);
    }
    // A point at no size covers one texel of its own face and none of the other.
    EXPECT_EQ(pointTexels(0, vec3(0.5f, 0.1f, 0.1f), 0.52f, 0, kIsmReach, 16).z, 9u);
    EXPECT_EQ(pointTexels(0, vec3(-0.5f, 0.1f, 0.1f), 0.52f, 0, kIsmReach, 16), uvec4(0));
}

TEST(IsmPull, MeansTheNearestSurface) {
    const auto pull = [](float a, float b, float c, float d, uint level) {
        return depthOf(ismPull(uvec4(bitsOf(a), bitsOf(b), bitsOf(c), bitsOf(d)), level));
    };
    EXPECT_EQ(pull(kEmptyDepth, kEmptyDepth, kEmptyDepth, kEmptyDepth, 1), kEmptyDepth);
    EXPECT_EQ(pull(kEmptyDepth, 0.5f, kEmptyDepth, kEmptyDepth, 1), 0.5f);
    EXPECT_FLOAT_EQ(pull(0.50f, 0.52f, kEmptyDepth, 0.9f, 1), 0.51f);
    EXPECT_FLOAT_EQ(pull(0.50f, 0.56f, 0.9f, kEmptyDepth, 1), 0.50f);
    EXPECT_FLOAT_EQ(pull(0.50f, 0.56f, 0.9f, kEmptyDepth, 2), 0.53f);  // coarser: thicker
}

TEST(IsmPush, FillsHolesFromOneSurface) {
    const auto push = [](float finer, float own, float b, float c, float d) {
        return depthOf(
            ismPush(bitsOf(finer), uvec4(bitsOf(own), bitsOf(b), bitsOf(c), bitsOf(d)), 0));
    };
    EXPECT_EQ(push(kEmptyDepth, kEmptyDepth, kEmptyDepth, kEmptyDepth, kEmptyDepth), kEmptyDepth);
    EXPECT_EQ(push(0.3f, 0.31f, 0.3f, 0.3f, 0.3f), 0.3f);
    EXPECT_FLOAT_EQ(push(kEmptyDepth, 0.30f, 0.32f, 0.32f, 0.34f),
                    (9 * 0.30f + 6 * 0.32f + 0.34f) / 16);
    EXPECT_FLOAT_EQ(push(kEmptyDepth, 0.30f, 0.9f, 0.32f, kEmptyDepth),
                    (9 * 0.3f + 3 * 0.32f) / 12);
    EXPECT_FLOAT_EQ(push(kEmptyDepth, kEmptyDepth, 0.9f, 0.32f, 0.34f), (3 * 0.32f + 0.34f) / 4);
    EXPECT_EQ(ismNeighbours(0, 4), uvec2(0, 0));
    EXPECT_EQ(ismNeighbours(1, 4), uvec2(0, 1));
    EXPECT_EQ(ismNeighbours(4, 4), uvec2(2, 1));
    EXPECT_EQ(ismNeighbours(7, 4), uvec2(3, 3));
}

class ImperfectMaps : public GlTest {
  protected:
    static SurfacePoints pointsOf(const TriangleBvh& bvh, std::uint32_t count) {
        return makeSurfacePoints(bvh, count, 1);
    }
    std::vector<uint> onGpu(const SurfacePoints& points, const ViewHierarchy& views,
                            const IsmOptions& options, std::uint64_t budget = 256 << 20) {
        const GpuViewHierarchy gpuViews = upload(views);
        const GpuSurfacePoints gpuPoints = upload(points);
        GpuViewMaps maps;
        gl::Profiler profiler;
        MethodStatistics statistics;
        pass_.render(gpuPoints, gpuViews, options, budget, profiler, maps, statistics);
        expectNoGlErrors();
        EXPECT_EQ(maps.mapCount, views.sortedViews.size());
        EXPECT_EQ(statistics.maps, maps.mapCount);
        return maps.texels.read(
            0, std::uint64_t{maps.mapCount} * mapTexels(static_cast<uint>(options.mapRes)));
    }
    void expectTwins(const SurfacePoints& points, const std::vector<View>& views,
                     const IsmOptions& options) {
        SCOPED_TRACE(::testing::Message() << views.size() << " views, R = " << options.mapRes
                                          << ", " << options.pointsPerView << " points a view"
                                          << (options.fill ? "" : ", open"));
        const ViewHierarchy hierarchy = testing::flatHierarchy(views);
        const auto got = onGpu(points, hierarchy, options);
        const ViewMaps want = imperfectMaps(points, hierarchy.sortedViews, options);
        ASSERT_EQ(got.size(), want.texels.size());
        std::size_t different = 0;
        for (std::size_t i = 0; i < got.size(); ++i) different += got[i] != want.texels[i];
        EXPECT_EQ(different, 0u) << "of " << got.size();
    }
    IsmPass pass_;
};

TEST_F(ImperfectMaps, AreThoseOfTheCpu) {
    const testing::Lit lit(testing::furnishedRoom(1, testing::panel));
    const SurfacePoints points = pointsOf(lit.bvh, 5000);
    for (const std::size_t count : {0u, 1u, 7u, 8u, 9u, 65u}) {
        expectTwins(points, testing::viewsAt(randomPoints(3, count)), {8, 100, 0, true});
    }
    const std::vector<View> vpls = lit.trace(80, 3).views;
    for (const int res : {8, 16, 64}) {
        for (const std::uint32_t perView : {1u, 63u, 65u, 2000u}) {
            expectTwins(points, vpls, {res, perView, 5, perView != 65});
        }
    }
    expectTwins(points, vpls, {16, 5000, 0, true});  // all points
    expectTwins({}, vpls, {16, 100, 0, true});
}

// From within a closed room most of what a view lights is found at about its depth.
TEST_F(ImperfectMaps, ApproximateExactMaps) {
    const testing::Lit lit(testing::furnishedRoom(2, testing::panel));
    const EmbreeScene embree(lit.bvh);
    const std::vector<View> views = lit.trace(60, 2).views;
    const ViewHierarchy hierarchy = testing::flatHierarchy(views);
    const SurfacePoints points = pointsOf(lit.bvh, 1 << 16);
    const auto offShare = [&](std::uint32_t perView, bool fill) {
        const ViewMaps maps = imperfectMaps(points, hierarchy.sortedViews, {16, perView, 0, fill});
        const ExactMaps exact = exactMaps(embree, maps.centers, 16, false);
        int counted = 0, off = 0;
        for (std::size_t i = 0; i < maps.texels.size(); ++i) {
            const auto texel = static_cast<uint>(i % mapTexels(16));
            const View& v = hierarchy.sortedViews[i / mapTexels(16)];
            if (!texelReachable(texel, 16)) continue;
            const vec3 d = texelDirection(texel, 16);
            if (dot3(d, vec3(v.normalX, v.normalY, v.normalZ)) < 0.2f) continue;
            ++counted;
            off += !(std::abs(depthOf(maps.texels[i]) - exact.depth[i]) <= 0.1f * exact.depth[i]);
        }
        EXPECT_GT(counted, 5000);
        return static_cast<double>(off) / counted;
    };
    EXPECT_LT(offShare(500, true), offShare(500, false) - 0.03);
    // Few points leave holes that are filled from afar; of many the nearest of a texel stands for
    // all of it.
    const double few = offShare(100, true), more = offShare(1000, true),
                 most = offShare(10000, true);
    EXPECT_LT(more, few - 0.1) << few << " of the texels are off by more than 10 %";
    EXPECT_LT(more, 0.45);
    EXPECT_LT(most, 0.45);
}

TEST_F(ImperfectMaps, AreRefusedWhereTheyDoNotFit) {
    const Soup one({{0.4f, 0.4f, 0.6f}, {0.6f, 0.4f, 0.6f}, {0.5f, 0.6f, 0.6f}});
    const ViewHierarchy views = testing::flatHierarchy(testing::viewsAt(randomPoints(1, 500)));
    const SurfacePoints points = pointsOf(one.bvh, 64);
    try {
        onGpu(points, views, {16, 64, 0, true}, 1 << 20);
        FAIL() << "not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.code, ExitCode::impossible);
        EXPECT_NE(std::string(error.what()).find("views would fit"), std::string::npos)
            << error.what();
    }
    EXPECT_FALSE(onGpu(points, views, {16, 64, 0, false}, 1 << 20).empty());
}

}  // namespace
}  // namespace mv
