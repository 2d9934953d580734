// The gloss of microfacet.glsl against sums over the half space, and what each gives back.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "shaders/shared/microfacet.glsl"

namespace mv {
namespace {

constexpr glm::vec3 kUp(0, 0, 1);
glm::vec3 at(float cosine, float turn = 0) {
    const float sine = std::sqrt(1 - cosine * cosine);
    return {sine * std::cos(turn), sine * std::sin(turn), cosine};
}

// What the gloss sends towards `toEye` of light 1 from everywhere: a sum over directions, dense
// where the mirror's is.
// Of directions with x >= from alone.
glm::dvec3 sumOfBrdf(glm::vec3 atNormal, float alpha, glm::vec3 toEye, float from = -1) {
    constexpr int kSteps = 700;
    glm::dvec3 sum(0);
    // Facets over the half space; light comes from the mirror's direction at each.
    for (int i = 0; i < kSteps; ++i) {
        // tan of the facet's angle = alpha * x / (1 - x), so that half of the steps are in the
        // lobe.
        const double x = (i + 0.5) / kSteps;
        const double tangent = static_cast<double>(alpha) * x / (1 - x);
        const double cosine = 1 / std::sqrt(1 + tangent * tangent);
        const double angleStep =
            static_cast<double>(alpha) / ((1 - x) * (1 - x)) * cosine * cosine / kSteps;
        const double sine = tangent * cosine;
        for (int j = 0; j < kSteps; ++j) {
            const double turn = 2 * std::numbers::pi * (j + 0.5) / kSteps;
            const glm::vec3 facet(sine * std::cos(turn), sine * std::sin(turn), cosine);
            const float towards = glm::dot(toEye, facet);
            if (towards <= 0) continue;
            const glm::vec3 toLight = 2 * towards * facet - toEye;
            if (toLight.z <= 0 || toLight.x < from) continue;
            // Solid angle of the light: 4 cos that of the facets.
            const double solid = 4.0 * static_cast<double>(towards) * sine * angleStep * 2 *
                                 std::numbers::pi / kSteps;
            sum += glm::dvec3(ggxBrdf(atNormal, 1, alpha, kUp, toEye, toLight)) *
                   (static_cast<double>(toLight.z) * solid);
        }
    }
    return sum;
}

TEST(Microfacet, IsTheMirrorsHeightAtTheMirrorsDirection) {
    // D G / (4 cos cos) along the normal: 1 / (4 pi alpha^2).
    for (const float roughness : {0.1f, 0.3f, 0.5f, 1.0f}) {
        const float alpha = ggxAlpha(roughness);
        const glm::vec3 brdf = ggxBrdf({0.04f, 0.5f, 1}, 1, alpha, kUp, kUp, kUp);
        const float height = 1 / (4 * kPi * alpha * alpha);
        EXPECT_NEAR(brdf.x / (0.04f * height), 1, 1e-4);
        EXPECT_NEAR(brdf.y / (0.5f * height), 1, 1e-4);
        EXPECT_NEAR(brdf.z / height, 1, 1e-4);
    }
}

TEST(Microfacet, IsTheSameBothWaysAndNothingBelow) {
    for (const float roughness : {0.05f, 0.4f, 0.9f}) {
        for (const float a : {0.1f, 0.5f, 0.95f}) {
            const glm::vec3 x = at(a), y = at(0.7f, 2);
            const float alpha = ggxAlpha(roughness);
            const glm::vec3 there = ggxBrdf({0.04f, 0.2f, 0.9f}, 1, alpha, kUp, x, y);
            const glm::vec3 back = ggxBrdf({0.04f, 0.2f, 0.9f}, 1, alpha, kUp, y, x);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(there[c], back[c], 1e-5f * there[c]);
            }
            EXPECT_EQ(ggxBrdf(glm::vec3(1), 1, alpha, kUp, x, -y), glm::vec3(0));
        }
    }
}

TEST(Microfacet, RaysWeighWhatTheLobeHolds) {
    for (const float roughness : {0.2f, 0.45f, 0.7f, 1.0f}) {
        for (const float cosine : {0.15f, 0.5f, 0.9f}) {
            const glm::vec3 atNormal(0.04f, 0.5f, 1);
            const float alpha = ggxAlpha(roughness);
            const glm::vec3 toEye = at(cosine);
            glm::dvec3 mean(0), part(0);
            const float from = 0.25f - toEye.x;  // beside the mirror's direction
            constexpr int kRays = 200;
            for (int i = 0; i < kRays * kRays; ++i) {
                glm::vec3 weight;
                const glm::vec3 way = ggxReflection(
                    atNormal, 1, alpha, kUp, toEye, (static_cast<float>(i % kRays) + 0.5f) / kRays,
                    (static_cast<float>(i / kRays) + 0.5f) / kRays, weight);
                EXPECT_NEAR(glm::length(way), 1, 1e-4);
                mean += glm::dvec3(weight) / double(kRays * kRays);
                if (way.x >= from) part += glm::dvec3(weight) / double(kRays * kRays);
            }
            const glm::dvec3 sum = sumOfBrdf(atNormal, alpha, toEye);
            const glm::dvec3 sumOfPart = sumOfBrdf(atNormal, alpha, toEye, from);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(mean[c], sum[c], 0.004) << roughness << " " << cosine << " " << c;
                EXPECT_NEAR(part[c], sumOfPart[c], 0.004) << roughness << " " << cosine << " " << c;
            }
        }
    }
}

TEST(Microfacet, RaysOfAMirrorLeaveAsTheyCame) {
    const glm::vec3 toEye = at(0.6f);
    glm::vec3 weight;
    for (const float u : {0.3f, 0.9999f}) {  // far out in the lobe's tail, too
        const glm::vec3 way =
            ggxReflection(glm::vec3(1), 1, ggxRayAlpha(0), kUp, toEye, u, 0.8f, weight);
        EXPECT_NEAR(glm::distance(way, glm::vec3(-toEye.x, toEye.y, toEye.z)), 0, 4e-4);
        EXPECT_NEAR(weight.x, 1, 1e-3);
    }
}

// [KHR_materials_specular]: a factor of the layer is one of all that it reflects, at every angle.
TEST(Microfacet, ADimmedLayerReflectsThatShareEverywhere) {
    const glm::vec3 whole(0.04f, 0.5f, 1);
    for (const float factor : {0.02f, 0.5f}) {
        const glm::vec3 dimmed = factor * whole;
        for (const float cosine : {0.05f, 0.4f, 1.0f}) {
            const glm::vec3 toEye = at(cosine), toLight = at(0.1f, 3);
            glm::vec3 weight, wholeWeight;
            ggxReflection(dimmed, factor, 0.2f, kUp, toEye, 0.3f, 0.6f, weight);
            ggxReflection(whole, 1, 0.2f, kUp, toEye, 0.3f, 0.6f, wholeWeight);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(ggxBrdf(dimmed, factor, 0.2f, kUp, toEye, toLight)[c],
                            factor * ggxBrdf(whole, 1, 0.2f, kUp, toEye, toLight)[c], 1e-5f);
                EXPECT_NEAR(glossAlbedo(dimmed, factor, 0.4f, cosine)[c],
                            factor * glossAlbedo(whole, 1, 0.4f, cosine)[c], 1e-6f);
                EXPECT_NEAR(weight[c], factor * wholeWeight[c], 1e-6f);
            }
        }
    }
}

TEST(Microfacet, TheFitIsWhatTheLobeReflects) {
    double worst = 0;
    for (const float roughness : {0.1f, 0.3f, 0.5f, 0.7f, 1.0f}) {
        for (const float cosine : {0.1f, 0.3f, 0.6f, 1.0f}) {
            const glm::dvec3 sum = sumOfBrdf({0.04f, 0.5f, 1}, ggxAlpha(roughness), at(cosine));
            const glm::vec3 fit = glossAlbedo({0.04f, 0.5f, 1}, 1, roughness, cosine);
            for (int c = 0; c < 3; ++c) {
                worst = std::max(worst, std::abs(sum[c] - static_cast<double>(fit[c])));
            }
        }
    }
    EXPECT_LT(worst, 0.03);
    RecordProperty("worst", std::to_string(worst));
    std::printf("worst %g\n", worst);
}

TEST(Microfacet, WhiteMetalReflectsAllOfItsLight) {
    for (const float roughness : {0.0f, 0.3f, 0.6f, 1.0f}) {
        for (const float cosine : {0.1f, 0.5f, 1.0f}) {
            EXPECT_NEAR(glossReflectance(glm::vec3(1), 1, roughness, cosine).x, 1, 1e-5);
            // Coloured facets lose more at each bounce.
            const glm::vec3 gold = glossReflectance({1, 0.6f, 0.2f}, 1, roughness, cosine);
            EXPECT_GT(gold.x, gold.y);
            EXPECT_GT(gold.y, gold.z);
            EXPECT_LE(gold.x, 1);
        }
    }
}

TEST(Microfacet, FadesIntoMattBetweenTwoRoughnesses) {
    EXPECT_EQ(glossShare(0), 1);
    EXPECT_EQ(glossShare(kRoughGloss), 1);
    EXPECT_EQ(glossShare(kRoughestGloss), 0);
    EXPECT_EQ(glossShare(1), 0);
    EXPECT_NEAR(glossShare(0.5f * (kRoughGloss + kRoughestGloss)), 0.5f, 1e-5);
}

TEST(Microfacet, BroadGlossLightsASurfaceByItsOwnBrdf) {
    const glm::vec3 n(0, 0, 1), base(0.5f, 0.2f, 0.05f);
    for (const float roughness : {0.55f, 0.7f, 0.9f, 1.0f}) {
        for (const float metal : {0.0f, 1.0f}) {
            const glm::vec3 toEye = glm::normalize(glm::vec3(0.8f, 0.1f, 0.3f));
            const glm::vec3 atNormal(metal > 0 ? 0.6f : 0.04f);
            const glm::vec3 broad =
                (1 - glossShare(roughness)) * glossReflectance(atNormal, 1, roughness, toEye.z);
            const glm::vec3 matt = base * (1 - metal);
            const float seen = 0.5f, part = (1 - glossShare(roughness)) * seen;
            const BroadGloss gloss =
                broadGloss(atNormal, 1, roughness, 0, part, (matt + broad) * seen, n, toEye);
            for (const glm::vec3 way :
                 {glm::vec3(0, 0, 1), glm::vec3(-0.8f, -0.1f, 0.3f), glm::vec3(0.7f, 0.6f, 0.2f)}) {
                const glm::vec3 toLight = glm::normalize(way);
                const glm::vec3 brdf =
                    matt / kPi + ggxBrdf(atNormal, 1, ggxAlpha(roughness), n, toEye, toLight) *
                                     glossCompensation(atNormal, roughness, toEye.z) *
                                     (1 - glossShare(roughness));
                const glm::vec3 found = (matt + broad) / kPi * broadGlossWeight(gloss, n, toLight);
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], brdf[c], 1e-4f * brdf[c]);
            }
        }
    }
    // Where gloss is narrow, or there is none, light counts as on a matt surface.
    for (const BroadGloss& none : {BroadGloss{}, broadGloss({1, 1, 1}, 1, 0.4f, 0, 0, base, n, n),
                                   broadGloss({0, 0, 0}, 1, 0.9f, 0, 1, base, n, n)}) {
        EXPECT_EQ(broadGlossWeight(none, n, n), glm::vec3(1));
    }
}

}  // namespace
}  // namespace mv
