// Soft edges of frames that move: nearer to a picture of many points of each pixel than one frame
// is, sharp, gone where nothing moves, and nobody else's business.

#include <cmath>
#include <utility>

#include "gpu/frame_fixture.h"
#include "renderer/gl/read_back.h"

namespace mv {
namespace {

using test::FrameTest;

class Temporal : public FrameTest {
  protected:
    void SetUp() override {
        FrameTest::SetUp();
        settings.picture.temporal = true;
        settings.gather.history = 16;
        settings.picture.view = DebugView::direct;  // no noise but that of edges
        input.moving = true;
    }
    // Sideways and round by some tenths of a pixel, as a hand moves.
    void moveCamera() {
        input.camera.position.x += 0.0012f;
        input.camera.forward = glm::normalize(input.camera.forward + glm::vec3(0.0015f, 0.001f, 0));
    }
    // The same moment at 32 points of each pixel.
    std::vector<std::uint8_t> truth() const {
        Settings many = settings;
        many.picture.temporal = false;
        many.gather.history = 0;
        many.picture.pixelSamples = 32;
        FrameInput still = input;
        still.moving = false;
        FrameRenderer other;
        other.setScene(scene(), bvh(), hierarchy());
        FrameStatistics statistics;
        while (statistics.accumulatedFrames < 32) other.render(many, still, statistics);
        return other.display().readBytes(4);
    }
    static double meanSquare(const std::vector<std::uint8_t>& a,
                             const std::vector<std::uint8_t>& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(double(a[i]) - double(b[i]), 2);
        return sum / static_cast<double>(a.size());
    }
};

TEST_F(Temporal, MovingEdgesComeNearThoseOfManyPoints) {
    FrameRenderer raw;
    raw.setScene(scene(), bvh(), hierarchy());
    double smooth = 0, rough = 0, crawl = 0, roughCrawl = 0;
    std::vector<std::uint8_t> before, rawBefore, truthBefore;
    for (int frame = 0; frame < 15; ++frame) {
        moveCamera();
        render();
        Settings plain = settings;
        plain.picture.temporal = false;
        FrameStatistics statistics;
        raw.render(plain, input, statistics);
        if (frame < 9) continue;
        const auto want = truth(), one = raw.display().readBytes(4), mean = display();
        smooth += meanSquare(mean, want);
        rough += meanSquare(one, want);
        if (!before.empty()) {
            // What changes from frame to frame beside what should.
            for (std::size_t i = 0; i < want.size(); ++i) {
                const double should = double(want[i]) - truthBefore[i];
                crawl += std::pow(double(mean[i]) - before[i] - should, 2);
                roughCrawl += std::pow(double(one[i]) - rawBefore[i] - should, 2);
            }
        }
        before = mean;
        rawBefore = one;
        truthBefore = want;
    }
    EXPECT_LT(smooth, 0.5 * rough);
    EXPECT_LT(crawl, 0.35 * roughCrawl);
}

TEST_F(Temporal, FirstFrameIsThatOfTheCentres) {
    render();
    const auto first = display();
    settings.picture.temporal = false;
    startAfresh();
    render();
    EXPECT_EQ(display(), first);
}

// Nothing of a place that is no longer looked at, of light that has gone, or of a NaN stays.
TEST_F(Temporal, WhatIsGoneDoesNotStay) {
    for (int i = 0; i < 12; ++i) {
        moveCamera();
        render();
    }
    const auto alone = [&] {
        Settings plain = settings;
        plain.picture.temporal = false;
        FrameRenderer other;
        other.setScene(scene(), bvh(), hierarchy());
        FrameStatistics statistics;
        other.render(plain, input, statistics);
        return other.display().readBytes(4);
    };
    settings.scene.lightScale = 0.2;
    render();
    EXPECT_LT(meanSquare(display(), alone()), 40) << "the light went";
    input.camera.forward = -input.camera.forward;
    render();
    EXPECT_LT(meanSquare(display(), alone()), 40) << "the camera turned round";
}

TEST_F(Temporal, WhatStandsStillIsAsWithout) {
    for (const int points : {1, 4}) {
        settings.picture.pixelSamples = points;
        settings.picture.temporal = true;
        startAfresh();
        input.moving = true;
        for (int i = 0; i < 5; ++i) {
            moveCamera();
            render();
        }
        input.moving = false;
        while (render().accumulatedFrames < points) {
        }
        const auto still = display();
        startAfresh();
        settings.picture.temporal = false;
        while (render().accumulatedFrames < points) {
        }
        EXPECT_EQ(display(), still) << points;
    }
}

TEST_F(Temporal, DataAndDifferencesHaveNoneOfIt) {
    for (const DebugView view : {DebugView::normals, DebugView::depth, DebugView::candidates}) {
        settings.picture.view = view;
        EXPECT_FALSE(settings.smoothsMotion());
        startAfresh();
        for (int i = 0; i < 3; ++i) {
            moveCamera();
            render();
        }
        const auto shown = radiance();
        Settings plain = settings;
        plain.picture.temporal = false;
        startAfresh();
        render(plain);
        EXPECT_EQ(radiance(), shown);
    }
    settings.picture.view = DebugView::final;
    EXPECT_TRUE(settings.smoothsMotion());
    compareWith(settings, Method::none);
    EXPECT_TRUE(settings.smoothsMotion());
    settings.display.difference = Difference::relative;
    EXPECT_FALSE(settings.smoothsMotion());
    settings.display.difference = Difference::off;
    settings.side[1].method = Method::pathtraced;
    EXPECT_FALSE(settings.smoothsMotion());
    settings.compare = false;
    settings.gather.history = 0;
    EXPECT_FALSE(settings.smoothsMotion());
}

// Headless sequences, whose frames take nothing from one another but what is remembered.
TEST_F(Temporal, SequencesHaveItAndKeepItWhileTheyAreCounted) {
    input.moving = false;
    input.reuse = false;
    for (int i = 0; i < 8; ++i) {
        moveCamera();
        render();
    }
    const auto shown = display();
    input.reuse = true;
    input.countLevels = true;
    render();
    EXPECT_EQ(display(), shown);
    input.countLevels = false;
    input.reuse = false;
    startAfresh();
    render();
    EXPECT_GT(meanSquare(display(), shown), 1);
}

TEST_F(Temporal, WaitsForNothing) {
    renderer = std::make_unique<FrameRenderer>(gl::Results::late);
    renderer->setScene(scene(), bvh(), hierarchy());
    render();
    for (int i = 0; i < 8; ++i) {
        glFinish();
        render();
    }
    gl::forgetWaits();
    for (int i = 0; i < 4; ++i) {
        moveCamera();
        glFinish();
        gl::holdResults(true);
        render();
    }
    gl::holdResults(false);
    EXPECT_TRUE(gl::waits().empty());
}

}  // namespace
}  // namespace mv
