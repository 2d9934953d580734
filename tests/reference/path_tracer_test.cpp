// The path tracer against closed forms, against quadrature, and against the mean of many VPLs.

#include "megaviews/references/path_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "megaviews/scene/load_scene.h"
#include "reference/reference_scenes.h"

namespace mv {
namespace {

using glm::dvec3;
using testing::furnishedRoom;
using testing::Lit;
using testing::receiversInside;
using testing::traced;
using testing::whiteRoom;

// Every wall shines with radiance 1: each reflection adds its share of pi.
TEST(PathTracer, AFurnaceHasTheSameLightEverywhere) {
    for (const float albedo : {0.0f, 0.5f, 1.0f}) {
        testing::RoomBuilder room;
        room.box({0, 0, 0}, {4, 3, 5}, room.material(vec3(albedo), vec3(1)), true);
        const Lit lit(room.finish());
        const std::vector<Receiver> receivers = receiversInside(1, 12, 0.25f);
        for (const int bounces : {1, 3}) {
            const IrradianceImage image = traced(lit, receivers, {bounces, 4000, 2});
            double expected = 0, squared = 0;
            for (int k = 0; k <= bounces; ++k) expected += std::numbers::pi * std::pow(albedo, k);
            for (std::size_t i = 0; i < receivers.size(); ++i) {
                const double sigma = std::sqrt(double{image.variance[i].x});
                EXPECT_LT(sigma, 0.02 * expected);
                EXPECT_NEAR(image.mean[i].x, expected, 4 * sigma);
                squared += std::pow((double{image.mean[i].x} - expected) / sigma, 2) / 12;
            }
            EXPECT_LT(squared, 2.5) << albedo << ", " << bounces;
        }
    }
}

// Gloss adds its mean reflectance: Schlick's Fresnel term of a mirror is a sum that is known, and a
// furnace of glossy walls has the light of matt ones that reflect so much.
TEST(PathTracer, GlossIsPartOfWhatBounces) {
    Material varnish;
    varnish.specular = 0.04f;
    varnish.roughness = 0;
    Material metal;
    metal.metallic = 1;
    metal.roughness = 0;
    constexpr double kEdge = 1.0 / 21;  // 2 cos (1 - cos)^5 over all cosines
    for (auto& [material, layer] :
         {std::pair(varnish, 0.04 + 0.96 * kEdge), std::pair(metal, kEdge)}) {
        Material wall = material;
        wall.baseColor = {0.5f, 0.5f, 0.5f, 1};
        wall.emission = {1, 1, 1};
        testing::RoomBuilder room;
        const int index = room.material(wall);
        room.box({0, 0, 0}, {4, 3, 5}, index, true);
        const Lit lit(room.finish());
        EXPECT_NEAR(lit.bvh.materials[static_cast<std::size_t>(index)].layer, layer, 0.004);
        const std::vector<Receiver> receivers = receiversInside(1, 8, 0.25f);
        for (const bool gloss : {false, true}) {
            const IrradianceImage image = traced(lit, receivers, {3, 4000, 2, gloss});
            const double albedo = gloss ? 0.5 + 0.5 * layer : 0.5;
            double expected = 0;
            for (int k = 0; k <= 3; ++k) expected += std::numbers::pi * std::pow(albedo, k);
            for (const glm::vec3& mean : image.mean) EXPECT_NEAR(mean.x / expected, 1, 0.02);
        }
    }
}

// One reflection of a point light in a room, by quadrature over its walls.
TEST(PathTracer, OneReflectionIsAnIntegralOverTheWalls) {
    testing::RoomBuilder builder = whiteRoom(0.6f);
    const dvec3 light(1.1, 2.2, 3.3), size(4, 3, 5);
    builder.light(LightType::point, light, {0, -1, 0}, {7, 7, 7});
    const Lit lit(builder.finish());
    const RootCube& root = lit.scene.root;
    std::vector<Receiver> receivers;
    std::vector<double> expected;
    for (uint i = 0; i < 6; ++i) {
        const vec4 a = random4(3, i, 0, 0);
        const dvec3 x = size * (0.25 + 0.5 * dvec3(a.x, a.y, a.z));
        const dvec3 n(sphereDirection(a.w, a.x));
        receivers.push_back({root.rootFromWorld(x), vec3(n)});
        double sum = 0;
        constexpr int kSteps = 400;
        for (int axis = 0; axis < 3; ++axis) {
            const int s = (axis + 1) % 3, t = (axis + 2) % 3;
            for (int side = 0; side < 2; ++side) {
                dvec3 normal(0), y(0);
                normal[axis] = side ? -1 : 1;
                y[axis] = side ? size[axis] : 0;
                for (int u = 0; u < kSteps; ++u) {
                    for (int v = 0; v < kSteps; ++v) {
                        y[s] = size[s] * (u + 0.5) / kSteps;
                        y[t] = size[t] * (v + 0.5) / kSteps;
                        const dvec3 in = light - y, out = x - y;
                        const double in2 = glm::dot(in, in), out2 = glm::dot(out, out);
                        const double irradiance = 7 * glm::dot(in, normal) / std::pow(in2, 1.5);
                        const double cosX = std::max(0.0, -glm::dot(n, out));
                        sum += irradiance * 0.6 / std::numbers::pi * glm::dot(out, normal) * cosX /
                               (out2 * out2) * size[s] * size[t] / (kSteps * kSteps);
                    }
                }
            }
        }
        expected.push_back(sum);
    }
    const IrradianceImage image = traced(lit, receivers, {1, 20000, 0});
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const double sigma = std::sqrt(double{image.variance[i].x});
        EXPECT_LT(sigma, 0.02 * expected[i]);
        EXPECT_NEAR(image.mean[i].x, expected[i], 3.5 * sigma) << i;
    }
}

// A square lamp seen directly, with nothing else around: the form factor of a parallel square.
TEST(PathTracer, ALampSeenDirectlyLightsByItsFormFactor) {
    for (const bool doubleSided : {false, true}) {
        testing::RoomBuilder builder;
        Material lamp;
        lamp.baseColor = {0, 0, 0, 1};
        lamp.emission = {5, 1, 0};
        lamp.doubleSided = doubleSided;
        builder.quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, builder.material(lamp));  // looks down
        const Lit lit(builder.finish());
        const auto at = [&](dvec3 p, vec3 n) {
            return Receiver{lit.scene.root.rootFromWorld(p), n};
        };
        // Four quarters of 1 x 1 at distance 1.5 under their corner.
        const double x = 1 / 1.5, h = std::sqrt(1 + x * x);
        const double factor = 4 / (2 * std::numbers::pi) * 2 * (x / h * std::atan(x / h));
        const IrradianceImage image = traced(
            lit,
            {at({0, 0.5, 0}, {0, 1, 0}), at({0, 3.5, 0}, {0, -1, 0}), at({0, 0.5, 0}, {0, -1, 0})},
            {1, 20000, 1});
        const double sigma = std::sqrt(double{image.variance[0].x});
        EXPECT_LT(sigma, 0.02 * 5 * std::numbers::pi * factor);
        EXPECT_NEAR(image.mean[0].x, 5 * std::numbers::pi * factor, 3.5 * sigma);
        EXPECT_NEAR(image.mean[0].y * 5, image.mean[0].x, 1e-5 * image.mean[0].x);
        if (doubleSided) {
            EXPECT_NEAR(image.mean[1].x, 5 * std::numbers::pi * factor,
                        3.5 * std::sqrt(double{image.variance[1].x}));
        } else {
            EXPECT_EQ(image.mean[1], vec3(0));
        }
        EXPECT_EQ(image.mean[2], vec3(0));
    }
}

// The same lamp over broad gloss, by quadrature over it.
TEST(PathTracer, BroadGlossWeighsEachDirection) {
    testing::RoomBuilder builder;
    Material lamp;
    lamp.baseColor = {0, 0, 0, 1};
    lamp.emission = {5, 1, 0};
    builder.quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, builder.material(lamp));
    const Lit lit(builder.finish());
    const vec3 at(-2, 0.5, 0), n(0, 1, 0), toEye = glm::normalize(vec3(-0.9f, 0.4f, 0));
    Receiver receiver{lit.scene.root.rootFromWorld(at), n, {}};
    receiver.gloss = broadGloss(vec3(0.04f), 1, 0.75f, 0, 1, vec3(0.06f), n, toEye);
    ASSERT_GT(receiver.gloss.partR, 0.5f);
    const IrradianceImage image = traced(lit, {receiver}, {1, 40000, 1});
    double expected = 0, matt = 0;
    constexpr int kSteps = 100;
    for (int i = 0; i < kSteps; ++i) {
        for (int k = 0; k < kSteps; ++k) {
            const dvec3 on((i + 0.5) * 2 / kSteps - 1, 2, (k + 0.5) * 2 / kSteps - 1);
            const dvec3 way = on - dvec3(at);
            const double r2 = glm::dot(way, way);
            const double e = 5 * way.y * way.y / (r2 * r2) * 4 / (kSteps * kSteps);
            matt += e;
            expected +=
                e * double{broadGlossWeight(receiver.gloss, n, vec3(glm::normalize(way))).x};
        }
    }
    const double sigma = std::sqrt(double{image.variance[0].x});
    EXPECT_LT(sigma, 0.02 * expected);
    EXPECT_NEAR(image.mean[0].x, expected, 3.5 * sigma + 1e-3 * expected);
    EXPECT_GT(expected, 1.2 * matt);
}

// The same lamp, half of it cut out by a mask: half the light, for a receiver below its middle.
TEST(PathTracer, ALampShinesOnlyWhereItsMaskLeavesIt) {
    double full = 0;
    for (const int columns : {64, 32, 0}) {
        testing::RoomBuilder builder;
        Material lamp;
        lamp.baseColor = {1, 1, 1, 1};
        lamp.emission = {5, 1, 0};
        lamp.alphaCutoff = 0.5f;
        std::vector<std::uint8_t> rgba;
        for (int i = 0; i < 64; ++i) {
            rgba.insert(rgba.end(), {0, 0, 0, static_cast<std::uint8_t>(i < columns ? 255 : 0)});
        }
        lamp.baseTexture = builder.texture(64, 1, rgba);
        builder.quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, builder.material(lamp));
        const Lit lit(builder.finish());
        ASSERT_TRUE(lit.bvh.flags & kBvhMasks);
        const vec3 below = lit.scene.root.rootFromWorld({0, 0.5, 0});
        const IrradianceImage image = traced(lit, {{below, {0, 1, 0}}}, {1, 20000, 1});
        if (columns == 64) full = double{image.mean[0].x};
        // A texel of 64 to either side, and noise.
        EXPECT_NEAR(image.mean[0].x, full * columns / 64, columns ? 0.03 * full : 0) << columns;
    }
    EXPECT_GT(full, 1);
}

// One reflection off a floor with bent normals, by quadrature over it. Light that arrives by the
// geometric cosine leaves by the shading one; where that is negative the VPL is in shadow.
TEST(PathTracer, TheLastReflectionFollowsTheShadingNormal) {
    testing::RoomBuilder builder;
    builder.quad({0, 0, 1}, {1, 0, 0}, {0, 0, -1}, builder.material(vec3(0.5f)));  // looks up
    const dvec3 light(0.4, 2, -0.3), shading(std::sin(1.3), std::cos(1.3), 0);
    builder.light(LightType::point, light, {0, -1, 0}, {6, 6, 6});
    Scene scene = builder.finish();
    for (vec3& normal : scene.normals) normal = vec3(shading);
    const Lit lit(std::move(scene));
    const auto at = [&](dvec3 p, dvec3 n) {
        return Receiver{lit.scene.root.rootFromWorld(p), vec3(n)};
    };
    const dvec3 before(1.8, 0.6, 0.4), behind(-0.5, 0.1, 0.5), to(-0.8, -0.6, 0);
    const IrradianceImage image =
        traced(lit, {at(before, to), at(behind, {1, 0, 0})}, {1, 40000, 3});
    EXPECT_EQ(image.mean[1], vec3(0));  // below every shading plane
    double expected = 0;
    constexpr int kSteps = 200;
    for (int u = 0; u < kSteps; ++u) {
        for (int v = 0; v < kSteps; ++v) {
            const dvec3 y((u + 0.5) / kSteps, 0, (v + 0.5) / kSteps);
            const dvec3 in = light - y, out = before - y;
            const double in2 = glm::dot(in, in), out2 = glm::dot(out, out);
            expected += 6 * in.y / std::pow(in2, 1.5) * 0.5 / std::numbers::pi *
                        std::max(0.0, glm::dot(shading, out)) * -glm::dot(to, out) / (out2 * out2) /
                        (kSteps * kSteps);
        }
    }
    const double sigma = std::sqrt(double{image.variance[0].x});
    EXPECT_LT(sigma, 0.02 * expected);
    EXPECT_NEAR(image.mean[0].x, expected, 3.5 * sigma);
}

// A coloured pane between a spot light and the far part of a room, whose light comes through it.
TEST(PathTracer, WhatIsClearTintsLight) {
    const vec3 colour(0.81f, 0.25f, 0.04f);
    Material glass;
    glass.transmission = 1;
    glass.baseColor = vec4(colour, 1);
    vec3 arrives[3];
    for (int kind = 0; kind < 3; ++kind) {
        testing::RoomBuilder room = whiteRoom(0.5f);
        room.light(LightType::spot, {2, 1.5, 1}, {0, 0, 1}, {1, 1, 1}, 0.3, 0.4);
        if (kind > 0) room.quad({0, 0, 2}, {4, 0, 0}, {0, 3, 0}, room.material(glass));
        const Lit lit(room.finish());
        const Receiver receiver{lit.scene.root.rootFromWorld({1, 1, 3}), {0, 0, 1}};
        arrives[kind] = traced(lit, {receiver}, {1, 500, 1, kind < 2}).mean[0];
    }
    for (int i = 0; i < 3; ++i) {
        EXPECT_GT(arrives[0][i], 0) << i;
        EXPECT_NEAR(arrives[1][i], colour[i] * arrives[0][i], 1e-5 * arrives[0][i]) << i;
        EXPECT_NEAR(arrives[2][i], arrives[0][i], 1e-5 * arrives[0][i]) << i;  // lambert
    }
}

TEST(PathTracer, FollowsTheScaleOfLight) {
    const std::vector<Receiver> receivers = receiversInside(4, 5, 0.3f);
    for (const int lighting : {testing::point, testing::panel}) {
        const Lit plain(furnishedRoom(3, lighting)), bright(furnishedRoom(3, lighting), 8);
        const IrradianceImage one = traced(plain, receivers, {2, 200, 0});
        const IrradianceImage eight = traced(bright, receivers, {2, 200, 0});
        double sum = 0;
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            EXPECT_NEAR(eight.mean[i].x, 8 * one.mean[i].x, 1e-5 * eight.mean[i].x);
            sum += double{one.mean[i].x};
        }
        EXPECT_GT(sum, 0) << lighting;
    }
}

// The mean of unclamped VPLs over many seeds, gathered exactly. Receivers stand in free space,
// where the light of single VPLs is bounded and its variance finite.
void compareWithVpls(const Lit& lit, int bounces, const std::vector<Receiver>& receivers,
                     std::uint32_t sets, double sigmas) {
    const IrradianceImage image = traced(lit, receivers, {bounces, 60000, 5});
    const EmbreeScene embree(lit.bvh);
    std::vector<dvec3> sum(receivers.size(), dvec3(0)), squares = sum;
    for (std::uint32_t seed = 0; seed < sets; ++seed) {
        const ViewSet views = lit.trace(6000, bounces, 100 + seed);
        IrradianceImage one;
        exactGather(embree, views.views, receivers, static_cast<int>(receivers.size()), 1,
                    {.clampDistance = 0}, one);
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            sum[i] += dvec3(one.mean[i]);
            squares[i] += dvec3(one.mean[i]) * dvec3(one.mean[i]);
        }
    }
    double squaredZ = 0, sigmaShare = 0;
    int lit3 = 0;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double n = sets, mean = sum[i][c] / n;
            const double variance =
                (squares[i][c] / n - mean * mean) / (n - 1) + double{image.variance[i][c]};
            if (!(mean > 0)) continue;
            const double z = (double{image.mean[i][c]} - mean) / std::sqrt(variance);
            EXPECT_LT(std::abs(z), sigmas) << "receiver " << i << ", channel " << c << ": "
                                           << image.mean[i][c] << " against " << mean;
            squaredZ += z * z;
            sigmaShare += std::sqrt(variance) / mean;
            ++lit3;
        }
    }
    ASSERT_GT(lit3, static_cast<int>(receivers.size()));
    EXPECT_LT(std::sqrt(squaredZ / lit3), 2.2);  // all values share their VPLs
    EXPECT_LT(sigmaShare / lit3, 0.025) << "too noisy to tell anything";
    std::printf("rms %.2f sigma of %.2f %% over %d values\n", std::sqrt(squaredZ / lit3),
                100 * sigmaShare / lit3, lit3);
}

TEST(PathTracer, AgreesWithManyVplsInTheCornellBox) {
    compareWithVpls(Lit(loadScene("builtin:cornell")), 4, receiversInside(11, 16, 0.3f), 100, 3);
}

TEST(PathTracer, AgreesWithManyVplsForEachKindOfLight) {
    for (const int lighting : {testing::point, testing::spot, testing::sun, testing::panel}) {
        SCOPED_TRACE(lighting);
        // Few of the sun's paths come in, so the mean of few sets is no normal variable.
        const std::uint32_t sets = lighting == testing::sun ? 600 : 100;
        compareWithVpls(Lit(furnishedRoom(30, lighting)), 2, receiversInside(12, 8, 0.3f), sets, 4);
    }
}

TEST(PathTracer, AgreesWithManyVplsWhereNormalsAreBent) {
    Scene scene = furnishedRoom(21, testing::everything);
    for (std::size_t i = 0; i < scene.normals.size(); ++i) {
        const vec4 r = random4(23, static_cast<uint>(i), 0, 0);
        scene.normals[i] = glm::normalize(scene.normals[i] + vec3(r.x, r.y, r.z) - 0.5f);
    }
    compareWithVpls(Lit(std::move(scene)), 3, receiversInside(13, 8, 0.3f), 100, 4);
}

TEST(PathTracer, EstimatesItsOwnVariance) {
    const Lit lit(furnishedRoom(2, testing::point | testing::panel));
    const std::vector<Receiver> receivers = receiversInside(14, 12, 0.3f);
    dvec3 squares(0), estimated(0);
    std::vector<dvec3> means(receivers.size(), dvec3(0)), squared = means;
    constexpr int kSeeds = 200;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
        const IrradianceImage image = traced(lit, receivers, {2, 64, seed});
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            means[i] += dvec3(image.mean[i]) / double{kSeeds};
            squared[i] += dvec3(image.mean[i]) * dvec3(image.mean[i]) / double{kSeeds};
            estimated += dvec3(image.variance[i]) / double{kSeeds};
        }
    }
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        squares += (squared[i] - means[i] * means[i]) * (kSeeds / (kSeeds - 1.0));
    }
    EXPECT_NEAR(estimated.x / squares.x, 1, 0.15);
    EXPECT_NEAR(estimated.z / squares.z, 1, 0.15);
    // Of two paths a and b: mean (a + b) / 2, variance of the mean (a - b)^2 / 4; of one: 0.
    const IrradianceImage one = traced(lit, receivers, {2, 1, 0}),
                          two = traced(lit, receivers, {2, 2, 0});
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        EXPECT_EQ(one.variance[i], vec3(0));
        const double half = double{one.mean[i].x} - double{two.mean[i].x};  // (a - b) / 2
        EXPECT_NEAR(two.variance[i].x, half * half, 1e-5 * half * half);
    }
}

TEST(PathTracer, GivesTheSameBytesForAnyThreadsAndWhenResumed) {
    const Lit lit(furnishedRoom(1, testing::everything));
    std::vector<Receiver> receivers = receiversInside(7, 13 * 7, 0.1f);
    receivers[17].normal = vec3(0);
    const IrradianceImage image = testing::expectRepeatable(
        [&](IrradianceImage& out, const Progress& progress) {
            const EmbreeScene embree(lit.bvh);
            pathTrace(embree, lit.emitters, receivers, 13, 7, {3, 8, 1}, out, progress);
        },
        7);
    EXPECT_EQ(image.mean[17], vec3(0));
    EXPECT_EQ(image.variance[17], vec3(0));
    EXPECT_GT(image.variance[18].x, 0);
    // Another seed draws other paths.
    EXPECT_NE(traced(lit, {receivers[0]}, {3, 8, 1}).mean[0],
              traced(lit, {receivers[0]}, {3, 8, 2}).mean[0]);
}

TEST(PathTracer, OfNothing) {
    const Lit empty{testing::RoomBuilder().finish()}, unlit(whiteRoom().finish());
    EXPECT_TRUE(traced(empty, {}, {}).mean.empty());
    EXPECT_EQ(traced(empty, {{vec3(0.5f), vec3(0, 1, 0)}}, {}).mean.at(0), vec3(0));
    EXPECT_EQ(traced(unlit, {{vec3(0.5f), vec3(0, 1, 0)}}, {2, 1, 0}).mean.at(0), vec3(0));
    EXPECT_EQ(traced(unlit, {{vec3(0.5f), vec3(0, 1, 0)}}, {2, 1, 0}).variance.at(0), vec3(0));
}

}  // namespace
}  // namespace mv
