// The shadow test: boundaries of both biases, empty texels, slanted receivers on their own wall.

#include <gtest/gtest.h>

#include "gather/random_views.h"
#include "megaviews/gather/gather.h"
#include "shaders/shared/paraboloid.glsl"
#include "shaders/shared/random.glsl"
#include "shaders/shared/sampling.glsl"
#include "shaders/shared/shadow_test.glsl"

namespace mv {
namespace {

constexpr float kWhole = 1 / kFootprintShare;  // the bias with which a plane never hides itself

TEST(ShadowTest, EmptyTexelIsLit) {
    EXPECT_TRUE(isLit(kNone, {0.5f, 0, 0}, {-1, 0, 0}, 16, true, kWhole));
    EXPECT_TRUE(isLit(kNone, {0.5f, 0, 0}, {-1, 0, 0}, 16, false, 1));
}

TEST(ShadowTest, ReceiverAtTheCentreIsLit) {
    EXPECT_TRUE(isLit(floatBitsToUint(0.0f), {0, 0, 0}, {1, 0, 0}, 16, true, kWhole));
}

TEST(ShadowTest, TexelAngleFollowsTheParaboloid) {
    // Along the axis rho = 0: 4 / R. At the seam rho = 1: 2 / R. In between by the formula.
    EXPECT_FLOAT_EQ(texelAngle({2, 0, 0}, 16), 4.0f / 16);
    EXPECT_FLOAT_EQ(texelAngle({0, 0.3f, 0}, 16), 2.0f / 16);
    const vec3 d = normalize(vec3(-0.3f, 0.5f, 0.2f));
    const float rho = std::sqrt(d.y * d.y + d.z * d.z) / (1 + std::abs(d.x));
    EXPECT_NEAR(texelAngle(d, 32), 4 / (32 * (1 + rho * rho)), 1e-7f);
    // It is what neighbouring texels' directions differ by (to the first order).
    for (const uint texel : {32u * 16 + 16, 32u * 20 + 9, 32u * 32 + 32 * 10 + 13}) {
        const vec3 a = texelDirection(texel, 32), b = texelDirection(texel + 1, 32);
        EXPECT_NEAR(length(a - b), texelAngle((a + b) * 0.5f, 32), 0.01f * length(a - b));
    }
}

TEST(ShadowTest, FootprintBoundary) {
    // Head-on along the axis: lit from d (1 - 1.5 * 4 / R) on.
    const float d = 0.5f, least = d * (1 - 1.5f * 4 / 64);
    const vec3 offset(d, 0, 0), normal(-1, 0, 0);
    EXPECT_TRUE(isLit(floatBitsToUint(least * 1.0001f), offset, normal, 64, true, kWhole));
    EXPECT_FALSE(isLit(floatBitsToUint(least * 0.9999f), offset, normal, 64, true, kWhole));
    // The bias never eats more than 90 % of the distance, at any slant and resolution.
    const vec3 slanted = normalize(vec3(-0.01f, 1, 0));
    EXPECT_FALSE(isLit(floatBitsToUint(d * 0.099f), offset, slanted, 8, true, kWhole));
    EXPECT_TRUE(isLit(floatBitsToUint(d * 0.101f), offset, slanted, 8, true, kWhole));
}

TEST(ShadowTest, FootprintGrowsWithSlant) {
    const vec3 offset(0.5f, 0, 0);
    float before = 0;
    for (const float angle : {0.0f, 0.5f, 1.0f, 1.3f}) {
        const vec3 normal(-std::cos(angle), std::sin(angle), 0);
        const float bias =
            footprintBias(texelAngle(offset, 64), std::min(std::tan(angle), 4.0f), 1);
        EXPECT_GT(bias, before);
        before = bias;
        EXPECT_TRUE(
            isLit(floatBitsToUint(0.5f * (1 - bias) * 1.001f), offset, normal, 64, true, kWhole));
        EXPECT_FALSE(
            isLit(floatBitsToUint(0.5f * (1 - bias) * 0.999f), offset, normal, 64, true, kWhole));
    }
    // At and beyond a right angle the slant counts as 4.
    for (const vec3 normal : {vec3(0, 1, 0), vec3(1, 0, 0)}) {
        const float least = 0.5f * (1 - footprintBias(4.0f / 64, 4, 1));
        EXPECT_TRUE(isLit(floatBitsToUint(least * 1.001f), offset, normal, 64, true, kWhole));
        EXPECT_FALSE(isLit(floatBitsToUint(least * 0.999f), offset, normal, 64, true, kWhole));
    }
}

TEST(ShadowTest, ConstantBoundary) {
    const vec3 offset(0, 0.5f, 0), normal(0, -1, 0);
    EXPECT_TRUE(isLit(floatBitsToUint(0.5f - kConstantBias + 1e-5f), offset, normal, 16, false, 1));
    EXPECT_FALSE(
        isLit(floatBitsToUint(0.5f - kConstantBias - 1e-5f), offset, normal, 16, false, 1));
}

TEST(ShadowTest, BiasScalesBothRules) {
    const vec3 offset(0, 0.5f, 0), normal(0, -1, 0);
    for (const float bias : {0.0f, 0.5f, 2.0f}) {
        const float footprint = 0.5f * (1 - bias * kFootprintShare * 4.0f / 64 * 1.5f * 0.5f);
        const float constant = 0.5f - bias * kConstantBias;
        for (const bool corrected : {true, false}) {
            const float least = corrected ? footprint : constant;
            const auto lit = [&](float depth) {
                return isLit(floatBitsToUint(depth), offset, normal, 64, corrected, bias);
            };
            EXPECT_TRUE(lit(least + 1e-5f)) << bias << " " << corrected;
            EXPECT_FALSE(lit(least - 1e-5f)) << bias << " " << corrected;
        }
    }
}

// A map of one texel centre ray a texel against an infinite wall: what an exact renderer of that
// resolution stores. A receiver on the wall must not shadow itself while the slant is one that the
// bias follows (tan theta <= 4); beyond, hardly ever.
void expectNoSelfShadow(vec3 wallPoint, vec3 wallNormal, uint res, unsigned seed) {
    const vec3 centre(0.5f);
    const float height = dot(wallNormal, centre - wallPoint);
    ASSERT_GT(height, 0);
    test::Rng rng(seed);
    int tested = 0, shadowed = 0, grazing = 0, grazingShadowed = 0;
    for (int i = 0; i < 4000; ++i) {
        const vec3 d = test::direction(rng);
        const float down = -dot(d, wallNormal);
        if (down < 0.02f) continue;
        const vec3 offset = d * (height / down);
        const vec3 ray = texelDirection(texelOfDirection(offset, res), res);
        const float rayDown = -dot(ray, wallNormal);
        const uint texel = rayDown > 1e-3f ? floatBitsToUint(height / rayDown) : kNone;
        const bool lit = isLit(texel, offset, wallNormal, res, true, kWhole);
        const bool followed = down > 0.2426f;
        ++(followed ? tested : grazing);
        if (!lit) ++(followed ? shadowed : grazingShadowed);
    }
    EXPECT_GT(tested, 500);
    EXPECT_EQ(shadowed, 0) << "of " << tested << ", R = " << res << ", height " << height;
    EXPECT_LT(grazingShadowed, grazing / 5) << "R = " << res;
}

TEST(ShadowTest, WallDoesNotShadowItself) {
    unsigned seed = 1;
    for (const uint res : {8u, 16u, 32u, 64u}) {
        for (const vec3 normal :
             {vec3(0, 1, 0), vec3(1, 0, 0), vec3(0, 0, -1), normalize(vec3(1, 2, 3))}) {
            expectNoSelfShadow(vec3(0.5f) - normal * 0.3f, normal, res, seed++);
        }
    }
}

TEST(ShadowTest, WallInBetweenShadows) {
    // Occluders nearer than half the distance hide the receiver at R >= 32, seen head-on.
    test::Rng rng(9);
    for (int i = 0; i < 1000; ++i) {
        const vec3 d = test::direction(rng);
        const float distance = test::uniform(rng, 0.05f, 1);
        const uint texel = floatBitsToUint(distance * test::uniform(rng, 0.01f, 0.5f));
        EXPECT_FALSE(isLit(texel, d * distance, -d, 32, true, kWhole))
            << d.x << " " << d.y << " " << d.z;
    }
}

TEST(ShadowTest, GatherReadsTheMapOfTheView) {
    // Two views with a map each; the second one's sees a wall half way to the receiver.
    std::vector<View> views = {test::makeView({0.2f, 0.8f, 0.5f}, {0, -1, 0}, {1, 0, 0}),
                               test::makeView({0.8f, 0.8f, 0.5f}, {0, -1, 0}, {0, 1, 0})};
    test::numberSlots(views);
    const ViewHierarchy tree = ViewHierarchy::build(views, {});
    ASSERT_EQ(tree.leafCount, 2u);
    ViewMaps maps;
    maps.mapRes = 32;
    maps.texels.assign(2 * mapTexels(32), kNone);
    for (const View& v : tree.sortedViews) {
        maps.centers.push_back({v.positionX, v.positionY, v.positionZ});
    }
    const Receiver receiver{{0.5f, 0.2f, 0.5f}, {0, 1, 0}};
    const glm::dvec3 open = gatherAll(receiver, tree, &maps, {});
    EXPECT_GT(open.x, 0);
    EXPECT_NEAR(open.x, open.y, 1e-6);
    std::uint32_t green = 0;
    while (tree.sortedViews[green].fluxG == 0) ++green;
    const std::uint32_t map = tree.mapOfNode[tree.leafOfView[green]];
    const vec3 offset = receiver.position - maps.centers[map];
    maps.texels[map * mapTexels(32) + texelOfDirection(offset, 32)] =
        floatBitsToUint(0.5f * length(offset));
    const glm::dvec3 shadowed = gatherAll(receiver, tree, &maps, {});
    EXPECT_EQ(shadowed.x, open.x);
    EXPECT_EQ(shadowed.y, 0);
    EXPECT_EQ(gatherAll(receiver, tree, &maps, {.rules = kPublishedRules}).y, 0);
}

// ---------------------------------------------------------------- what a map knows for certain

// A map that holds a plane along the centres of its texels: whatever point of the plane asks, no
// texel says that something stands before it.
TEST(TexelVerdict, APlaneNeverHidesItself) {
    for (const float tilt : {0.0f, 0.4f, 1.0f}) {
        const vec3 n = normalize(vec3(-1, tilt, 0.3f * tilt));
        const float away = 0.3f;  // of the plane: dot(n, p) = -away
        int decided = 0;
        for (int i = 0; i < 400; ++i) {
            const vec4 r = random4(1, static_cast<uint>(i), 0, 0);
            const vec3 way = normalize(vec3(1, 1.6f * r.x - 0.8f, 1.6f * r.y - 0.8f));
            const float along = dot3(n, way);
            if (along > -0.15f) continue;
            const vec3 offset = way * (-away / along);
            const NearestTexels nearest = nearestTexels(offset, 16);
            for (int k = 0; k < 4; ++k) {
                const vec2 center(nearest.u[k], nearest.v[k]);
                const vec3 ray = centerRay(nearest.face, center);
                const float l = centerRayLength(center);
                const float facing = dot3(n, ray) / l;
                const uint bits = facing < 0 ? floatBitsToUint(-away / facing) : kNone;
                const uint verdict = texelVerdict(bits, ray, l, offset, length3(offset), n,
                                                  texelAngle(offset, 16), 1);
                EXPECT_NE(verdict, kVerdictBlocked);
                decided += verdict == kVerdictLit;
            }
        }
        EXPECT_GT(decided, 400);
    }
}

TEST(TexelVerdict, NearerIsBlockedFartherIsLitAndFlatIsUndecided) {
    const vec3 offset(0.5f, 0, 0), n(-1, 0, 0), ray(1, 0, 0);
    const float angle = texelAngle(offset, 16);
    const auto of = [&](float depth, vec3 plane) {
        return texelVerdict(floatBitsToUint(depth), 2.0f * ray, 2, offset, 0.5f, plane, angle, 1);
    };
    EXPECT_EQ(of(0.2f, n), kVerdictBlocked);
    EXPECT_EQ(of(0.45f, n), kVerdictUndecided);
    EXPECT_EQ(of(0.5f, n), kVerdictLit);
    EXPECT_EQ(of(0.9f, n), kVerdictLit);
    const vec3 flat = normalize(vec3(-0.05f, 1, 0));
    EXPECT_EQ(of(0.2f, flat), kVerdictBlocked);
    EXPECT_EQ(of(0.6f, flat), kVerdictUndecided);
    EXPECT_EQ(of(1.1f, flat), kVerdictLit);
    EXPECT_EQ(texelVerdict(kNone, ray, 1, offset, 0.5f, flat, angle, 1), kVerdictLit);
}

TEST(TexelVerdict, TheFourNearestTexelsSurroundTheDirection) {
    for (int i = 0; i < 1000; ++i) {
        const vec4 r = random4(2, static_cast<uint>(i), 0, 0);
        const vec3 way = sphereDirection(r.x, r.y);
        const NearestTexels nearest = nearestTexels(way, 16);
        const uvec4 texels = nearest.texels;
        const uint own = texelOfDirection(way, 16);
        bool holds = false;
        for (int k = 0; k < 4; ++k) {
            holds |= texels[k] == own;
            EXPECT_LT(texels[k], mapTexels(16));
            EXPECT_EQ(nearest.face, faceOfTexel(texels[k], 16));
            EXPECT_EQ(vec2(nearest.u[k], nearest.v[k]), texelCenter(texels[k], 16));
            EXPECT_LT(length(texelDirection(texels[k], 16) - way), 2.2f * texelAngle(way, 16));
        }
        EXPECT_TRUE(holds);
    }
}

}  // namespace
}  // namespace mv
