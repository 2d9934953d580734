// Depth maps along parallel views of the sky: the GPU's are the CPU's bit for bit, both are what
// rays find, and what a map's texel says of a receiver holds.

#include "renderer/passes/sky_maps.h"

#include "baselines/baseline_scenes.h"
#include "megaviews/core/error.h"
#include "megaviews/methods/vir/point_maps.h"
#include "megaviews/views/sky_views.h"
#include "shaders/shared/bvh.glsl"

namespace mv {
namespace {

using testing::Soup;

std::shared_ptr<const Sky> skyOf(const Scene& scene, const std::string& source) {
    Environment environment;
    environment.settings.source = source;
    return makeSky(scene, {}, environment, 1);
}

TEST(SkyViews, GiveTheLightOfTheWholeSky) {
    const Soup one({{0.4f, 0.4f, 0.6f}, {0.6f, 0.4f, 0.6f}, {0.5f, 0.6f, 0.6f}});
    const auto white = skyOf(one.scene, "white");
    const auto gradient = skyOf(one.scene, "sky");
    testing::Random random(3);
    for (const int count : {64, 128, 512}) {
        ASSERT_EQ(makeSkyViews(*white, count).size(), static_cast<std::size_t>(count));
        const float slack = 1.5f / static_cast<float>(count);
        for (int i = 0; i < 20; ++i) {
            const vec3 normal = random.direction();
            vec3 sum(0);
            for (const SkyView& v : makeSkyViews(*white, count)) {
                sum += vec3(v.r, v.g, v.b) * std::max(dot3(normal, vec3(v.x, v.y, v.z)), 0.0f);
            }
            EXPECT_NEAR(sum.y, kPi, kPi * slack) << count << " of radiance 1";
        }
        vec3 all(0);
        for (const SkyView& v : makeSkyViews(*gradient, count)) all += vec3(v.r, v.g, v.b);
        EXPECT_NEAR(all.y, gradient->irradiance.y, 0.02f * gradient->irradiance.y) << count;
    }
}

TEST(ParallelView, NoPlaneHidesItselfAndWhatStandsBeforeItDoes) {
    testing::Random random(8);
    const uint res = 64;
    const float radius = 0.8f, texel = parallelTexel(radius, res);
    for (int i = 0; i < 500; ++i) {
        const ParallelView v = parallelView(random.direction());
        const vec3 normal = random.direction(), position = random.point() * 0.5f;
        const float facing = dot3(normal, v.toLight);
        if (facing < kParallelGrazing) continue;
        const vec3 place = parallelPlace(v, position, radius, res);
        const vec2 slope = parallelSlope(v, normal, facing, texel);
        // Another place of the same plane has the depth that the slope says.
        const vec3 beside = position + cross3(normal, random.direction()) * 0.1f;
        const vec3 there = parallelPlace(v, beside, radius, res);
        const float depth = place.z + slope.x * (there.x - place.x) + slope.y * (there.y - place.y);
        EXPECT_NEAR(there.z, depth, 2e-5f) << facing;
        EXPECT_EQ(parallelVerdict(floatBitsToUint(there.z), depth, texel), kVerdictLit);
        EXPECT_EQ(parallelVerdict(floatBitsToUint(there.z - 2 * texel), depth, texel),
                  kVerdictBlocked);
        EXPECT_EQ(parallelVerdict(floatBitsToUint(there.z - texel), depth, texel),
                  kVerdictUndecided);
        EXPECT_EQ(parallelVerdict(floatBitsToUint(there.z + 2 * texel), depth, texel), kVerdictLit);
    }
    EXPECT_EQ(parallelVerdict(kNone, 1, texel), kVerdictLit);
}

class SkyMapsTest : public GlTest {
  protected:
    std::vector<uint> onGpu(const TriangleBvh& bvh, const Sky& sky, int views, int res,
                            std::uint64_t budget = 256 << 20) {
        BvhTables tables;
        tables.setScene(*bvh.scene, bvh);
        gl::Profiler profiler;
        SkyMaps maps;
        maps.make(tables, bvh, sky, views, res, budget, profiler);
        expectNoGlErrors();
        points = maps.points();
        const auto side = static_cast<std::uint64_t>(res);
        return maps.texels().read(0, maps.viewCount() * side * side);
    }
    std::uint64_t points = 0;
};

std::vector<vec3> directionsOf(const Sky& sky, int views) {
    std::vector<vec3> out;
    for (const SkyView& v : makeSkyViews(sky, views)) out.emplace_back(v.x, v.y, v.z);
    return out;
}

TEST_F(SkyMapsTest, AreThoseOfTheCpu) {
    const testing::Lit lit(testing::furnishedRoom(1, testing::everything));
    testing::Random random(7);
    const Soup soup(testing::randomSoup(random, 3000, 0.02f));
    const Soup none({});
    for (const TriangleBvh* bvh : {&lit.bvh, &soup.bvh, &none.bvh}) {
        const auto sky = skyOf(*bvh->scene, "sky");
        for (const auto& [views, res] : {std::pair{1, 64}, {8, 16}, {16, 32}, {32, 8}}) {
            const std::vector<uint> got = onGpu(*bvh, *sky, views, res);
            const std::vector<uint> want =
                parallelMaps(*bvh, directionsOf(*sky, views), bvh->center,
                             std::max(bvh->radius, 1e-6f) * 1.001f, res);
            ASSERT_EQ(got.size(), want.size());
            std::size_t different = 0;
            for (std::size_t i = 0; i < got.size(); ++i) different += got[i] != want[i];
            EXPECT_EQ(different, 0u) << views << " views of " << res << "^2";
            EXPECT_LE(points, parallelMostPoints(*bvh, bvh->radius * 1.001f, res));
        }
    }
}

TEST_F(SkyMapsTest, HoldNearlyAllThatRaysFind) {
    const testing::Lit lit(testing::furnishedRoom(1, testing::everything));
    const auto sky = skyOf(lit.scene, "white");
    const int res = 64;
    const float radius = lit.bvh.radius * 1.001f;
    const std::vector<vec3> directions = directionsOf(*sky, 32);
    const std::vector<uint> maps = onGpu(lit.bvh, *sky, 32, res);
    const float texel = parallelTexel(radius, res);
    const BvhData bvh = lit.bvh.data();
    std::size_t hits = 0, holes = 0, off = 0, leaves = 0;
    for (std::size_t i = 0; i < maps.size(); ++i) {
        const ParallelView v = parallelView(directions[i / (res * res)]);
        const auto column = static_cast<float>(i % res), row = static_cast<float>(i / res % res);
        const vec3 from = lit.bvh.center + v.right * ((column + 0.5f) * texel - radius) +
                          v.up * ((row + 0.5f) * texel - radius) + v.toLight * radius;
        float t = 0, u = 0, w = 0;
        const uint slot = bvhIntersect(bvh, from, -v.toLight, 0, 4 * radius, false, t, u, w);
        if (slot == kNone) {
            leaves += maps[i] != kNone;
            continue;
        }
        ++hits;
        if (maps[i] == kNone) {
            ++holes;
        } else {
            off += std::abs(uintBitsToFloat(maps[i]) - t) > 0.02f * texel;
        }
    }
    std::printf("of %zu texels %zu are holes, %zu off, %zu beyond edges\n", hits, holes, off,
                leaves);
    EXPECT_GT(hits, maps.size() / 4);
    EXPECT_LT(static_cast<double>(holes), 0.01 * static_cast<double>(hits));
    EXPECT_LT(static_cast<double>(off), 0.03 * static_cast<double>(hits));
    EXPECT_LT(static_cast<double>(leaves), 0.01 * static_cast<double>(hits));
}

TEST_F(SkyMapsTest, AreRefusedWhereTheyDoNotFit) {
    const Soup one({{0.4f, 0.4f, 0.6f}, {0.6f, 0.4f, 0.6f}, {0.5f, 0.6f, 0.6f}});
    const auto sky = skyOf(one.scene, "white");
    EXPECT_EQ(onGpu(one.bvh, *sky, 16, 64, 256 << 10).size(), 16u * 64 * 64);
    try {
        onGpu(one.bvh, *sky, 32, 64, 256 << 10);
        FAIL() << "not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.code, ExitCode::impossible);
        EXPECT_NE(std::string(error.what()).find("lower --sky-views"), std::string::npos);
    }
}

}  // namespace
}  // namespace mv
