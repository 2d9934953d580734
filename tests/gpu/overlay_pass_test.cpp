// OverlayPass: where lines appear, what hides them, and that they are clipped as they should be.

#include "renderer/passes/overlay_pass.h"

#include <chrono>
#include <cmath>
#include <random>

#include "gl/gl_fixture.h"
#include "support/synthetic.h"

namespace mv {
namespace {

constexpr int kWidth = 120, kHeight = 80;
constexpr std::uint32_t kRed = rgba(255, 0, 0);
constexpr int kBackground = 51;

class OverlayTest : public GlTest {
  protected:
    void SetUp() override {
        GlTest::SetUp();
        if (IsSkipped()) return;
        profiler = std::make_unique<gl::Profiler>();
        pass = std::make_unique<OverlayPass>();
        display = gl::Texture("display", GL_TEXTURE_2D, GL_RGBA8, kWidth, kHeight);
        std::vector<std::uint8_t> grey(std::size_t{4} * kWidth * kHeight, kBackground);
        display.writeBytes(4, grey);
        setDepth(0);
    }
    void TearDown() override {
        out = {};
        display = {};
        depth = {};
        pass.reset();
        profiler.reset();
        GlTest::TearDown();
    }
    // A surface in front of every pixel, as reversed depth; 0 = none.
    void setDepth(float value) {
        depth = gl::Texture("depth", GL_TEXTURE_2D, GL_DEPTH_COMPONENT32F, kWidth, kHeight);
        glClearTexImage(depth.id(), 0, GL_DEPTH_COMPONENT, GL_FLOAT, &value);
    }
    void draw(const std::vector<Line>& lines, const FrameCamera& camera,
              const OverlayOptions& options = {}) {
        pass->draw(lines, camera, depth, options, *profiler, display, out);
        if (out) bytes = out.readBytes(4);
    }
    static FrameCamera perspective() {
        FrameCamera c;
        c.position = {0.5f, 0.5f, 1.5f};
        c.yfovRad = 1.0f;
        return c;
    }
    static FrameCamera orthographic() {
        FrameCamera c = perspective();
        c.orthoHalfHeight = 0.5f;
        return c;
    }
    static glm::vec2 pixelOf(const FrameCamera& camera, glm::vec3 p) {
        const glm::vec4 clip =
            camera.clipFromWorld(static_cast<float>(kWidth) / kHeight) * glm::vec4(p, 1);
        return (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * glm::vec2(kWidth, kHeight);
    }
    int red(int x, int y) const { return byteAt(x, y, 0); }
    int byteAt(int x, int y, int channel) const {
        return bytes[static_cast<std::size_t>((y * kWidth + x) * 4 + channel)];
    }
    // The reddest of the pixels around a point.
    int redNear(glm::vec2 p) const {
        int most = 0;
        for (int dy = -1; dy <= 1; ++dy) {
            for (int dx = -1; dx <= 1; ++dx) {
                const int x = static_cast<int>(p.x) + dx, y = static_cast<int>(p.y) + dy;
                if (x >= 0 && y >= 0 && x < kWidth && y < kHeight) most = std::max(most, red(x, y));
            }
        }
        return most;
    }
    int drawnPixels() const {
        int count = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) count += red(x, y) != kBackground;
        return count;
    }

    std::unique_ptr<gl::Profiler> profiler;
    std::unique_ptr<OverlayPass> pass;
    gl::Texture display, depth, out;
    std::vector<std::uint8_t> bytes;
};

TEST_F(OverlayTest, DrawsNothingAndKeepsNothingForNoLines) {
    draw({}, perspective());
    EXPECT_FALSE(out);
    EXPECT_EQ(pass->bytes(), 0u);
    draw({{{0.2f, 0.5f, 0.5f}, {0.8f, 0.5f, 0.5f}, kRed}}, perspective());
    EXPECT_TRUE(out);
    EXPECT_GT(pass->bytes(), 0u);
    draw({}, perspective());
    EXPECT_FALSE(out);
    EXPECT_EQ(pass->bytes(), 0u);
    expectNoGlErrors();
}

TEST_F(OverlayTest, LinesAppearWhereTheirPointsProject) {
    std::mt19937 random(1);
    const auto coordinate = [&] { return testing::randomIn(random, 0.3f, 0.7f); };
    for (const FrameCamera& camera : {perspective(), orthographic()}) {
        for (int k = 0; k < 40; ++k) {
            const glm::vec3 a(coordinate(), coordinate(), coordinate());
            const glm::vec3 b(coordinate(), coordinate(), coordinate());
            draw({{a, b, kRed}}, camera);
            const float length = glm::distance(pixelOf(camera, a), pixelOf(camera, b));
            if (length < 4) continue;
            for (const float t : {0.1f, 0.3f, 0.5f, 0.7f, 0.9f}) {
                EXPECT_GT(redNear(pixelOf(camera, a + (b - a) * t)), 170) << "line " << k;
            }
            // About as many pixels as it is long and wide, none elsewhere.
            EXPECT_GT(drawnPixels(), 0.8f * length);
            EXPECT_LT(drawnPixels(), 3.2f * length + 12);
        }
    }
    expectNoGlErrors();
}

TEST_F(OverlayTest, ColoursAreWrittenAsTheyAreAndTheRestIsKept) {
    const FrameCamera camera = perspective();
    draw({{{0.1f, 0.5f, 0.5f}, {0.9f, 0.5f, 0.5f}, rgba(10, 200, 90)}}, camera, {5, 0.25f});
    const glm::vec2 p = pixelOf(camera, {0.5f, 0.5f, 0.5f});
    const int x = static_cast<int>(p.x), y = static_cast<int>(p.y);
    EXPECT_EQ(byteAt(x, y, 0), 10);
    EXPECT_EQ(byteAt(x, y, 1), 200);
    EXPECT_EQ(byteAt(x, y, 2), 90);
    EXPECT_EQ(byteAt(x, y, 3), 255);
    EXPECT_EQ(byteAt(x, y + 12, 0), kBackground);
    EXPECT_EQ(byteAt(x, y + 12, 1), kBackground);
}

TEST_F(OverlayTest, WidthIsInPixels) {
    const FrameCamera camera = orthographic();
    const std::vector<Line> line = {{{0, 0.5f, 0.5f}, {1, 0.5f, 0.5f}, kRed}};
    for (const float width : {1.0f, 2.0f, 4.0f, 8.0f}) {
        draw(line, camera, {width, 0.25f});
        double covered = 0;
        for (int y = 0; y < kHeight; ++y) {
            covered += (red(60, y) - kBackground) / (255.0 - kBackground);
        }
        EXPECT_NEAR(covered, static_cast<double>(width), 0.35) << width;
    }
}

TEST_F(OverlayTest, WhatASurfaceHidesIsDimmed) {
    // Perspective: reversed depth near / distance. The surface is at distance 1.
    const auto shown = [&](const FrameCamera& camera, float z) {
        draw({{{0.2f, 0.5f, z}, {0.8f, 0.5f, z}, kRed}}, camera, {4, 0.25f});
        return red(kWidth / 2, kHeight / 2);
    };
    const int dimmed = kBackground + (255 - kBackground) / 4;
    setDepth(kNearPlane / 1.0f);
    EXPECT_EQ(shown(perspective(), 0.6f), 255);
    EXPECT_NEAR(shown(perspective(), 0.4f), dimmed, 2);
    EXPECT_EQ(shown(perspective(), 0.5f), 255) << "in the surface";
    const FrameCamera ortho = orthographic();
    const float far = glm::length(ortho.position - glm::vec3(0.5f)) + 1;
    setDepth(1 - 1.0f / far);
    EXPECT_EQ(shown(ortho, 0.6f), 255);
    EXPECT_NEAR(shown(ortho, 0.4f), dimmed, 2);
    EXPECT_EQ(shown(ortho, 0.5f), 255) << "in the surface";
    setDepth(0);
    EXPECT_EQ(shown(ortho, 0.1f), 255) << "no surface";
}

TEST_F(OverlayTest, TheNearestLineIsSeenWhateverTheirOrder) {
    const FrameCamera camera = perspective();
    const Line nearer{{0.5f, 0.2f, 0.8f}, {0.5f, 0.8f, 0.8f}, rgba(0, 255, 0)};
    const Line farther{{0.2f, 0.5f, 0.3f}, {0.8f, 0.5f, 0.3f}, kRed};
    setDepth(kNearPlane / 1.0f);  // between them: the farther is hidden and dim
    draw({nearer, farther}, camera, {3, 0.25f});
    const auto first = bytes;
    draw({farther, nearer}, camera, {3, 0.25f});
    EXPECT_EQ(bytes, first);
    EXPECT_EQ(byteAt(kWidth / 2, kHeight / 2, 1), 255);
    EXPECT_EQ(byteAt(kWidth / 2, kHeight / 2, 0), 0);
}

TEST_F(OverlayTest, LinesThatPassTheCameraAreClippedAtIt) {
    const FrameCamera camera = perspective();  // at z = 1.5, looking along -z
    // From in front of the camera to far behind it: its picture goes from its end straight out of
    // the picture, on its own side.
    draw({{{0.6f, 0.5f, 0.5f}, {0.6f, 0.5f, 4.0f}, kRed}}, camera);
    const glm::vec2 start = pixelOf(camera, {0.6f, 0.5f, 0.5f});
    for (int x = static_cast<int>(start.x) + 1; x < kWidth; ++x) {
        EXPECT_GT(redNear({static_cast<float>(x), start.y}), 170) << x;
    }
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < static_cast<int>(start.x) - 2; ++x) {
            ASSERT_EQ(red(x, y), kBackground) << x << ' ' << y;
        }
    }
    // Wholly behind, through the camera itself, without length, not a number: nothing breaks.
    draw({{{0.3f, 0.5f, 1.6f}, {0.7f, 0.5f, 3.0f}, kRed}}, camera);
    EXPECT_EQ(drawnPixels(), 0);
    draw({{{0.5f, 0.5f, 1.5f}, {0.5f, 0.5f, 1.5f}, kRed}}, camera);
    EXPECT_EQ(drawnPixels(), 0);
    draw({{camera.position, {0.5f, 0.5f, 0.5f}, kRed}}, camera);
    EXPECT_LT(drawnPixels(), 20);
    draw({{glm::vec3(std::nanf("")), {0.5f, 0.5f, 0.5f}, kRed}}, camera);
    // A box around everything, the camera inside.
    std::vector<Line> box;
    appendBox(glm::vec3(0.5f), glm::vec3(10, 20, 20), kRed, box);
    draw(box, camera);
    EXPECT_GT(drawnPixels(), 0);
    expectNoGlErrors();
}

TEST_F(OverlayTest, AHundredThousandLines) {
    std::mt19937 random(2);
    std::vector<Line> lines;
    while (lines.size() < 100'000) {
        const glm::vec3 a(testing::randomIn(random, 0, 1), testing::randomIn(random, 0, 1),
                          testing::randomIn(random, 0, 1));
        lines.push_back({a, a + testing::randomDirection(random) * 0.02f, kRed});
    }
    draw(lines, perspective());
    const auto first = bytes;
    EXPECT_GT(drawnPixels(), kWidth * kHeight / 10);
    const auto start = std::chrono::steady_clock::now();
    draw(lines, perspective());
    RecordProperty("ms", std::to_string(std::chrono::duration<double, std::milli>(
                                            std::chrono::steady_clock::now() - start)
                                            .count()));
    EXPECT_EQ(bytes, first) << "the same lines give the same picture";
    expectNoGlErrors();
}

}  // namespace
}  // namespace mv
