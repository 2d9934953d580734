// Light that is remembered from frame to frame: what a moving camera gains, what a moving light
// does not spoil, and when nothing may be remembered.

#include <functional>
#include <utility>

#include "gpu/frame_fixture.h"

namespace mv {
namespace {

using test::FrameTest;

class History : public FrameTest {
  protected:
    void SetUp() override {
        FrameTest::SetUp();
        settings.picture.view = DebugView::indirect;
        settings.gather.filter = false;
        settings.gather.history = 16;
        input.moving = true;
        settings.gather.clampDistance = 0.25;  // no rare bright samples
    }
    static double meanSquare(const std::vector<float>& a, const std::vector<float>& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            const double d = double{a[i]} - double{b[i]};
            sum += d * d;
        }
        return sum / static_cast<double>(a.size());
    }
    // A step sideways and a small turn: a pixel or two each.
    void moveCamera() {
        input.camera.position.x += 0.004f;
        input.camera.forward = glm::normalize(input.camera.forward + glm::vec3(0.004f, 0.002f, 0));
    }
    // Of a frame that stands alone and of the one that remembers, of the same moment.
    struct Errors {
        double alone, remembered;
    };
    Errors errorsNow() {
        const auto remembered = radiance();
        Settings one = settings;
        one.gather.history = 0;
        FrameRenderer other;
        other.setScene(scene(), bvh(), hierarchy());
        FrameStatistics statistics;
        other.render(one, input, statistics);
        const auto alone = other.radiance().readFloats(4);
        one.gather.samples = 0;
        other.render(one, input, statistics);
        const auto exact = other.radiance().readFloats(4);
        return {meanSquare(alone, exact), meanSquare(remembered, exact)};
    }
};

TEST_F(History, FirstFrameIsThatWithoutIt) {
    render();
    const auto first = radiance();
    startAfresh();
    settings.gather.history = 0;
    render();
    EXPECT_EQ(radiance(), first);
}

TEST_F(History, MovingCameraGathersEverMoreSamples) {
    for (const int scale : {1, 2}) {
        startAfresh();
        settings.gather.cull.scale = scale;
        for (int i = 0; i < 10; ++i) {
            moveCamera();
            render();
        }
        const Errors errors = errorsNow();
        // Ten sets; at the border and behind edges fewer, and pixels are interpolated.
        EXPECT_LT(errors.remembered, (scale == 1 ? 0.25 : 0.4) * errors.alone) << scale;
    }
}

// Drafts of a moving camera: once four frames are remembered most of the picture rests, which
// leaves more noise than all samples would; light that changes wakes it.
TEST_F(History, WhatRemembersEnoughGathersInTurns) {
    input.gathersInTurns = true;
    input.animation = 0;
    const auto resting = [&] {
        int surfaces = 0, rest = 0;
        for (int i = 0; i < settings.resolution.width * settings.resolution.height; i += 5) {
            const PixelValues pixel =
                renderer->readPixel(i % settings.resolution.width, i / settings.resolution.width);
            surfaces += pixel.surface;
            rest += pixel.surface && pixel.sides[0].unfiltered == glm::vec3(0);
        }
        return static_cast<double>(rest) / surfaces;
    };
    for (int i = 0; i < 12; ++i) {
        moveCamera();
        render();
        if (i < 4) {
            EXPECT_LT(resting(), 0.05) << i << ": dark pixels alone";
        } else {
            EXPECT_GT(resting(), 0.4) << i;
            EXPECT_LT(resting(), 0.9) << i << ": whose turn it is, and what is new";
        }
    }
    const Errors errors = errorsNow();
    EXPECT_LT(errors.remembered, 0.35 * errors.alone);
    input.timeS = 2.5;
    render();
    EXPECT_LT(resting(), 0.05);
    const Errors jump = errorsNow();
    EXPECT_LT(jump.remembered, 1.3 * jump.alone);
}

TEST_F(History, RemembersNoMoreFramesThanAsked) {
    settings.gather.history = 1;
    for (int i = 0; i < 6; ++i) {
        moveCamera();
        render();
    }
    const double one = errorsNow().remembered;
    settings.gather.history = 16;
    startAfresh();
    for (int i = 0; i < 6; ++i) {
        moveCamera();
        render();
    }
    EXPECT_LT(errorsNow().remembered, 0.75 * one);
}

// Slowly, its old samples still help; at a jump they may not spoil the picture.
TEST_F(History, LightThatMovesIsFollowed) {
    input.animation = 0;
    for (int i = 0; i < 8; ++i) {
        input.timeS = i / 30.0;
        render();
    }
    const Errors slow = errorsNow();
    EXPECT_LT(slow.remembered, 0.35 * slow.alone);
    input.timeS = 2.5;
    render();
    const Errors jump = errorsNow();
    EXPECT_LT(jump.remembered, 1.3 * jump.alone);
}

// At rest the memory helps until as many sets are there; then the picture is that of its own sets,
// whatever was before.
TEST_F(History, PictureAtRestForgets) {
    settings.picture.accumulate = 20;
    for (int i = 0; i < 10; ++i) {
        moveCamera();
        render();
    }
    input.moving = false;
    EXPECT_EQ(render().accumulatedFrames, 1);
    const Errors first = errorsNow();
    EXPECT_LT(first.remembered, 0.3 * first.alone);
    while (render().accumulatedFrames < 20) {
    }
    const auto rested = radiance();
    EXPECT_LT(errorsNow().remembered, 0.1 * first.alone);
    startAfresh();
    settings.gather.history = 0;
    while (render().accumulatedFrames < 20) {
    }
    EXPECT_EQ(radiance(), rested);
    // And what it remembers then, the next motion takes.
    settings.gather.history = 16;
    startAfresh();
    while (render().accumulatedFrames < 20) {
    }
    input.moving = true;
    moveCamera();
    render();
    const Errors moved = errorsNow();
    EXPECT_LT(moved.remembered, 0.3 * moved.alone);
}

// A draft's fewer views are of the same light.
TEST_F(History, MoreViewsAreOfTheSameLight) {
    settings.gather.samples = 1;  // so that noise is more than what views differ by
    settings.views.vpls = 800;
    for (int i = 0; i < 8; ++i) render();
    settings.views.vpls = 1600;
    render();
    const Errors errors = errorsNow();
    EXPECT_LT(errors.remembered, 0.6 * errors.alone);
}

TEST_F(History, OtherLightBeginsAnew) {
    const std::vector<std::pair<const char*, std::function<void(Settings&)>>> changes = {
        {"method", [](Settings& s) { setMethod(s, Method::manylods); }},
        {"rules", [](Settings& s) { s.side[0].rules = kPublishedRules; }},
        {"light scale", [](Settings& s) { s.scene.lightScale = 2; }},
        {"sky", [](Settings& s) { s.scene.environment.source = "white"; }},
        {"bounces", [](Settings& s) { s.views.bounces = 1; }},
        {"bias", [](Settings& s) { s.gather.bias = 2; }},
        {"points", [](Settings& s) { s.side[0].ism.points /= 2; }},
        {"history", [](Settings& s) { s.gather.history = 0; }},
    };
    const Settings base = settings;
    for (const auto& [name, change] : changes) {
        startAfresh();
        settings = base;
        if (name == std::string_view("points")) setMethod(settings, Method::ism);
        render();
        render();
        change(settings);
        render();
        const auto after = radiance();
        startAfresh();
        settings.gather.history = 0;
        render();
        // The same views and maps, other samples of them: as noisy as a first frame.
        Settings full = settings;
        full.gather.samples = 0;
        const auto first = radiance();
        render(full);
        const auto exact = radiance();
        EXPECT_GT(meanSquare(after, exact), 0.75 * meanSquare(first, exact)) << name;
    }
}

// A sequence of pictures, each made from nothing else: headless frames.
TEST_F(History, StaysWhereNothingElseIsReused) {
    input.reuse = false;
    render();
    const double one = errorsNow().remembered;
    for (int i = 0; i < 7; ++i) render();
    EXPECT_LT(errorsNow().remembered, 0.2 * one);
    const auto eight = radiance();
    startAfresh();
    for (int i = 0; i < 8; ++i) render();
    EXPECT_EQ(radiance(), eight);
    settings.gather.history = 0;
    render();
    EXPECT_GT(errorsNow().remembered, 0.9 * one);
}

// Pairs that are counted, or a reference that has grown, show the same frame again.
TEST_F(History, AFrameOfASequenceStaysWhatItWas) {
    input.moving = false;
    const FrameCamera from = input.camera;
    for (const bool temporal : {false, true}) {
        settings.picture.temporal = temporal;
        std::vector<float> next[2];
        for (const bool again : {false, true}) {
            startAfresh();
            input.camera = from;
            for (int i = 0; i < 3; ++i) {
                moveCamera();
                input.reuse = input.countLevels = false;
                render();
                const auto shown = radiance();
                input.reuse = true;
                for (const bool counts : {true, false}) {
                    if (!again) break;
                    input.countLevels = counts;
                    render();
                    EXPECT_EQ(radiance(), shown);
                }
                next[again] = shown;
            }
        }
        EXPECT_EQ(next[1], next[0]) << "what it remembers";
    }
}

// They average sets of their own, and nothing else.
TEST_F(History, PicturesOfSeveralSetsStandAlone) {
    settings.picture.accumulate = 4;
    const auto picture = [&] {
        startAfresh();
        for (int i = 0; i < 2; ++i) {
            input.reuse = false;
            moveCamera();
            render();
            input.reuse = true;
            while (render().accumulatedFrames < 4) {
            }
        }
        return radiance();
    };
    input.moving = false;
    const FrameCamera from = input.camera;
    const auto remembering = picture();
    settings.gather.history = 0;
    input.camera = from;
    EXPECT_EQ(picture(), remembering);
}

TEST_F(History, WithoutAnyLightThereIsNone) {
    settings.scene.lightScale = 0;
    settings.picture.accumulate = 4;
    for (const bool moving : {true, false}) {
        input.moving = moving;
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(render().viewsAlive, 0u);
            const auto black = radiance();
            for (std::size_t k = 0; k < black.size(); k += 4) {
                ASSERT_EQ(black[k] + black[k + 1] + black[k + 2], 0) << k;
            }
        }
    }
}

TEST_F(History, SidesOfAComparisonTakeTheSameSamples) {
    settings.compare = true;  // with itself
    for (int i = 0; i < 12; ++i) {
        moveCamera();
        render();
    }
    EXPECT_EQ(renderer->radianceOf(0).readFloats(4), renderer->radianceOf(1).readFloats(4));
}

}  // namespace
}  // namespace mv
