// How light of earlier frames and a frame's own are averaged (shaders/shared/history.glsl).

#include "shaders/shared/history.glsl"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace mv {
namespace {

TEST(History, SamplesOfSteadyLightCountAlike) {
    float known = 0, mean = 0;
    const std::vector<float> sets = {4, 8, -3, 1, 0.5f};
    double sum = 0;
    for (std::size_t n = 0; n < sets.size(); ++n) {
        const float share = shareOfNew(8, known, 0, 2);
        mean += share * (sets[n] - mean);
        known = worthOfMean(8, share, 1e6f);
        sum += double{sets[n]};
        EXPECT_NEAR(mean, sum / static_cast<double>(n + 1), 1e-5);
        EXPECT_NEAR(known, 8.0 * static_cast<double>(n + 1), 1e-3);
    }
}

TEST(History, SetsOfOtherSizesCountByTheirSamples) {
    EXPECT_NEAR(shareOfNew(8, 24, 0, 1), 0.25f, 1e-6);
    EXPECT_NEAR(shareOfNew(4, 12, 0, 1), 0.25f, 1e-6);
    EXPECT_NEAR(worthOfMean(8, 0.25f, 1e6f), 32, 1e-4);
    EXPECT_EQ(worthOfMean(8, 0.25f, 20), 20);
}

// No other share gives a smaller squared error.
TEST(History, ShareOfNewIsTheBestThereIs) {
    for (const float before : {1.0f, 8.0f, 100.0f}) {
        for (const float change2 : {0.0f, 0.1f, 4.0f}) {
            const float variance = 0.7f, samples = 8;
            const auto error = [&](float a) {
                const float old = variance * samples / before + change2;
                return a * a * variance + (1 - a) * (1 - a) * old;
            };
            const float best = shareOfNew(samples, before, change2, variance);
            for (float a = 0; a <= 1; a += 0.05f) EXPECT_LE(error(best), error(a) + 1e-6f);
        }
    }
}

TEST(History, NothingKnownOrAllChangedIsForgotten) {
    EXPECT_EQ(shareOfNew(8, 0, 0, 1), 1);
    EXPECT_EQ(shareOfNew(8, 8, INFINITY, 1), 1);
    EXPECT_EQ(shareOfNew(8, 8, 1, 0), 1);  // a change where there is no noise
    EXPECT_GT(shareOfNew(8, 800, 100, 1), 0.98f);
    EXPECT_LT(worthOfMean(8, shareOfNew(8, 800, 100, 1), 1e6f), 8.2f);
    // Black that stays black.
    EXPECT_NEAR(shareOfNew(8, 8, 0, 0), 0.5f, 1e-6);
}

// Two estimates of the same light do not look changed, on average by half of their noise; two of
// lights ten deviations apart do.
TEST(History, NoiseIsNoChange) {
    std::mt19937 random(3);
    std::normal_distribution<float> noise(0, std::sqrt(0.5f));
    double same = 0, other = 0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
        const float difference = noise(random) - noise(random);
        same += double{changeOfLight(difference, 1)};
        other += double{changeOfLight(10 + difference, 1)};
    }
    EXPECT_NEAR(same / n, 0.484, 0.03);  // E max(0, x^2 - 1) of a normal x
    EXPECT_NEAR(other / n, 100, 1);
}

}  // namespace
}  // namespace mv
