// Lines over a frame: they come and go without touching the picture below them.

#include <algorithm>

#include "gpu/frame_fixture.h"
#include "megaviews/inspect/overlay.h"

namespace mv {
namespace {

using test::FrameTest;

bool drewOverlay(const FrameStatistics& statistics) {
    return std::any_of(statistics.stagesOfBothSides.begin(), statistics.stagesOfBothSides.end(),
                       [](const StageTime& stage) { return stage.stage == Stage::overlay; });
}

const std::vector<Line> kDiagonals = {{{0.1f, 0.1f, 0.9f}, {0.9f, 0.9f, 0.1f}, kYellow},
                                      {{0.9f, 0.1f, 0.9f}, {0.1f, 0.9f, 0.1f}, kPurple}};

TEST_F(FrameTest, LinesComeAndGoWithoutTouchingThePicture) {
    render();
    const auto plain = display();
    const auto light = radiance();
    FrameStatistics statistics;
    renderer->drawOverlay({}, 0, statistics);
    EXPECT_FALSE(drewOverlay(statistics));
    EXPECT_EQ(display(), plain);

    renderer->drawOverlay(kDiagonals, 0, statistics);
    EXPECT_TRUE(drewOverlay(statistics));
    const auto lined = display();
    std::size_t changed = 0;
    for (std::size_t i = 0; i < plain.size(); i += 4) {
        changed += !std::equal(plain.begin() + static_cast<std::ptrdiff_t>(i),
                               plain.begin() + static_cast<std::ptrdiff_t>(i + 4),
                               lined.begin() + static_cast<std::ptrdiff_t>(i));
        EXPECT_EQ(lined[i + 3], 255);
    }
    EXPECT_GT(changed, 30u);
    EXPECT_LT(changed, plain.size() / 4 / 5);
    EXPECT_EQ(radiance(), light);

    // Drawn over what is there, not over what was drawn before.
    renderer->drawOverlay({kDiagonals.data(), 1}, 0, statistics);
    EXPECT_NE(display(), lined);
    renderer->drawOverlay(kDiagonals, 0, statistics);
    EXPECT_EQ(display(), lined);
    renderer->drawOverlay({}, 0, statistics);
    EXPECT_EQ(display(), plain);

    // Another picture is shown without them until they are drawn again.
    renderer->drawOverlay(kDiagonals, 0, statistics);
    settings.display.exposureEv = 1;
    render();
    const auto brighter = display();
    settings.display.exposureEv = 0;
    render();
    EXPECT_EQ(display(), plain);
    EXPECT_NE(brighter, plain);
}

TEST_F(FrameTest, LinesThatAreThereAreNotDrawnAgain) {
    const auto draws = [&](std::uint64_t version) {
        FrameStatistics statistics;
        renderer->drawOverlay(kDiagonals, version, statistics);
        return drewOverlay(statistics);
    };
    render();
    EXPECT_TRUE(draws(7));
    const auto lined = display();
    EXPECT_FALSE(draws(7));
    render();  // nothing changed
    EXPECT_FALSE(draws(7));
    EXPECT_EQ(display(), lined);
    EXPECT_TRUE(draws(8));
    EXPECT_TRUE(draws(0));
    EXPECT_TRUE(draws(0));
    EXPECT_TRUE(draws(8));
    input.camera.position.x += 0.01f;
    render();
    EXPECT_TRUE(draws(8));
}

TEST_F(FrameTest, InstrumentsOfTheFramesOwnViewsAreDrawnOverBothSides) {
    compareWith(settings, Method::manylods);
    settings.inspect.showOctree = 4;
    settings.inspect.showViews = true;
    settings.inspect.pickA = 10;
    settings.inspect.pickB = 11;
    settings.inspect.step = 3;
    std::vector<std::vector<std::uint8_t>> pictures;
    for (int run = 0; run < 2; ++run) {
        startAfresh();
        render();
        const auto plain = display();
        const SceneHierarchy hierarchy =
            SceneHierarchy::build(scene(), TriangleBvh::build(scene()), settings.scene.octreeDepth);
        Inspector inspector;
        inspector.setScene(hierarchy);
        inspector.setViews(renderer->readViews().views);
        const Overlay& overlay = inspector.overlay(settings);
        EXPECT_GT(overlay.lines.size(), 500u);
        FrameStatistics statistics;
        renderer->drawOverlay(overlay.lines, overlay.version, statistics);
        pictures.push_back(display());
        for (const bool rightHalf : {false, true}) {
            std::size_t changed = 0;
            for (std::size_t i = 0; i < plain.size(); ++i) {
                const bool right = (i / 4) % 75 >= 38;
                changed += right == rightHalf && plain[i] != pictures.back()[i];
            }
            EXPECT_GT(changed, 300u);
        }
    }
    EXPECT_EQ(pictures[0], pictures[1]);
}

}  // namespace
}  // namespace mv
