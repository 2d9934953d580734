// Rasterised maps against rays through their texels' centres: the same depths up to rounding, at
// awkward sizes, whatever the views stand on or in.

#include "renderer/methods/raster/raster_maps_pass.h"

#include "baselines/baseline_scenes.h"
#include "megaviews/core/error.h"
#include "megaviews/scene/load_scene.h"
#include "support/upload_views.h"

namespace mv {
namespace {

using testing::randomPoints;
using testing::Soup;

class RasterMaps : public GlTest {
  protected:
    std::vector<uint> render(const TriangleBvh& bvh, const ViewHierarchy& views, int res,
                             std::uint64_t budget = 256 << 20) {
        return render(pass_, bvh, views, res, budget);
    }
    std::vector<uint> render(RasterMapsPass& pass, const TriangleBvh& bvh,
                             const ViewHierarchy& views, int res, std::uint64_t budget) {
        BvhTables tables;
        tables.setScene(*bvh.scene, bvh);
        const GpuViewHierarchy gpuViews = upload(views);
        GpuViewMaps maps;
        gl::Profiler profiler;
        MethodStatistics statistics;
        pass.render(tables, gpuViews, res, budget, profiler, maps, statistics);
        expectNoGlErrors();
        EXPECT_EQ(maps.mapCount, views.sortedViews.size());
        EXPECT_EQ(statistics.maps, maps.mapCount);
        EXPECT_EQ(statistics.pairs.processed, 0u);
        EXPECT_TRUE(maps.present && maps.fused);
        return maps.texels.read(0, std::uint64_t{maps.mapCount} * mapTexels(uint(maps.mapRes)));
    }

    // At most `allowed` of the texels differ by more than 1e-4, and those stand at an edge, where a
    // ray a little to the side finds what was rasterised, or where Embree, next to a surface, is
    // further from the truth than we are.
    void expectExact(const TriangleBvh& bvh, const std::vector<View>& views, int res,
                     double allowed = 1e-3) {
        SCOPED_TRACE(::testing::Message() << views.size() << " views, R = " << res);
        const ViewHierarchy hierarchy = testing::flatHierarchy(views);
        const std::vector<uint> got = render(bvh, hierarchy, res);
        const EmbreeScene embree(bvh);
        const std::vector<vec3> centers = testing::positionsOf(hierarchy.sortedViews);
        const ExactMaps exact = exactMaps(embree, centers, res, false);
        ASSERT_EQ(got.size(), exact.depth.size());
        const uint texels = mapTexels(static_cast<uint>(res));
        std::size_t counted = 0, off = 0, elsewhere = 0;
        for (std::size_t i = 0; i < got.size(); ++i) {
            const auto texel = static_cast<uint>(i % texels);
            if (!texelReachable(texel, static_cast<uint>(res))) {
                ASSERT_EQ(got[i], kNone) << "texel " << texel;
                continue;
            }
            ++counted;
            if (same(got[i], exact.depth[i], 1e-4f)) continue;
            ++off;
            const vec3 from = centers[i / texels];
            if (!atAnEdge(embree, from, texel, static_cast<uint>(res), got[i]) &&
                !isTrue(*bvh.scene, from, texelRay(texel, static_cast<uint>(res)), got[i])) {
                if (++elsewhere < 5) {
                    ADD_FAILURE() << "view " << i / texels << " texel " << texel << ": "
                                  << (got[i] == kNone ? -1 : uintBitsToFloat(got[i])) << " for "
                                  << exact.depth[i];
                }
            }
        }
        EXPECT_LE(static_cast<double>(off), allowed * static_cast<double>(counted))
            << off << " of " << counted;
        EXPECT_EQ(elsewhere, 0u);
        off_ += off;
        counted_ += counted;
    }
    static bool same(uint got, float want, float tolerance) {
        if (want < 1e-6f) return true;  // the plane it stands in is there or not
        if (got == kNone || std::isinf(want)) return got == kNone && std::isinf(want);
        return std::abs(uintBitsToFloat(got) - want) <= tolerance * want;
    }
    static bool atAnEdge(const EmbreeScene& embree, vec3 origin, uint texel, uint res, uint got) {
        const vec3 d = texelDirection(texel, res);
        const vec3 side = normalizeOr(cross3(d, vec3(0.3f, 0.5f, 0.8f)), vec3(1, 0, 0));
        const vec3 up = cross3(d, side);
        for (int k = 0; k < 16; ++k) {
            const float angle = 2 * kPi * static_cast<float>(k) / 16;
            const vec3 ray = d + 2e-5f * (std::cos(angle) * side + std::sin(angle) * up);
            const auto hit = embree.intersect(origin, ray, 0, 1e30f);
            if (same(got, hit ? hit->t : std::numeric_limits<float>::infinity(), 1e-3f))
                return true;
        }
        return false;
    }
    RasterMapsPass pass_;
    // In double: the depth is that of a triangle, and none is nearer.
    static bool isTrue(const Scene& scene, vec3 origin, vec3 ray, uint got) {
        if (got == kNone) return false;
        const double length = glm::length(glm::dvec3(ray)), depth = double{uintBitsToFloat(got)};
        bool found = false;
        for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
            const testing::ExactHit hit = testing::exactHit(scene, i, origin, ray);
            if (hit.parallel || hit.inside < -1e-5 || hit.t <= 0) continue;
            if (hit.t * length < depth * (1 - 1e-6) && hit.inside > 1e-5) return false;
            found = found || std::abs(hit.t * length - depth) < 1e-6 * depth;
        }
        return found;
    }
    static inline std::size_t off_ = 0, counted_ = 0;

    static void TearDownTestSuite() {
        std::printf("%zu of %zu texels differ by more than 1e-4\n", off_, counted_);
    }
};

TEST_F(RasterMaps, OfARoomWithMasksAreExact) {
    const testing::Lit lit(testing::furnishedRoom(1, testing::panel));
    for (const std::size_t count : {1u, 7u, 8u, 9u, 63u, 65u, 200u}) {
        expectExact(lit.bvh, testing::viewsAt(randomPoints(3, count)), 8);
    }
    const std::vector<View> vpls = lit.trace(200, 3).views;  // just above surfaces; some dead
    for (const int res : {8, 16, 64}) expectExact(lit.bvh, vpls, res);
    expectExact(lit.bvh, testing::viewsAt(randomPoints(4, 3)), 256);  // in several dispatches
}

TEST_F(RasterMaps, OfManyTrianglesAreExact) {
    testing::Random random(7);
    for (const float size : {0.002f, 0.05f, 1.5f}) {  // below a texel; wider than the views' scene
        const Soup soup(testing::randomSoup(random, 500, size));
        expectExact(soup.bvh, testing::viewsAt(randomPoints(5, 70)), 16);
        expectExact(soup.bvh, testing::viewsAt(randomPoints(6, 9)), 64);
    }
}

TEST_F(RasterMaps, OfTrianglesOfATexelMissNoCorner) {
    testing::Random random(11);
    const Soup soup(testing::randomSoup(random, 4000, 0.06f));
    expectExact(soup.bvh, testing::viewsAt(randomPoints(12, 200)), 8);
}

TEST_F(RasterMaps, AreTheSameInOneDispatchAndInMany) {
    testing::Random random(8);
    const Soup soup(testing::randomSoup(random, 300, 0.2f));
    // So many pairs that an invocation takes several views.
    const ViewHierarchy views = testing::flatHierarchy(testing::viewsAt(randomPoints(9, 700)));
    const std::vector<uint> one = render(soup.bvh, views, 8);
    EXPECT_GT(std::count_if(one.begin(), one.end(), [](uint bits) { return bits != kNone; }), 1000);
    for (const std::uint64_t pairs : {1u, 300u, 20'011u}) {
        RasterMapsPass pass(pairs);
        EXPECT_EQ(render(pass, soup.bvh, views, 8, 256 << 20), one) << pairs << " a dispatch";
    }
}

TEST_F(RasterMaps, OfATiltedFloorAreExactHoweverNearTheViewsStand) {
    // The floor's plane has no component 0, the views are a few ulp of their coordinates above it.
    const vec3 a(0.11f, 0.32f, 0.07f), b(0.93f, 0.41f, 0.17f), c(0.21f, 0.57f, 0.89f);
    const Soup soup({a, b, c});
    const vec3 n = normalizeOr(cross3(b - a, c - a), vec3(0));
    std::vector<vec3> above;
    testing::Random random(1);
    for (const float height : {2e-5f, 2e-5f, -2e-5f, 1e-3f, 1e-2f, 0.3f}) {
        for (int i = 0; i < 8; ++i) {
            const float u = random.uniform(0, 0.5f), v = random.uniform(0, 0.5f);
            above.push_back(a + (b - a) * u + (c - a) * v + n * height);
        }
    }
    expectExact(soup.bvh, testing::viewsAt(above), 16, 0.01);
    expectExact(soup.bvh, testing::viewsAt(above), 64, 0.01);
}

TEST_F(RasterMaps, OfViewsOnCornersEdgesAndSurfaces) {
    const Soup soup({{0.2f, 0.2f, 0.5f},
                     {0.8f, 0.2f, 0.5f},
                     {0.2f, 0.8f, 0.5f},  //
                     {0.8f, 0.8f, 0.5f},
                     {0.2f, 0.8f, 0.5f},
                     {0.8f, 0.2f, 0.5f},  //
                     {0.5f, 0.5f, 0.2f},
                     {0.5f, 0.5f, 0.2f},
                     {0.5f, 0.5f, 0.2f},  // a point
                     {0.1f, 0.1f, 0.1f},
                     {0.9f, 0.9f, 0.9f},
                     {0.5f, 0.5f, 0.5f}});  // a line
    expectExact(soup.bvh,
                testing::viewsAt({{0.2f, 0.2f, 0.5f},      // a corner
                                  {0.5f, 0.5f, 0.5f},      // an edge
                                  {0.375f, 0.375f, 0.5f},  // inside
                                  {0.9f, 0.9f, 0.5f},      // the plane
                                  {0.5f, 0.5f, 0.75f},
                                  {0.5f, 0.5f, 0.75f}}),  // twice the same
                16, 0.01);
}

TEST_F(RasterMaps, LeaveTheSkyOpen) {
    const Soup empty(std::vector<vec3>{});
    for (const uint bits :
         render(empty.bvh, testing::flatHierarchy(testing::viewsAt({vec3(0.5f)})), 8)) {
        ASSERT_EQ(bits, kNone);
    }
    EXPECT_TRUE(render(empty.bvh, testing::flatHierarchy({}), 8).empty());
    const Soup one({{0.4f, 0.4f, 0.6f}, {0.6f, 0.4f, 0.6f}, {0.5f, 0.6f, 0.6f}});
    EXPECT_TRUE(render(one.bvh, testing::flatHierarchy({}), 64).empty());
    expectExact(one.bvh, testing::viewsAt({vec3(0.5f)}), 64, 0.01);
}

TEST_F(RasterMaps, AreRefusedWhereTheyDoNotFit) {
    const Soup one({{0.4f, 0.4f, 0.6f}, {0.6f, 0.4f, 0.6f}, {0.5f, 0.6f, 0.6f}});
    const ViewHierarchy views = testing::flatHierarchy(testing::viewsAt(randomPoints(1, 600)));
    try {
        render(one.bvh, views, 16, 1 << 20);
        FAIL() << "not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.code, ExitCode::impossible);
        EXPECT_STREQ(error.what(),
                     "600 maps of 2 x 16^2 texels need 2 MiB, and --gpu-memory allows 1 MiB: about "
                     "512 views would fit, or --view-res 8");
    }
    EXPECT_EQ(render(one.bvh, views, 8, 1 << 20).size(), 600u * 128);
}

}  // namespace
}  // namespace mv
