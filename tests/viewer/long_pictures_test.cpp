// A picture that takes long on a software renderer: the window lives on, and it can be given up.

#include <GLFW/glfw3.h>

#include <functional>

#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

// A window: its hand puts something in whenever it is asked.
class LiveScreen : public Screen {
  public:
    bool isAlive() const override { return true; }
    bool poll(int, int) override {
        ++polls;
        if (hand) hand();
        return !closes;
    }
    void present() override {
        ++presented;
        if (onPresent) onPresent();
    }
    std::function<void()> hand, onPresent;
    bool closes = false;
    int polls = 0, presented = 0;
};

class LongPictures : public ViewerTest {
  protected:
    // Long enough to be drawn meanwhile: samples by rays, at every pixel.
    static Settings slow() {
        Settings s = Viewer::smallSettings();
        s.gather.samples = 16;
        s.display.exposureEv = 1;
        s.gather.undecided = Undecided::rays;
        s.picture.accumulate = 1;
        return s;
    }
    void SetUp() override {
        ViewerTest::SetUp();
        if (IsSkipped()) return;
        if (!gl::limits().software) GTEST_SKIP() << "a GPU draws the window between frames";
        options.headless = options.ui = true;
        options.useCache = false;
        options.scene = "builtin:cornell";
        options.playing = false;
        options.given = {"scene-depth", "view-depth",     "vpls",        "view-res",
                         "accumulate",  "gather-samples", "gather-scale"};
        screen.resize(720, 400);
    }
    void open() {
        session = std::make_unique<Session>(options, slow(), screen, 1, "");
        frame();
        while (session->loading()) frame();
    }
    void frame() { session->frame(1.0 / 30, 720, 400, screen.target.id()); }
    void untilStill() {
        for (int i = 0; i < 200 && !session->still(); ++i) frame();
        ASSERT_TRUE(session->still());
    }
    // Other views: a draft, then the whole picture.
    void change() {
        ++session->editSettings().seed;
        frame();
        ASSERT_TRUE(session->picture().isDraft());
    }
    // Once while the next picture is made.
    void meanwhile(const std::function<void()>& action) {
        screen.onPresent = [action, done = false]() mutable {
            if (!std::exchange(done, true)) action();
        };
    }
    void push(int key) {
        session->input().push(KeyChanged{key, 0, true});
        session->input().push(KeyChanged{key, 0, false});
    }
    void click(const char* widget) {
        const auto item = session->interface().findItem(widget);
        ASSERT_TRUE(item) << widget;
        session->input().push(
            MouseMoved{static_cast<double>(item->centerX()), static_cast<double>(item->centerY())});
        session->input().push(MouseButtonChanged{MouseButton::left, true});
        session->input().push(MouseButtonChanged{MouseButton::left, false});
    }
    std::vector<std::uint8_t> picture() const {
        return session->picture().renderer().display().readBytes(4);
    }

    RunOptions options;
    LiveScreen screen;
    std::unique_ptr<Session> session;
};

TEST_F(LongPictures, TheWindowIsDrawnMeanwhileAndSaysHowFarItIs) {
    open();
    untilStill();
    change();
    screen.presented = 0;
    std::vector<std::pair<std::string, float>> told;
    screen.onPresent = [&] {
        const auto& work = session->model().work;
        ASSERT_TRUE(work);
        told.emplace_back(work->stage, work->done);
        EXPECT_GT(work->elapsedS, 0);
        EXPECT_GT(work->wholeS, 0) << "the draft foretells it";
    };
    // Where the mouse is stops nothing.
    screen.hand = [&, x = 0.0]() mutable { session->input().push(MouseMoved{300 + ++x, 200}); };
    frame();
    EXPECT_FALSE(session->picture().isDraft()) << "in one frame";
    EXPECT_GT(screen.presented, 2);
    int within = 0;
    for (const auto& [stage, done] : told) within += stage == "gather" && done > 0 && done < 1;
    EXPECT_GT(within, 1);
    EXPECT_FALSE(session->model().work);
    const auto shown = picture();

    // Nobody followed this one.
    screen.onPresent = screen.hand = {};
    Screen still;
    still.resize(720, 400);
    const Settings same = session->settings();
    session.reset();
    session = std::make_unique<Session>(options, same, still, 1, "");
    frame();
    while (session->loading()) frame();
    for (int i = 0; i < 9 && !session->still(); ++i) frame();
    EXPECT_EQ(picture(), shown);
}

TEST_F(LongPictures, ASceneIsSeenAsADraftFirstAndExposedAsItsWholePicture) {
    Settings automatic = slow();
    automatic.display.exposureEv.reset();
    session = std::make_unique<Session>(options, automatic, screen, 1, "");
    while (!session->picture().shown()) frame();
    EXPECT_TRUE(session->picture().isDraft());
    untilStill();
    EXPECT_FALSE(session->picture().isDraft());
    const double exposure = session->statistics().exposureEv;
    const Settings same = session->settings();
    session.reset();
    Screen still;
    still.resize(720, 400);
    session = std::make_unique<Session>(options, same, still, 1, "");
    while (!session->picture().shown()) frame();
    EXPECT_FALSE(session->picture().isDraft()) << "nobody waits for a picture without a window";
    EXPECT_EQ(session->statistics().exposureEv, exposure);
}

TEST_F(LongPictures, EscKeepsTheDraftUntilTheWholeIsAskedFor) {
    open();
    untilStill();
    change();
    meanwhile([&] { push(GLFW_KEY_ESCAPE); });
    untilStill();
    EXPECT_TRUE(session->model().settled);
    EXPECT_TRUE(session->picture().isDraft());
    EXPECT_FALSE(session->model().work);
    frame();
    EXPECT_TRUE(session->resting()) << "nothing goes on behind it";

    click("work.whole");
    for (int i = 0; i < 4; ++i) frame();
    untilStill();
    EXPECT_FALSE(session->picture().isDraft());
    EXPECT_FALSE(session->model().settled);

    // What moves afterwards begins as ever.
    change();
    meanwhile([&] { push(GLFW_KEY_ESCAPE); });
    untilStill();
    change();
    untilStill();
    EXPECT_FALSE(session->picture().isDraft());
}

TEST_F(LongPictures, EscTakesBackWhatMakesADraftTakeLong) {
    open();
    untilStill();
    const Settings before = session->settings();
    const auto shown = picture();
    // Whatever comes in waits for the draft but Esc.
    session->editSettings().views.vpls = 128;
    screen.hand = [&, once = false]() mutable {
        if (!std::exchange(once, true)) push(GLFW_KEY_P);
    };
    frame();
    EXPECT_TRUE(session->picture().isDraft());
    untilStill();
    EXPECT_EQ(session->model().instrument, ui::Instrument::profiler);
    session->perform(Action::showProfiler);
    session->editSettings() = before;
    frame();
    untilStill();

    session->editSettings().views.vpls = 16384;
    session->editSettings().side[0].method = Method::raster;  // brute force: seconds
    session->input().push(MouseMoved{100, 200});
    session->input().push(Scrolled{0, 2});  // the camera's way is taken back with them
    bool said = false;
    screen.onPresent = [&, pressed = false]() mutable {
        said = said || (session->model().work && session->model().work->draft);
        if (said && !std::exchange(pressed, true)) push(GLFW_KEY_ESCAPE);
    };
    frame();
    EXPECT_TRUE(said);
    untilStill();
    EXPECT_EQ(session->settings().views.vpls, before.views.vpls);
    EXPECT_EQ(session->settings().side[0].method, before.side[0].method);
    EXPECT_FALSE(session->picture().isDraft());
    EXPECT_EQ(picture(), shown);
}

TEST_F(LongPictures, CancelDoesTheSame) {
    open();
    session->editSettings().gather.samples = 64;  // on any machine longer than what needs no word
    untilStill();
    change();
    bool pressed = false;
    screen.onPresent = [&] {
        if (!pressed && session->interface().findItem("work.cancel")) {
            pressed = true;
            click("work.cancel");
        }
    };
    untilStill();
    EXPECT_TRUE(pressed);
    EXPECT_TRUE(session->model().settled);
    EXPECT_TRUE(session->picture().isDraft());
}

TEST_F(LongPictures, WhateverComesInIsDoneAtOnceAndThePictureGoesOn) {
    open();
    untilStill();
    change();
    meanwhile([&] { push(GLFW_KEY_P); });
    frame();
    EXPECT_TRUE(session->picture().isDraft()) << "given up for the key";
    frame();
    EXPECT_EQ(session->model().instrument, ui::Instrument::profiler);
    untilStill();
    EXPECT_FALSE(session->picture().isDraft());
    // The first picture of a scene too, before there is any other.
    meanwhile([&] { push(GLFW_KEY_T); });
    session->openFile("builtin:hairball");
    frame();
    while (session->loading()) frame();
    untilStill();
    EXPECT_EQ(session->model().instrument, ui::Instrument::traversal);
    EXPECT_FALSE(session->picture().isDraft());
}

TEST_F(LongPictures, FramesThatAreMeasuredCanBeEnded) {
    open();
    untilStill();
    session->perform(Action::measureFrames);
    frame();
    meanwhile([&] { push(GLFW_KEY_ESCAPE); });
    for (int i = 0; i < 4; ++i) frame();
    EXPECT_FALSE(session->model().frameRun.running);
    EXPECT_LT(session->model().frameRun.done, 4);
    untilStill();
    EXPECT_FALSE(session->picture().isDraft());
}

TEST_F(LongPictures, AWindowThatClosesWaitsForNothing) {
    open();
    untilStill();
    change();
    screen.polls = 0;
    screen.closes = true;
    frame();
    EXPECT_EQ(screen.polls, 1);
    EXPECT_TRUE(session->picture().isDraft());
}

}  // namespace
}  // namespace mv
