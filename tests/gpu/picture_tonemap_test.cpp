// Radiance -> picture: compositing, exposure, tone curves and sRGB against values worked out by
// hand.

#include <algorithm>
#include <cmath>
#include <limits>

#include "gl/gl_fixture.h"
#include "gpu/picture_scenes.h"
#include "megaviews/settings/debug_legends.h"
#include "renderer/passes/bad_pixels_pass.h"
#include "renderer/passes/compose_pass.h"
#include "renderer/passes/fit_exposure.h"
#include "renderer/passes/tonemap_pass.h"
#include "shaders/shared/colour_map.glsl"
#include "shaders/shared/tone.glsl"

namespace mv {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

class TonemapTest : public GlTest {
  protected:
    void SetUp() override {
        GlTest::SetUp();
        if (!IsSkipped()) profiler = std::make_unique<gl::Profiler>();
    }
    void TearDown() override {
        profiler.reset();
        GlTest::TearDown();
    }
    std::unique_ptr<gl::Profiler> profiler;

    static gl::Texture texture(int w, int h, const std::vector<float>& rgba) {
        gl::Texture t("given", GL_TEXTURE_2D, GL_RGBA32F, w, h);
        t.writeFloats(4, rgba);
        return t;
    }
    static gl::Texture constant(int w, int h, glm::vec4 value) {
        std::vector<float> rgba;
        for (int i = 0; i < w * h; ++i)
            rgba.insert(rgba.end(), {value.x, value.y, value.z, value.w});
        return texture(w, h, rgba);
    }
    static GBuffer gbuffer(int w, int h, glm::vec4 position, glm::vec4 normal, glm::vec4 albedo,
                           glm::vec4 emission) {
        GBuffer g;
        g.width = w;
        g.height = h;
        g.position = constant(w, h, position);
        g.normal = constant(w, h, normal);
        g.albedo = constant(w, h, albedo);
        g.emission = constant(w, h, emission);
        return g;
    }
    // The mean over what the dither makes of one value.
    double meanShown(TonemapPass& pass, float value, ToneMap map) {
        gl::Texture display;
        pass.render(constant(32, 32, {value, value, value, 1}), {0, map, DebugView::final},
                    *profiler, display);
        const auto bytes = display.readBytes(4);
        double sum = 0;
        for (std::size_t i = 0; i < bytes.size(); i += 4) sum += bytes[i];
        return sum / (32 * 32);
    }
    std::vector<std::uint8_t> shown(TonemapPass& pass, float value, double ev, ToneMap map) {
        gl::Texture display;
        pass.render(constant(2, 2, {value, value, value, 1}), {ev, map, DebugView::final},
                    *profiler, display);
        return display.readBytes(4);
    }
};

TEST_F(TonemapTest, SrgbIsExactAtItsKnownValues) {
    TonemapPass pass;
    const std::pair<float, double> known[] = {{0.0f, 0},
                                              {0.0031308f, 10.315},
                                              {0.001f, 3.295},
                                              {0.18f, 117.645},
                                              {0.21404114f, 127.5},
                                              {0.5f, 187.516},
                                              {0.73f, 221.926},
                                              {1.0f, 255},
                                              {7.0f, 255},
                                              {-1.0f, 0},
                                              {kNan, 0},
                                              {kInf, 0}};
    for (const auto& [linear, level] : known) {
        EXPECT_NEAR(meanShown(pass, linear, ToneMap::none), level, 0.05) << linear;
        const auto out = shown(pass, linear, 0, ToneMap::none);
        EXPECT_NEAR(out[0], level, 1) << linear;
        EXPECT_EQ(out[0], out[2]);
        EXPECT_EQ(out[3], 255);
    }
    // Every byte survives decoding and encoding.
    for (int b = 0; b < 256; ++b) {
        const double c = b / 255.0;
        const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
        EXPECT_EQ(shown(pass, static_cast<float>(linear), 0, ToneMap::none)[1], b);
        EXPECT_EQ(shown(pass, static_cast<float>(linear / 8), 3, ToneMap::none)[1], b);
    }
    expectNoGlErrors();
}

TEST_F(TonemapTest, ToneCurvesGiveTheirPublishedValues) {
    // Narkowicz' curve, evaluated by hand: x = 0.18: 0.0869 / 0.3349; x = 1: 2.54 / 3.16.
    EXPECT_NEAR(acesChannel(0.0f), 0.0f, 1e-7f);
    EXPECT_NEAR(acesChannel(0.18f),
                (0.18f * (2.51f * 0.18f + 0.03f)) / (0.18f * (2.43f * 0.18f + 0.59f) + 0.14f),
                1e-6f);
    EXPECT_NEAR(acesChannel(0.18f), 0.26690f, 1e-4f);
    EXPECT_NEAR(acesChannel(1.0f), 2.54f / 3.16f, 1e-6f);
    EXPECT_EQ(acesChannel(1000.0f), 1.0f);
    // Neutral: below 0.08 a toe of 6.25 x^2, then x - 0.04, compressed from 0.76 on, to 1.
    const auto neutral = [](float x) { return neutralToneMap(glm::vec3(x)).x; };
    EXPECT_NEAR(neutral(0.04f), 6.25f * 0.04f * 0.04f, 1e-6f);
    EXPECT_NEAR(neutral(0.08f), 0.04f, 1e-6f);
    EXPECT_NEAR(neutral(0.5f), 0.46f, 1e-6f);
    EXPECT_NEAR(neutral(0.8f), 0.76f, 1e-6f);
    EXPECT_NEAR(neutral(1.04f), 1 - 0.24f * 0.24f / (1.0f + 0.24f - 0.76f), 1e-6f);
    EXPECT_LE(neutral(1e6f), 1.0f);
    EXPECT_GT(neutral(1e6f), 0.999f);
    // A saturated highlight goes towards white, a dim one keeps its colour.
    const glm::vec3 bright = neutralToneMap(glm::vec3(20, 0, 0));
    EXPECT_GT(bright.y, 0.5f);
    const glm::vec3 dim = neutralToneMap(glm::vec3(0.5f, 0, 0));
    EXPECT_NEAR(dim.x, 0.5f, 1e-6f);
    EXPECT_NEAR(dim.y, 0.0f, 1e-6f);
    // AgX: middle grey is half of the display's scale, black and 16.3 its ends. Wrensch's
    // polynomial of degree 6 over the 16.5 stops fits the same sigmoid within 0.006.
    const auto agx = [](float x) { return agxToneMap(glm::vec3(x)).x; };
    EXPECT_NEAR(agx(0.18f), std::pow(0.5, 2.2), 1e-3);
    EXPECT_NEAR(agx(0.0f), 0.0f, 1e-9f);
    EXPECT_NEAR(agx(16.3f), 1.0f, 1e-4f);
    for (double stops = -12.4; stops < 4; stops += 0.1) {
        const double x = (stops + 12.47393) / (4.026069 + 12.47393);
        const double fit = 15.5 * std::pow(x, 6) - 40.14 * std::pow(x, 5) + 31.96 * std::pow(x, 4) -
                           6.868 * std::pow(x, 3) + 0.4298 * x * x + 0.1191 * x - 0.00232;
        EXPECT_NEAR(agxChannel(static_cast<float>(std::exp2(stops))), fit, 0.006) << stops;
    }
    const glm::vec3 brightAgx = agxToneMap(glm::vec3(20, 0, 0));
    EXPECT_GT(brightAgx.y, 0.5f);
    EXPECT_NEAR(brightAgx.y, brightAgx.z, 1e-3f);
    // Monotone, and the shader runs the same lines.
    TonemapPass pass;
    float lastAces = -1, lastNeutral = -1, lastAgx = -1;
    for (int i = 0; i <= 40; ++i) {
        const float x = std::exp2(static_cast<float>(i) / 4 - 7);
        EXPECT_GE(acesChannel(x), lastAces);
        EXPECT_GE(neutral(x), lastNeutral);
        EXPECT_GT(agx(x), lastAgx);
        lastAces = acesChannel(x);
        lastNeutral = neutral(x);
        lastAgx = agx(x);
        EXPECT_NEAR(meanShown(pass, x, ToneMap::aces), 255 * srgbChannel(lastAces), 0.05) << x;
        EXPECT_NEAR(meanShown(pass, x, ToneMap::neutral), 255 * srgbChannel(lastNeutral), 0.05)
            << x;
        EXPECT_NEAR(meanShown(pass, x, ToneMap::agx), 255 * srgbChannel(lastAgx), 0.05) << x;
    }
}

// A dark gradient of a level in 64 pixels: without dither it would have a step there.
TEST_F(TonemapTest, GradientsHaveNoSteps) {
    TonemapPass pass;
    constexpr int kColumns = 512, kRows = 8;
    const auto level = [](int x) { return 40 + (x + 0.5) / 64; };
    std::vector<float> rgba;
    for (int i = 0; i < kColumns * kRows; ++i) {
        const auto linear = linearFromSrgbChannel(static_cast<float>(level(i % kColumns) / 255));
        rgba.insert(rgba.end(), {linear, linear, linear, 1});
    }
    gl::Texture display;
    pass.render(texture(kColumns, kRows, rgba), {0, ToneMap::none, DebugView::final}, *profiler,
                display);
    const auto bytes = display.readBytes(4);
    constexpr int kBlock = 8;
    for (int block = 0; block < kColumns; block += kBlock) {
        double shown = 0, meant = 0;
        for (int y = 0; y < kRows; ++y) {
            for (int x = block; x < block + kBlock; ++x) {
                const auto at = static_cast<std::size_t>(4 * (y * kColumns + x));
                shown += bytes[at];
                meant += level(x);
                EXPECT_NEAR(bytes[at], level(x), 1);
                EXPECT_EQ(bytes[at], bytes[at + 2]);
            }
        }
        EXPECT_NEAR(shown, meant, 0.1 * kBlock * kRows) << block;
    }
}

TEST_F(TonemapTest, LightAddsUpAsTheViewAsks) {
    ComposePass pass;
    const GBuffer g =
        gbuffer(3, 2, {0.1f, 0.2f, 0.3f, 1}, {0, 1, 0, 0.7f}, {0.5f, 0.25f, 1, 1}, {1, 2, 3, 1});
    const gl::Texture direct = constant(3, 2, {10, 20, 30, 1}),
                      e = constant(3, 2, {kPi, kPi, kPi, 1}),
                      raw = constant(3, 2, {2 * kPi, 0, 0, 1}),
                      share = constant(3, 2, {0.25f, 0, 0, 0});
    const ComposePass::Input all{&g, &direct, &e, &raw, &share};
    const auto composed = [&](DebugView view, const ComposePass::Input& input) {
        gl::Texture radiance;
        pass.render(input, view, *profiler, radiance);
        const std::vector<float> c = radiance.readFloats(4);
        EXPECT_EQ(c.size(), 24u);
        for (std::size_t i = 4; i < c.size(); ++i) EXPECT_EQ(c[i], c[i - 4]);
        return glm::vec3(c[0], c[1], c[2]);
    };
    const auto near = [](glm::vec3 a, glm::vec3 b) { return glm::length(a - b) < 1e-4f; };
    EXPECT_TRUE(near(composed(DebugView::final, all), {11.5f, 22.25f, 34}));
    EXPECT_TRUE(near(composed(DebugView::nan, all), {11.5f, 22.25f, 34}));
    EXPECT_TRUE(near(composed(DebugView::direct, all), {11, 22, 33}));
    EXPECT_TRUE(near(composed(DebugView::indirect, all), {0.5f, 0.25f, 1}));
    EXPECT_TRUE(near(composed(DebugView::unfiltered, all), {12, 22, 33}));
    EXPECT_TRUE(near(composed(DebugView::normals, all), {0, 1, 0}));
    EXPECT_TRUE(near(composed(DebugView::albedo, all), {0.5f, 0.25f, 1}));
    EXPECT_TRUE(near(composed(DebugView::depth, all), {0.7f, 0.7f, 0.7f}));
    EXPECT_TRUE(near(composed(DebugView::candidates, all), {0.25f, 0.25f, 0.25f}));
    // What is not there is black.
    EXPECT_TRUE(
        near(composed(DebugView::final, {&g, &direct, nullptr, nullptr, nullptr}), {11, 22, 33}));
    EXPECT_TRUE(
        near(composed(DebugView::final, {&g, nullptr, nullptr, nullptr, nullptr}), {1, 2, 3}));
    // Without a surface there is emission alone, whatever else the textures hold.
    const GBuffer empty = gbuffer(3, 2, {0, 0, 0, 0}, {kNan, 0, 0, 0}, {1, 1, 1, 0}, {4, 5, 6, 1});
    const gl::Texture bad = constant(3, 2, {kNan, kNan, kNan, 1});
    EXPECT_TRUE(near(composed(DebugView::final, {&empty, &bad, &bad, &bad, &bad}), {4, 5, 6}));
    EXPECT_TRUE(near(composed(DebugView::normals, {&empty, &bad, &bad, &bad, &bad}), {0, 0, 0}));
    expectNoGlErrors();
}

TEST_F(TonemapTest, ConstantFurnaceGivesItsRadianceEverywhere) {
    // Albedo 1 in a uniform field of radiance L has E = pi L and must show L.
    ComposePass pass;
    const GBuffer g = gbuffer(17, 5, {0, 0, 0, 1}, {0, 1, 0, 1}, {1, 1, 1, 1}, {0, 0, 0, 0});
    const gl::Texture e = constant(17, 5, glm::vec4(0.375f * kPi));
    gl::Texture radiance;
    pass.render({&g, nullptr, &e, nullptr, nullptr}, DebugView::final, *profiler, radiance);
    for (const float x : radiance.readFloats(3)) EXPECT_NEAR(x, 0.375f, 1e-6f);
}

TEST_F(TonemapTest, EveryBadTexelIsCounted) {
    BadPixelsPass pass;
    gl::ReadBack counts("bad pixels", gl::Results::waited);
    const auto countBad = [&](const gl::Texture& picture) {
        pass.count(picture, counts);
        return BadPixelsPass::take(counts).value();
    };
    for (const auto& [w, h] : {std::pair(1, 1), std::pair(255, 1), std::pair(256, 1),
                               std::pair(257, 1), std::pair(97, 61)}) {
        std::vector<float> rgba(static_cast<std::size_t>(4 * w * h), 1.0f);
        EXPECT_EQ(countBad(texture(w, h, rgba)), 0u);
        std::uint64_t bad = 0;
        for (std::size_t i = 0; i < rgba.size() / 4; i += 7) {
            const float values[] = {kNan, kInf, -kInf, std::numeric_limits<float>::max(), 1e-42f};
            rgba[4 * i + i % 3] = values[i % 5];
            bad += i % 5 < 3;
        }
        EXPECT_EQ(countBad(texture(w, h, rgba)), bad) << w << " x " << h;
    }
    gl::Texture display;
    TonemapPass().render(texture(2, 1, {kNan, 0, 0, 1, 1, 1, 1, 1}),
                         {0, ToneMap::none, DebugView::nan}, *profiler, display);
    const std::vector<std::uint8_t> expected = {255, 0, 0, 255, 102, 102, 102, 255};
    EXPECT_EQ(display.readBytes(4), expected);
    expectNoGlErrors();
}

TEST_F(TonemapTest, ExposureBringsTheLogMeanToMiddleGrey) {
    const GBuffer g = gbuffer(4, 4, {0, 0, 0, 1}, {}, {}, {0, 0, 0, 0});
    for (const float c : {0.18f, 1.0f, 1e-3f, 5e4f}) {
        EXPECT_NEAR(fitExposure(constant(4, 4, {c, c, c, 1}), g, ToneMap::aces).value(),
                    std::log2(0.18 / c), 1e-5);
    }
    EXPECT_FALSE(fitExposure(constant(4, 4, {0, 0, 0, 1}), g, ToneMap::aces));
    EXPECT_FALSE(fitExposure(constant(4, 4, {kNan, kInf, 0, 1}), g, ToneMap::aces));
    // The log mean of 1 and 4 is 2; NaN, black, emitters and the void do not count.
    std::vector<float> mixed(64, 0.0f);
    for (std::size_t i = 0; i < 3; ++i) {
        mixed[i] = 1;
        mixed[4 + i] = 4;
        mixed[8 + i] = kNan;
    }
    EXPECT_NEAR(fitExposure(texture(4, 4, mixed), g, ToneMap::aces).value(), std::log2(0.09), 1e-5);
    const GBuffer emitter = gbuffer(4, 4, {0, 0, 0, 1}, {}, {}, {1, 0, 0, 0});
    EXPECT_FALSE(fitExposure(constant(4, 4, {1, 1, 1, 1}), emitter, ToneMap::aces));
    const GBuffer nothing = gbuffer(4, 4, {0, 0, 0, 0}, {}, {}, {0, 0, 0, 0});
    EXPECT_FALSE(fitExposure(constant(4, 4, {1, 1, 1, 1}), nothing, ToneMap::aces));
}

TEST_F(TonemapTest, DarkIsWhatWouldReflectLight) {
    const glm::vec4 surface(0, 0, 0, 1), nowhere(0), white(1), black(0, 0, 0, 1), glow(1, 0, 0, 0);
    EXPECT_TRUE(isDark({}, gbuffer(2, 2, surface, {}, white, nowhere)));
    EXPECT_FALSE(isDark({}, gbuffer(2, 2, surface, {}, white, glow)));
    EXPECT_FALSE(isDark({}, gbuffer(2, 2, surface, {}, black, nowhere)));
    EXPECT_FALSE(isDark({}, gbuffer(2, 2, nowhere, {}, nowhere, nowhere)));
    const GBuffer lit = gbuffer(2, 2, surface, {}, white, nowhere);
    EXPECT_FALSE(isDark(10, lit));
    EXPECT_TRUE(isDark(30, lit));
}

TEST_F(TonemapTest, ExposureLeavesAtMostTwoPercentWhite) {
    const GBuffer g = gbuffer(10, 20, {0, 0, 0, 1}, {}, {}, {0, 0, 0, 0});
    const auto fitted = [&](std::size_t bright, ToneMap toneMap = ToneMap::aces) {
        std::vector<float> rgba(800, 0.01f);
        std::fill(rgba.begin(), rgba.begin() + static_cast<std::ptrdiff_t>(4 * bright), 8.0f);
        return fitExposure(texture(10, 20, rgba), g, toneMap).value();
    };
    // 200 texels: four may be white, whatever their light; the fifth must not.
    EXPECT_GT(8 * std::exp2(fitted(4)), 2.5);
    EXPECT_NEAR(8 * std::exp2(fitted(5)), 2.5, 1e-4);
    EXPECT_NEAR(8 * std::exp2(fitted(20)), 2.5, 1e-4);
    // White is what the tone map makes of it.
    const auto brightest = [&](ToneMap toneMap) {
        return glm::vec3(static_cast<float>(8 * std::exp2(fitted(5, toneMap))));
    };
    EXPECT_NEAR(brightest(ToneMap::none).x, 0.94f, 1e-3f);
    EXPECT_NEAR(acesToneMap(brightest(ToneMap::aces)).x, 0.94f, 0.005f);
    EXPECT_NEAR(neutralToneMap(brightest(ToneMap::neutral)).x, 0.94f, 0.005f);
    EXPECT_NEAR(agxToneMap(brightest(ToneMap::agx)).x, 0.94f, 0.005f);
    // Light all over sets its own exposure.
    EXPECT_NEAR(8 * std::exp2(fitted(200)), 0.18, 1e-4);
}

TEST_F(TonemapTest, ExposureShowsTheWhiteBeforeAWideSkyWhite) {
    // Four texels of nine show a surface of 0.1, the others a sky of 0.1, or the room around.
    const auto fitted = [&](float albedo, bool sky) {
        GBuffer g = gbuffer(3, 3, {0, 0, 0, 1}, {}, {albedo, albedo, albedo, 1}, {0, 0, 0, 0});
        std::vector<float> places(36, 0.0f);
        for (std::size_t i = 0; i < (sky ? 4 : 9); ++i) places[4 * i + 3] = 1;
        g.position = texture(3, 3, places);
        return fitExposure(constant(3, 3, {0.1f, 0.1f, 0.1f, 1}), g, ToneMap::agx).value();
    };
    const double grey = std::log2(0.18 / 0.1);
    EXPECT_NEAR(fitted(0.2f, true), grey, 1e-4);
    EXPECT_NEAR(fitted(0.6f, true), grey + std::log2(1.5), 1e-3);
    EXPECT_NEAR(fitted(1.0f, true), grey + 1, 1e-4);
    EXPECT_NEAR(fitted(1.0f, false), grey, 1e-4) << "a white room";
}

TEST_F(TonemapTest, ExposureShowsTheDarkBeforeAWideSkyDark) {
    // Of nine texels, so many show a surface of 0.01, the others a sky of 0.5.
    const auto fitted = [&](std::size_t surfaces) {
        GBuffer g = gbuffer(3, 3, {0, 0, 0, 0}, {}, {}, {0, 0, 0, 0});
        std::vector<float> places(36, 0.0f), rgba(36, 0.5f);
        for (std::size_t i = 0; i < surfaces; ++i) {
            places[4 * i + 3] = 1;
            std::fill_n(rgba.begin() + static_cast<std::ptrdiff_t>(4 * i), 4, 0.01f);
        }
        g.position = texture(3, 3, places);
        return fitExposure(texture(3, 3, rgba), g, ToneMap::agx).value();
    };
    EXPECT_NEAR(fitted(6), std::log2(0.18 / 0.01), 1e-4) << "a third of sky is a window";
    EXPECT_NEAR(fitted(5), std::log2(0.18 / 0.5) + 2.5, 1e-4);
    EXPECT_NEAR(fitted(1), fitted(5), 1e-4);
}

TEST_F(TonemapTest, DataViewsAreShownAsTheyAre) {
    TonemapPass pass;
    const auto show = [&](DebugView view, glm::vec3 value) {
        gl::Texture display;
        pass.render(constant(1, 1, glm::vec4(value, 1)), {5, ToneMap::aces, view}, *profiler,
                    display);
        return display.readBytes(3);
    };
    using Rgb = std::vector<std::uint8_t>;
    EXPECT_EQ(show(DebugView::normals, {0, 1, -1}), (Rgb{128, 255, 0}));
    EXPECT_EQ(show(DebugView::normals, {0, 0, 0}), (Rgb{0, 0, 0}));
    EXPECT_EQ(show(DebugView::albedo, {0.5f, 1, 0}), (Rgb{188, 255, 0}));
    EXPECT_EQ(show(DebugView::shared, {0.5f, 1, 0}), (Rgb{188, 255, 0}));
    // Scales go from one end of their legend to the other; 0 is nothing.
    for (const DebugView view : {DebugView::depth, DebugView::candidates, DebugView::sharing}) {
        const DebugLegend& legend = legendOf(view);
        ASSERT_EQ(legend.kind, LegendKind::scale);
        const bool grey = legend.colours == ColourMap::grey;
        const auto at = [&](double x) {
            return show(view, glm::vec3(static_cast<float>(x), 0, 0));
        };
        EXPECT_EQ(at(0), (Rgb{0, 0, 0}));
        EXPECT_EQ(at(legend.high), at(legend.high * 2));
        EXPECT_NE(at(legend.high), at(legend.low + 1e-7));
        for (const double value : {legend.low + 1e-7, 0.011, 0.02, 0.25, 0.5, 1.5, 3.0, 20.0}) {
            const double share =
                legend.logarithmic
                    ? std::log(value / legend.low) / std::log(legend.high / legend.low)
                    : (value - legend.low) / (legend.high - legend.low);
            const auto position = static_cast<float>(std::clamp(share, 0.0, 1.0));
            const glm::vec3 expected = grey ? glm::vec3(position) : viridis(position);
            const Rgb shown = at(value);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(shown[static_cast<std::size_t>(c)], 255 * expected[c], 1.01) << value;
            }
        }
    }
}

}  // namespace
}  // namespace mv
