// Differences of two pictures against the same lines run on the CPU, and the colours they get.

#include "renderer/passes/difference_pass.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "gl/gl_fixture.h"
#include "gpu/frame_fixture.h"
#include "shaders/shared/colour_map.glsl"
#include "shaders/shared/tone.glsl"

namespace mv {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr Difference kKinds[] = {Difference::absolute, Difference::signedValue,
                                 Difference::relative};

class DifferenceTest : public GlTest {
  protected:
    struct Shown {
        std::vector<float> radiance;
        std::vector<std::uint8_t> display;
        double range;
    };
    static gl::Texture texture(int w, int h, const std::vector<float>& rgba) {
        gl::Texture t("given", GL_TEXTURE_2D, GL_RGBA32F, w, h);
        t.writeFloats(4, rgba);
        return t;
    }
    static Shown show(int w, int h, const std::vector<float>& left, const std::vector<float>& right,
                      Difference kind, std::optional<double> range = {}, double ev = 0) {
        DifferencePass pass;
        gl::Profiler profiler;
        gl::Texture radiance, display;
        const double used = pass.render(texture(w, h, left), texture(w, h, right), kind, range, ev,
                                        profiler, radiance, display);
        return {radiance.readFloats(4), display.readBytes(4), used};
    }
};

glm::vec3 texel(const std::vector<float>& rgba, std::size_t i) {
    return {rgba[4 * i], rgba[4 * i + 1], rgba[4 * i + 2]};
}

TEST_F(DifferenceTest, IsThatOfTheCpu) {
    const int w = 61, h = 47;
    const std::size_t texels = static_cast<std::size_t>(w * h);
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    std::vector<float> left(4 * texels, 1.0f), right(4 * texels, 1.0f);
    for (std::size_t i = 0; i < 4 * texels; ++i) {
        left[i] = std::exp(2 * normal(random));
        right[i] = i % 7 ? std::exp(2 * normal(random)) : left[i];
    }
    std::fill(left.begin() + 40, left.begin() + 80, 0.0f);  // black on the left
    left[4 * 50 + 1] = kNan;
    right[4 * 60] = std::numeric_limits<float>::infinity();
    const double ev = 1.5;
    for (const Difference kind : kKinds) {
        const auto number = static_cast<uint>(kind);
        const Shown got = show(w, h, left, right, kind, {}, ev);
        std::vector<double> sizes;
        std::size_t bad = 0, off = 0;
        for (std::size_t i = 0; i < texels; ++i) {
            const glm::vec3 l = texel(left, i), r = texel(right, i);
            const float value =
                differenceValue(number, l, r, 0.01f * 0.18f * std::exp2(static_cast<float>(-ev)));
            const std::uint8_t* shown = &got.display[4 * i];
            EXPECT_EQ(shown[3], 255);
            if (!std::isfinite(l.x + l.y + l.z + r.x + r.y + r.z)) {
                ++bad;
                EXPECT_TRUE(shown[0] == 255 && shown[1] == 0 && shown[2] == 255) << i;
                continue;
            }
            for (std::size_t c = 0; c < 3; ++c) {
                EXPECT_EQ(got.radiance[4 * i + c], right[4 * i + c] - left[4 * i + c]);
            }
            const glm::vec3 want = differenceColor(
                number, std::clamp(value / static_cast<float>(got.range), -1.0f, 1.0f));
            for (int c = 0; c < 3; ++c) off += std::abs(shown[c] - 255 * want[c]) > 0.75f;
            sizes.push_back(std::abs(double{value}));
        }
        EXPECT_EQ(bad, 2u);
        EXPECT_EQ(off, 0u);
        // The 99th percentile, rounded up by less than a bin.
        std::sort(sizes.begin(), sizes.end());
        const double percentile = sizes[(sizes.size() * 99 + 99) / 100 - 1];
        EXPECT_GE(got.range, percentile);
        EXPECT_LE(got.range, percentile * (1 + 1.0 / 128) * 1.0001);
        // The same again, and a locked range stays.
        EXPECT_EQ(show(w, h, left, right, kind, {}, ev).display, got.display);
        EXPECT_EQ(show(w, h, left, right, kind, 0.125, ev).range, 0.125);
        EXPECT_EQ(show(w, h, left, right, kind, got.range, ev).display, got.display);
    }
    expectNoGlErrors();
}

TEST_F(DifferenceTest, TakesPicturesThatHardlyDiffer) {
    for (const auto& [w, h] :
         {std::pair(1, 1), std::pair(255, 1), std::pair(16, 16), std::pair(97, 61)}) {
        std::vector<float> same(static_cast<std::size_t>(4 * w * h), 0.5f), other = same;
        for (const Difference kind : kKinds) {
            const Shown equal = show(w, h, same, same, kind);
            EXPECT_EQ(equal.range, 1);
            const glm::vec3 zero = differenceColor(static_cast<uint>(kind), 0);
            for (std::size_t i = 0; i < equal.display.size(); ++i) {
                if (i % 4 == 3) continue;
                EXPECT_NEAR(equal.display[i], 255 * zero[static_cast<int>(i % 4)], 0.75f);
            }
        }
        // A single texel: more than 99 % are equal, so the range is its difference.
        other[0] = other[1] = other[2] = 0.75f;
        const Shown one = show(w, h, same, other, Difference::absolute);
        EXPECT_GE(one.range, 0.25);
        EXPECT_LT(one.range, 0.2521);
        // Nothing but NaN.
        std::fill(other.begin(), other.end(), kNan);
        EXPECT_EQ(show(w, h, same, other, Difference::signedValue).range, 1);
    }
    expectNoGlErrors();
}

// Colour maps must stay readable in grey: light grows with the number, or away from white on both
// sides alike.
TEST(ColourMap, LightnessIsMonotone) {
    const auto light = [](glm::vec3 srgb) {
        const auto linear = [](float c) {
            return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
        };
        return 0.2126f * linear(srgb.x) + 0.7152f * linear(srgb.y) + 0.0722f * linear(srgb.z);
    };
    for (int i = 0; i < 200; ++i) {
        const float a = static_cast<float>(i) / 200, b = static_cast<float>(i + 1) / 200;
        EXPECT_LT(light(viridis(a)), light(viridis(b))) << a;
        EXPECT_LT(light(cividis(a)), light(cividis(b))) << a;
        EXPECT_GT(light(divergingColor(a)), light(divergingColor(b))) << a;
        EXPECT_GT(light(divergingColor(-a)), light(divergingColor(-b))) << a;
        EXPECT_NEAR(light(divergingColor(a)), light(divergingColor(-a)), 0.08f) << a;
        // Blue falls on one side, red on the other: what any common colour blindness leaves.
        if (i <= 10) continue;
        EXPECT_GT(divergingColor(-a).z - divergingColor(a).z, 0.05f) << a;
        EXPECT_GT(divergingColor(a).x - divergingColor(-a).x, 0.05f) << a;
    }
    // Published colours [viridisLite: viridis(10), cividis(10)].
    const auto near = [](glm::vec3 got, int r, int g, int b, float tolerance) {
        return glm::all(
            glm::lessThanEqual(glm::abs(got * 255.0f - glm::vec3(r, g, b)), glm::vec3(tolerance)));
    };
    EXPECT_TRUE(near(viridis(0), 0x44, 0x01, 0x54, 4));
    EXPECT_TRUE(near(viridis(4.0f / 9), 0x26, 0x82, 0x8E, 4));
    EXPECT_TRUE(near(viridis(1), 0xFD, 0xE7, 0x25, 4));
    EXPECT_TRUE(near(cividis(0), 0x00, 0x20, 0x4D, 10));
    EXPECT_TRUE(near(cividis(5.0f / 9), 0x8A, 0x87, 0x79, 10));
    EXPECT_TRUE(near(cividis(1), 0xFF, 0xEA, 0x46, 10));
}

// Through the whole frame: the difference of the two sides, as each alone would be.
class DifferenceFrame : public test::FrameTest {};
TEST_F(DifferenceFrame, IsThatOfTheTwoSides) {
    compareWith(settings, Method::none);
    std::vector<std::vector<float>> sides;
    for (const Settings& side : {sideAlone(settings, 0), sideAlone(settings, 1)}) {
        Settings alone = side;
        alone.compare = false;
        render(alone);
        sides.push_back(radiance());
    }
    for (const Difference kind : kKinds) {
        settings.display.difference = kind;
        const FrameStatistics statistics = render();
        EXPECT_GT(statistics.differenceRange, 0);
        const auto got = radiance();
        for (std::size_t i = 0; i < got.size(); ++i) {
            if (i % 4 != 3) {
                ASSERT_EQ(got[i], sides[1][i] - sides[0][i]);
            }
        }
        const auto automatic = display();
        settings.display.differenceRange = statistics.differenceRange;
        EXPECT_EQ(render().differenceRange, statistics.differenceRange);
        EXPECT_EQ(display(), automatic);
        settings.display.differenceRange = 2 * statistics.differenceRange;
        EXPECT_EQ(render().differenceRange, 2 * statistics.differenceRange);
        EXPECT_NE(display(), automatic);
        settings.display.differenceRange.reset();
    }
    settings.display.difference = Difference::off;
    EXPECT_EQ(render().differenceRange, 0);
}

}  // namespace
}  // namespace mv
