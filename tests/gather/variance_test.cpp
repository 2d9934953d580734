// What a gather's few samples are told to vary by, and how far what maps believe is doubted.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "shaders/shared/gather_variance.glsl"
#include "shaders/shared/map_belief.glsl"
#include "shaders/shared/random.glsl"

namespace mv {
namespace {

// Unbiased: over many draws of n numbers, the mean of the estimate is n times their variance.
TEST(VarianceOfSum, IsThatOfTheSum) {
    std::mt19937 random(3);
    std::exponential_distribution<float> light(2);  // variance 1/4
    for (const uint n : {2u, 8u, 16u}) {
        double mean = 0;
        constexpr int kDraws = 20000;
        for (int i = 0; i < kDraws; ++i) {
            float sum = 0, squares = 0;
            for (uint k = 0; k < n; ++k) {
                const float x = light(random);
                sum += x;
                squares += x * x;
            }
            mean += double{varianceOfSum(sum, squares, n)} / kDraws;
        }
        EXPECT_NEAR(mean, 0.25 * n, 0.05 * 0.25 * n) << n;
    }
    EXPECT_EQ(varianceOfSum(3, 9, 1), 9) << "of one sample nothing is known";
    EXPECT_EQ(varianceOfSum(0, 0, 8), 0);
}

// Samples of a lamp, one from each of n squares of it, behind the edge of a shadow: what is told of
// their variance is half of what they have or more, on average over edges, for any n.
// A sun asked three times and a sky asked once: that the sun is brighter is no noise.
TEST(VarianceOfTwoWays, IsOfEachWayByItself) {
    EXPECT_EQ(varianceOfTwoWays(vec2(30, 0), vec2(300, 0), uvec2(3, 0)), varianceOfSum(30, 300, 3));
    EXPECT_EQ(varianceOfTwoWays(vec2(30, 4), vec2(300, 8), uvec2(3, 2)), 0);
    EXPECT_LE(varianceOfTwoWays(vec2(30, 2), vec2(300, 4), uvec2(3, 1)), 4)
        << "all of a single one";
    EXPECT_EQ(varianceOfTwoWays(vec2(4, 2), vec2(16, 4), uvec2(1, 1)), 4) << "as of one way";
    EXPECT_EQ(varianceOfTwoWays(vec2(3, 0), vec2(9, 0), uvec2(1, 0)), 9) << "nothing is known";
    EXPECT_EQ(varianceOfTwoWays(vec2(0), vec2(0), uvec2(0)), 0);
    // In the mean it is the variance, with two or more of each.
    constexpr int kDraws = 20000;
    double told = 0, sum = 0, squares = 0;
    for (uint i = 0; i < kDraws; ++i) {
        vec2 sums(0), moments(0);
        for (uint k = 0; k < 5; ++k) {
            const float u = random4(4, i, k, 0).x;
            const float x = k < 3 ? 10 + u : 3 * u;
            sums[k < 3 ? 0 : 1] += x;
            moments[k < 3 ? 0 : 1] += x * x;
        }
        told += double{varianceOfTwoWays(sums, moments, uvec2(3, 2))} / kDraws;
        const double all = double{sums.x} + double{sums.y};
        sum += all / kDraws;
        squares += all * all / kDraws;
    }
    EXPECT_NEAR(told, squares - sum * sum, 0.05);
    EXPECT_NEAR(told, 3.0 / 12 + 2 * 9.0 / 12, 0.05);
}

TEST(VarianceWithLamps, KnowsWhatStrataAreWorth) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    for (const uint edge : {2u, 4u, 8u}) {
        const uint n = edge * edge;
        double told = 0, toldAlone = 0, real = 0;
        for (int i = 0; i < 2000; ++i) {
            // A line through the square, equally likely by direction and distance.
            const float angle = 6.2831853f * unit(random), across = 1.5f * (unit(random) - 0.5f);
            double mean = 0, mean2 = 0;
            constexpr int kDraws = 50;
            for (int draw = 0; draw < kDraws; ++draw) {
                float sum = 0;
                for (uint k = 0; k < n; ++k) {
                    const float x = (float(k % edge) + unit(random)) / float(edge) - 0.5f;
                    const float y = (float(k / edge) + unit(random)) / float(edge) - 0.5f;
                    sum += x * std::cos(angle) + y * std::sin(angle) < across ? 1.0f : 0.0f;
                }
                const float spread = lampSpread(n);
                const vec2 lamps = (1 - spread) * vec2(float(n), sum);
                told += double{varianceWithLamps(sum, spread * sum, lamps, n)};
                toldAlone += double{varianceOfSum(sum, sum, n)};
                mean += double{sum} / kDraws;
                mean2 += double{sum} * double{sum} / kDraws;
            }
            real += (mean2 - mean * mean) * kDraws * kDraws / (kDraws - 1);
        }
        EXPECT_GT(told / real, 0.4) << n;
        EXPECT_LT(told / real, 1) << n;
        EXPECT_GT(toldAlone / real, 0.8 * std::sqrt(double(n))) << n;
    }
    // No lamp: the same bits.
    EXPECT_EQ(varianceWithLamps(3, 4, vec2(0), 8), varianceOfSum(3, 4, 8));
    EXPECT_EQ(varianceWithLamps(0, 0, vec2(8, 0), 8), 0);
    // Half of 8 samples of a lamp, lit all alike: what they differ from the others by is no noise
    // of theirs alone.
    const float spread = lampSpread(8), less = 1 - spread;
    const float mixed = varianceWithLamps(4, 4 * spread, less * vec2(4, 4), 8);
    EXPECT_LT(mixed, varianceOfSum(4, 4, 8));
    EXPECT_GT(mixed, varianceWithLamps(4, 4 * spread, less * vec2(8, 4), 8));
}

// Samples of as many lamps know nothing of each other.
TEST(VarianceWithLamps, SamplesOfDifferentLampsAreIndependent) {
    EXPECT_EQ(lampsSpread(8, 0), lampSpread(8));
    EXPECT_EQ(lampsSpread(8, 1), 1);
    const vec3 up(0, 1, 0), across(1, 0, 0), at(0, 0, 0);
    EXPECT_TRUE(isOneLamp(at, {-1, 1, 0}, -up, {1, 1, 0}, -up)) << "a panel";
    EXPECT_TRUE(isOneLamp(at, {-0.1f, 1, 0}, -across, {0.1f, 1, 0}, across)) << "a bulb";
    EXPECT_FALSE(isOneLamp(at, {-1, 1, 0}, across, {1, 1, 0}, -across)) << "both sides of a street";
    EXPECT_FALSE(isOneLamp(at, {-1, 1, 0}, -up, {1, 2, 0}, -up)) << "panels one above the other";
}

// What a group would give is told from what it takes samples by, and its samples in the mean give
// just that.
TEST(Beliefs, SamplesOfAGroupGiveWhatItWouldGive) {
    Choice choice = noChoice(0);
    for (const float total : {1e-6f, 0.3f, 2.0f, 1e9f}) {
        choice.total = total;
        for (const uint verdict :
             {kVerdictBlocked, kVerdictLit, kVerdictRatherBlocked, kVerdictRatherLit}) {
            const float doubt = doubtIn(verdict, 0.6f);
            const float weight = doubtedWeight(choice, doubt);
            EXPECT_NEAR(doubtedTotal(weight, doubt), total, 1e-5f * total);
            // Of 8 strata of 32 candidates, where all groups weigh as much as 5 of these.
            const float samples = 8.0f / 5;
            const float light = doubtedLight(weight, doubt, 5 * weight, 8, 32);
            EXPECT_NEAR(samples * light, total / 32, 1e-5f * total);
        }
    }
    choice.total = 0;
    EXPECT_EQ(doubtedWeight(choice, 1), 0);
}

// Maps that are sure are doubted as much as is asked for; who is not sure is doubted more.
TEST(Beliefs, WhoIsSureIsDoubtedLess) {
    for (const uint sure : {kVerdictBlocked, kVerdictLit}) {
        EXPECT_TRUE(isSure(sure));
        EXPECT_EQ(doubtIn(sure, 0), 0);
        EXPECT_EQ(doubtIn(sure, 0.25f), 0.25f);
        EXPECT_EQ(beliefIn(sure), sure == kVerdictLit ? 1 : 0);
    }
    for (const uint unsure : {kVerdictRatherBlocked, kVerdictRatherLit}) {
        EXPECT_FALSE(isSure(unsure));
        EXPECT_GT(doubtIn(unsure, 0), 0.5f);
        EXPECT_GT(beliefIn(unsure), 0);
        EXPECT_LT(beliefIn(unsure), 1);
    }
    EXPECT_LT(beliefIn(kVerdictRatherBlocked), beliefIn(kVerdictRatherLit));
}

}  // namespace
}  // namespace mv
