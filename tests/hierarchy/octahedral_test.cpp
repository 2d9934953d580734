#include "shaders/shared/octahedral.glsl"

#include <gtest/gtest.h>

#include <random>

namespace mv {
namespace {

TEST(Octahedral, DirectionsComeBack) {
    std::mt19937 random(1);
    std::normal_distribution<float> gauss(0, 1);
    for (int i = 0; i < 20000; ++i) {
        const vec3 d(gauss(random), gauss(random), i % 5 ? gauss(random) : 1e-6f * gauss(random));
        const vec2 p = octahedralPoint(d);
        ASSERT_LE(std::max(std::abs(p.x), std::abs(p.y)), 1.0f) << d.x << ' ' << d.y << ' ' << d.z;
        const float inner = 1 - std::abs(p.x) - std::abs(p.y);  // the upper half's part
        ASSERT_GE(inner * d.z, -1e-6f) << d.x << ' ' << d.y << ' ' << d.z;
        for (const float scale : {1.0f, 1023.0f}) {
            const vec3 back = octahedralDirection(scale * p, scale);
            ASSERT_LT(glm::length(glm::cross(d, back)), 1e-6f * glm::length(d) * glm::length(back))
                << d.x << ' ' << d.y << ' ' << d.z;
            ASSERT_GT(glm::dot(d, back), 0) << d.x << ' ' << d.y << ' ' << d.z;
            ASSERT_GT(glm::length(back), 0.577f * scale);
            ASSERT_LT(glm::length(back), 1.001f * scale);
        }
    }
}

TEST(Octahedral, AxesAreExactAndNothingIsTheMiddle) {
    for (int k = 0; k < 6; ++k) {
        vec3 d(0);
        d[k / 2] = k % 2 ? -3.0f : 3.0f;
        EXPECT_EQ(octahedralDirection(octahedralPoint(d), 1.0f), d / 3.0f);
    }
    EXPECT_EQ(octahedralPoint(vec3(0)), vec2(0));
    EXPECT_EQ(octahedralPoint(vec3(std::nanf(""), 0, 0)), vec2(0));
}

}  // namespace
}  // namespace mv
