// View-independent rasterisation: the GPU's maps are the CPU's bit for bit whatever the batches,
// points lie in their triangles and as densely as asked, and few texels that rasterising each view
// fills stay empty.

#include "megaviews/methods/vir/point_maps.h"

#include "baselines/baseline_scenes.h"
#include "megaviews/core/error.h"
#include "renderer/methods/raster/raster_maps_pass.h"
#include "renderer/methods/vir/vir_pass.h"
#include "support/upload_views.h"

namespace mv {
namespace {

using testing::randomPoints;
using testing::Soup;

TEST(VirLattice, CoversTheTriangleNoMoreSparselyThanAsked) {
    testing::Random random(5);
    int lattices = 0;
    for (int i = 0; i < 300; ++i) {
        const vec3 a = random.point(), b = random.point();
        // From equilateral to a sliver.
        const vec3 c =
            a + (b - a) * random.uniform() + random.direction() * random.uniform(0, 0.9f);
        const float spacing = random.uniform(0.02f, 0.05f);
        const VirLattice lattice = virLattice(a, b, c, spacing, static_cast<uint>(i));
        const uint count = lattice.columns * lattice.rows;
        std::vector<vec3> points;
        for (uint k = 0; k < count; ++k) {
            const vec3 w = virWeights(lattice, k);
            ASSERT_GE(std::min({w.x, w.y, w.z}), -1e-6f);
            ASSERT_NEAR(w.x + w.y + w.z, 1, 1e-6);
            points.push_back(virPosition(a, b, c, w));
        }
        // Wherever in the triangle a disc is near, but in the tips of slivers.
        const vec2 extent = virExtent(a, b, c, spacing);
        if (!virIsLattice(a, b, c, spacing) || extent.x > 2 * extent.y) continue;
        ++lattices;
        EXPECT_LE(static_cast<float>(count), 2 * extent.x * extent.y + 4) << i;
        for (int probe = 0; probe < 50; ++probe) {
            float u = random.uniform(), v = random.uniform();
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const vec3 at = a + (b - a) * u + (c - a) * v;
            float nearest = kInfinity;
            for (const vec3& p : points) nearest = std::min(nearest, length3(p - at));
            ASSERT_LE(nearest, kVirLatticeRadius * spacing) << extent.x << " x " << extent.y;
        }
    }
    EXPECT_GT(lattices, 30);
}

TEST(VirLattice, SmallTrianglesHaveAPointAsOftenAsTheirAreaSays) {
    const vec3 a(0.1f, 0.1f, 0.1f), b(0.11f, 0.1f, 0.1f), c(0.1f, 0.11f, 0.1f);  // 5e-5
    for (const float spacing : {0.0101f, 0.02f, 0.1f}) {
        int points = 0;
        for (uint triangle = 0; triangle < 10000; ++triangle) {
            const VirLattice lattice = virLattice(a, b, c, spacing, triangle);
            ASSERT_LE(lattice.columns * lattice.rows, 1u);
            points += static_cast<int>(lattice.columns * lattice.rows);
        }
        EXPECT_NEAR(points, 10000 * 5e-5 / double{spacing * spacing}, 10) << spacing;
    }
    EXPECT_NEAR(virWeights({1, 1, 2}, 0).z, 1.0f / 3, 1e-6) << "in the middle";
    EXPECT_EQ(virLattice(a, a, a, 0.1f, 3).columns, 0u);
    EXPECT_EQ(virLattice(a, b, a + (b - a) * 0.5f, 0.001f, 3).columns, 0u) << "a line";
}

TEST(VirLevels, ServeEveryDistanceOnce) {
    for (const float distance : {0.0f, 0.01f, 0.0625f, 0.09f, 0.125f, 0.5f, 1.7f}) {
        int serving = 0;
        for (uint level = 0; level < kVirLevels; ++level) {
            const vec2 range = virRange(level);
            serving += distance >= range.x && distance < range.y;
            EXPECT_TRUE(virMayServe(range, vec2(0, 2)));
        }
        EXPECT_EQ(serving, 1) << distance;
    }
}

class PointMaps : public GlTest {
  protected:
    std::vector<uint> onGpu(const TriangleBvh& bvh, const ViewHierarchy& views,
                            const VirOptions& options, std::uint32_t batch = TrianglePoints::kBatch,
                            std::uint64_t mostPoints = 0) {
        VirPass pass(batch);
        BvhTables tables;
        tables.setScene(*bvh.scene, bvh);
        const GpuViewHierarchy gpuViews = upload(views);
        GpuViewMaps maps;
        gl::Profiler profiler;
        pass.render({tables, gpuViews, options, mostPoints, 256 << 20}, profiler, maps, statistics);
        expectNoGlErrors();
        EXPECT_EQ(statistics.maps, views.sortedViews.size());
        return maps.texels.read(
            0, std::uint64_t{maps.mapCount} * mapTexels(static_cast<uint>(options.mapRes)));
    }
    void expectTwins(const TriangleBvh& bvh, const std::vector<View>& views,
                     const VirOptions& options) {
        SCOPED_TRACE(::testing::Message() << views.size() << " views, R = " << options.mapRes
                                          << ", density " << options.density);
        const ViewHierarchy hierarchy = testing::flatHierarchy(views);
        const std::vector<uint> got = onGpu(bvh, hierarchy, options);
        const ViewMaps want = pointMaps(bvh, hierarchy.sortedViews, options);
        ASSERT_EQ(got.size(), want.texels.size());
        std::size_t different = 0;
        for (std::size_t i = 0; i < got.size(); ++i) different += got[i] != want.texels[i];
        EXPECT_EQ(different, 0u) << "of " << got.size();
        EXPECT_LE(statistics.points, kVirLevels * virMostPoints(bvh, options));
    }
    // Shares of the texels that rasterising each view fills.
    struct Fill {
        double holes;   // empty here
        double off;     // deeper or nearer by more than 2 %
        double filled;  // all that are filled here, by those filled there
    };
    Fill compare(const TriangleBvh& bvh, const std::vector<View>& at, int res) {
        const ViewHierarchy views = testing::flatHierarchy(at);
        const std::vector<uint> got = onGpu(bvh, views, {res, 2});
        BvhTables tables;
        tables.setScene(*bvh.scene, bvh);
        GpuViewMaps maps;
        gl::Profiler profiler;
        MethodStatistics rastered;
        RasterMapsPass().render(tables, upload(views), res, 256 << 20, profiler, maps, rastered);
        const std::vector<uint> want = maps.texels.read(0, got.size());
        double all = 0, holes = 0, off = 0, filled = 0;
        for (std::size_t i = 0; i < want.size(); ++i) {
            filled += got[i] != kNone;
            if (want[i] == kNone) continue;
            ++all;
            holes += got[i] == kNone;
            const double depth = double{uintBitsToFloat(want[i])};
            off +=
                got[i] != kNone && std::abs(double{uintBitsToFloat(got[i])} - depth) > 0.02 * depth;
        }
        std::printf("R = %d: of %.0f texels %.2f %% are holes, %.2f %% off; filled %.3f\n", res,
                    all, 100 * holes / all, 100 * off / all, filled / all);
        return {holes / all, off / all, filled / all};
    }
    MethodStatistics statistics;
};

TEST_F(PointMaps, AreThoseOfTheCpu) {
    const testing::Lit lit(testing::furnishedRoom(1, testing::panel));
    for (const std::size_t count : {0u, 1u, 7u, 9u, 33u}) {
        expectTwins(lit.bvh, testing::viewsAt(randomPoints(3, count)), {8, 1});
    }
    const std::vector<View> vpls = lit.trace(80, 3).views;
    expectTwins(lit.bvh, vpls, {16, 2});
    expectTwins(lit.bvh, vpls, {32, 0.5f});
    testing::Random random(7);
    const Soup soup(testing::randomSoup(random, 3000, 0.02f));
    expectTwins(soup.bvh, vpls, {16, 2});
    const Soup none({});
    expectTwins(none.bvh, vpls, {8, 2});
}

TEST_F(PointMaps, InAnyBatchesAreTheSame) {
    const testing::Lit lit(testing::furnishedRoom(2, testing::panel));
    const ViewHierarchy views = testing::flatHierarchy(lit.trace(40, 3).views);
    const std::vector<uint> once = onGpu(lit.bvh, views, {8, 1});
    const std::uint64_t points = statistics.points;
    EXPECT_GT(points, 5000u);
    EXPECT_EQ(onGpu(lit.bvh, views, {8, 1}, 1237), once);
    EXPECT_EQ(statistics.points, points);
}

TEST_F(PointMaps, HoldNearlyAllThatRasterisingEachViewFinds) {
    const testing::Lit lit(testing::furnishedRoom(1, testing::everything));
    // Hills of triangles that are far below a point where views are far.
    constexpr int kAcross = 120;
    const auto hill = [](int i, int j) {
        const float x = static_cast<float>(i) / kAcross, y = static_cast<float>(j) / kAcross;
        return vec3(x, y, 0.2f + 0.05f * std::sin(9 * x) * std::cos(11 * y));
    };
    std::vector<vec3> corners;
    for (int i = 0; i < kAcross; ++i) {
        for (int j = 0; j < kAcross; ++j) {
            for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 0}, {1, 1}, {0, 1}})
                corners.push_back(hill(i + u, j + v));
        }
    }
    const Soup hills(corners);
    struct Case {
        const TriangleBvh& bvh;
        int res;
        double holes, errors;
    };
    for (const Case& c : {Case{lit.bvh, 16, 0.002, 0.04}, Case{lit.bvh, 64, 0.006, 0.015},
                          Case{hills.bvh, 16, 0.06, 0.05}}) {
        const Fill fill = compare(c.bvh, testing::viewsAt(randomPoints(4, 60)), c.res);
        EXPECT_LE(fill.holes, c.holes);
        EXPECT_LE(fill.off, c.errors);
    }
}

TEST_F(PointMaps, OfScatteredLeavesAreFullerThanRasteredNotEmptier) {
    testing::Random random(11);
    const Soup leaves(testing::randomSoup(random, 20000, 0.02f));  // most have no point at all
    const Fill fill = compare(leaves.bvh, testing::viewsAt(randomPoints(6, 60)), 16);
    // Discs of twice the area: those of a surface overlap, those of leaves do not.
    EXPECT_GT(fill.filled, 1);
    EXPECT_LT(fill.filled, 1.8);
}

TEST_F(PointMaps, AreRefusedWherePointsCannotBeCounted) {
    const Soup one({{0.4f, 0.4f, 0.6f}, {0.6f, 0.4f, 0.6f}, {0.5f, 0.6f, 0.6f}});
    EXPECT_LT(virMostPoints(one.bvh, {256, 16}), 1u << 20);
    try {
        onGpu(one.bvh, testing::flatHierarchy(testing::viewsAt({vec3(0.5f)})), {8, 2}, 1024,
              std::uint64_t{1} << 32);
        FAIL() << "not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.code, ExitCode::impossible);
    }
}

}  // namespace
}  // namespace mv
