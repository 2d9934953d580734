// Distributions of shaders/shared/{random,light,vpl}.glsl against their definitions.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "shaders/shared/vpl.glsl"

namespace mv {
namespace {

// Chi-square of counts against expected shares, as a number of standard deviations above its mean
// (Wilson and Hilferty's cube root approximation).
double chiSquareSigmas(const std::vector<double>& counts, const std::vector<double>& shares) {
    double n = 0, chi = 0;
    for (const double c : counts) n += c;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        chi += std::pow(counts[i] - n * shares[i], 2) / (n * shares[i]);
    }
    const double k = static_cast<double>(counts.size()) - 1, v = 2 / (9 * k);
    return (std::cbrt(chi / k) - (1 - v)) / std::sqrt(v);
}

TEST(Random, IsPcg4dOfThePaper) {
    // Jarzynski and Olano's listing evaluated by hand-written Python with arithmetic mod 2^32.
    EXPECT_EQ(pcg4d({0, 0, 0, 0}), uvec4(0x0f02f829u, 0x2d568769u, 0x32b0c43bu, 0xd32548eau));
    EXPECT_EQ(pcg4d({1, 2, 3, 4}), uvec4(0x3622cd16u, 0xf11471d8u, 0xe1109b3fu, 0x02b94c2fu));
}

TEST(Random, IsUniformInEveryComponentAndPair) {
    constexpr int kBins = 16;
    for (int component = 0; component < 4; ++component) {
        std::vector<double> counts(kBins * kBins, 0.0);
        for (uint path = 0; path < 100000; ++path) {
            const vec4 r = random4(7, path, 1, 0);
            const vec4 next = random4(7, path + 1, 1, 0);
            ASSERT_GE(r[component], 0.0f);
            ASSERT_LT(r[component], 1.0f);
            const int i = static_cast<int>(r[component] * kBins);
            const int j = static_cast<int>(next[(component + 1) % 4] * kBins);
            counts[static_cast<std::size_t>(i * kBins + j)] += 1;
        }
        const std::vector<double> shares(counts.size(), 1.0 / static_cast<double>(counts.size()));
        EXPECT_LT(std::abs(chiSquareSigmas(counts, shares)), 4.0) << "component " << component;
    }
}

TEST(Random, EveryArgumentMatters) {
    const vec4 r = random4(1, 2, 3, 4);
    EXPECT_EQ(r, random4(1, 2, 3, 4));
    EXPECT_NE(r, random4(0, 2, 3, 4));
    EXPECT_NE(r, random4(1, 0, 3, 4));
    EXPECT_NE(r, random4(1, 2, 0, 4));
    EXPECT_NE(r, random4(1, 2, 3, 0));
    EXPECT_LT(unitFloat(0xFFFFFFFFu), 1.0f);
    EXPECT_EQ(unitFloat(0u), 0.0f);
}

TEST(Sampling, CosSinIsAccurate) {
    double worst = 0;
    for (int i = 0; i <= 1 << 16; ++i) {
        const float u = static_cast<float>(i) / 65536.0f;
        const vec2 cs = cosSin2Pi(u);
        const double angle = 2 * std::numbers::pi * static_cast<double>(u);
        worst = std::max({worst, std::abs(static_cast<double>(cs.x) - std::cos(angle)),
                          std::abs(static_cast<double>(cs.y) - std::sin(angle))});
    }
    EXPECT_LT(worst, 5e-7);
}

std::vector<vec3> axes() {
    std::vector<vec3> result = {{0, 0, 1},     {0, 0, -1},     {1, 0, 0},           {0, -1, 0},
                                {1, 0, -0.0f}, {0, 1e-8f, -1}, {1e-4f, -1e-4f, -1}, {1e-20f, 0, 1}};
    for (uint i = 0; i < 200; ++i) {
        const vec4 r = random4(3, i, 0, 0);
        result.push_back(sphereDirection(r.x, r.y));
        result.push_back(glm::normalize(vec3(r.z - 0.5f, r.w - 0.5f, i % 2 ? 1e-5f : -1e-5f)));
    }
    return result;
}

TEST(Sampling, AFrameRoundAnAxisIsOrthonormal) {
    for (const vec3 n : axes()) {
        const vec3 s = aroundAxis(n, 1, 0, 0), t = aroundAxis(n, 0, 1, 0),
                   z = aroundAxis(n, 0, 0, 1);
        SCOPED_TRACE(::testing::Message() << n.x << ' ' << n.y << ' ' << n.z);
        EXPECT_NEAR(glm::length(s), 1, 2e-6);
        EXPECT_NEAR(glm::length(t), 1, 2e-6);
        EXPECT_NEAR(glm::dot(s, t), 0, 2e-6);
        EXPECT_NEAR(glm::dot(s, n), 0, 2e-6);
        EXPECT_NEAR(glm::dot(t, n), 0, 2e-6);
        EXPECT_NEAR(glm::dot(glm::cross(s, t), n), 1, 4e-6);  // right-handed
        EXPECT_EQ(z, n);
    }
}

TEST(Sampling, CosineDirectionsHaveTheirDensity) {
    constexpr int kRings = 8, kSectors = 8;
    for (const vec3 n : {vec3(0, 0, 1), glm::normalize(vec3(1, -2, -3))}) {
        std::vector<double> counts(kRings * kSectors, 0.0);
        const vec3 s = aroundAxis(n, 1, 0, 0), t = aroundAxis(n, 0, 1, 0);
        for (uint i = 0; i < 200000; ++i) {
            const vec4 r = random4(5, i, 0, 0);
            const vec3 d = cosineDirection(n, r.x, r.y);
            ASSERT_NEAR(glm::length(d), 1, 2e-6);
            const float z = glm::dot(d, n);
            ASSERT_GE(z, -1e-6f);
            // sin^2 of the angle is uniform, and so is the azimuth.
            const int ring = std::min(static_cast<int>((1 - z * z) * kRings), kRings - 1);
            const double azimuth =
                std::atan2(glm::dot(d, t), glm::dot(d, s)) / (2 * std::numbers::pi) + 0.5;
            const int sector = std::min(static_cast<int>(azimuth * kSectors), kSectors - 1);
            counts[static_cast<std::size_t>(ring * kSectors + sector)] += 1;
        }
        const std::vector<double> shares(counts.size(), 1.0 / static_cast<double>(counts.size()));
        EXPECT_LT(chiSquareSigmas(counts, shares), 4.0);
    }
    // The ends of the numbers' range.
    EXPECT_EQ(cosineDirection(vec3(0, 1, 0), 0, 0), vec3(0, 1, 0));
    EXPECT_GT(cosineDirection(vec3(0, 0, 1), unitFloat(~0u), unitFloat(~0u)).z, 0.0f);
}

TEST(Sampling, SphereDirectionsAreUniform) {
    constexpr int kRings = 8, kSectors = 8;
    std::vector<double> counts(kRings * kSectors, 0.0);
    for (uint i = 0; i < 200000; ++i) {
        const vec4 r = random4(9, i, 0, 0);
        const vec3 d = sphereDirection(r.x, r.y);
        ASSERT_NEAR(glm::length(d), 1, 2e-6);
        const int ring = std::min(static_cast<int>((d.z + 1) / 2 * kRings), kRings - 1);
        const double azimuth = std::atan2(static_cast<double>(d.y), static_cast<double>(d.x));
        const int sector = std::min(
            static_cast<int>((azimuth / (2 * std::numbers::pi) + 0.5) * kSectors), kSectors - 1);
        counts[static_cast<std::size_t>(ring * kSectors + sector)] += 1;
    }
    const std::vector<double> shares(counts.size(), 1.0 / static_cast<double>(counts.size()));
    EXPECT_LT(chiSquareSigmas(counts, shares), 4.0);
}

TEST(Spot, FalloffIsThatOfKhrLightsPunctual) {
    const float inner = std::cos(0.2f), outer = std::cos(0.6f);
    EXPECT_EQ(spotFalloff(1, inner, outer), 1.0f);
    EXPECT_EQ(spotFalloff(inner, inner, outer), 1.0f);
    EXPECT_EQ(spotFalloff(outer, inner, outer), 0.0f);
    EXPECT_EQ(spotFalloff(-1, inner, outer), 0.0f);
    EXPECT_NEAR(spotFalloff(0.5f * (inner + outer), inner, outer), 0.25, 1e-6);
    // A hard edge where both cones coincide.
    EXPECT_EQ(spotFalloff(outer + 1e-5f, outer, outer), 1.0f);
    EXPECT_EQ(spotFalloff(outer - 1e-5f, outer, outer), 0.0f);
}

TEST(Spot, SolidAngleIsTheIntegralOfTheFalloff) {
    for (const auto& [innerRad, outerRad] : {std::pair{0.0, 0.7}, {0.3, 0.4}, {1.5, 1.57}}) {
        const auto inner = static_cast<float>(std::cos(innerRad));
        const auto outer = static_cast<float>(std::cos(outerRad));
        double sum = 0;
        constexpr int kSteps = 200000;
        for (int i = 0; i < kSteps; ++i) {
            const double c = -1 + 2 * (i + 0.5) / kSteps;
            sum += static_cast<double>(spotFalloff(static_cast<float>(c), inner, outer));
        }
        const double expected = sum * 2 / kSteps * 2 * std::numbers::pi;
        EXPECT_NEAR(spotSolidAngle(inner, outer), expected, 2e-4 * expected);
    }
    EXPECT_NEAR(spotSolidAngle(0, 0), 2 * std::numbers::pi, 1e-5);  // half the sphere
    EXPECT_EQ(spotSolidAngle(1, 1), 0.0f);                          // no cone at all
}

TEST(Spot, CosinesAreDistributedAsTheFalloff) {
    for (const auto& [innerRad, outerRad] : {std::pair{0.0, 0.7}, {0.3, 0.4}, {0.5, 0.5}}) {
        const auto inner = static_cast<float>(std::cos(innerRad));
        const auto outer = static_cast<float>(std::cos(outerRad));
        constexpr std::size_t kBins = 20;
        std::vector<double> counts(kBins, 0.0), shares(kBins, 0.0);
        const double width = (1 - static_cast<double>(outer)) / kBins;
        double total = 0;
        for (std::size_t b = 0; b < kBins; ++b) {
            for (int i = 0; i < 2000; ++i) {
                const double c = static_cast<double>(outer) +
                                 (static_cast<double>(b) + (i + 0.5) / 2000) * width;
                shares[b] += static_cast<double>(spotFalloff(static_cast<float>(c), inner, outer));
            }
            total += shares[b];
        }
        for (double& s : shares) s /= total;
        for (uint i = 0; i < 100000; ++i) {
            const vec4 a = random4(11, i, 0, 0), b = random4(11, i, 0, 1);
            const float c = spotCosine(inner, outer, a.x, a.y, a.z, b.x);
            ASSERT_GE(c, outer);
            ASSERT_LE(c, 1.0f);
            const double bin = (static_cast<double>(c) - static_cast<double>(outer)) / width;
            counts[std::min(static_cast<std::size_t>(bin), kBins - 1)] += 1;
        }
        EXPECT_LT(chiSquareSigmas(counts, shares), 4.0) << innerRad << ' ' << outerRad;
    }
}

}  // namespace
}  // namespace mv
