// A window's frames, whose results come late: none waits for the GPU, and none shows a picture of
// which pairs are missing.

#include "gpu/frame_fixture.h"
#include "renderer/gl/read_back.h"

namespace mv {
namespace {

class LateFrame : public test::FrameTest {
  protected:
    void SetUp() override {
        FrameTest::SetUp();
        if (IsSkipped()) return;
        startLate();
    }
    void TearDown() override {
        gl::holdResults(false);
        FrameTest::TearDown();
    }
    void startLate() {
        renderer = std::make_unique<FrameRenderer>(gl::Results::late);
        renderer->setScene(scene(), bvh(), hierarchy());
    }
    // A frame as soon as the one before has come back, and before anything of its own has.
    FrameStatistics frame() {
        FrameStatistics statistics;
        glFinish();
        gl::holdResults(true);
        EXPECT_TRUE(renderer->render(settings, input, statistics));
        return statistics;
    }
    FrameStatistics settled() {
        FrameStatistics statistics = frame();
        for (int i = 0; i < 20 && renderer->underWay(); ++i) statistics = frame();
        EXPECT_FALSE(renderer->underWay());
        return statistics;
    }
    void moveCamera() { input.camera.position += 0.01f * input.camera.forward; }
    // What a renderer that waits makes of the same.
    std::vector<std::uint8_t> exactDisplay(FrameStatistics& statistics) const {
        FrameRenderer exact;
        exact.setScene(scene(), bvh(), hierarchy());
        exact.render(settings, input, statistics);
        return exact.display().readBytes(4);
    }
    static std::string waited() {
        std::string text;
        for (const auto& [call, count] : gl::waits()) {
            // Under Workaround::loopLimit rays say that they took too long, which nobody else asks.
            if (call == "buffer, rounds overflow") continue;
            text += call + ": " + std::to_string(count) + "\n";
        }
        return text;
    }
};

TEST_F(LateFrame, NoneButTheFirstWaits) {
    const struct {
        const char* name;
        void (*choose)(Settings&);
    } cases[] = {
        {"lists", [](Settings&) {}},
        {"queue", [](Settings& s) { s.side[0].pairs.traversal = Traversal::queue; }},
        {"published", [](Settings& s) { s.side[0].rules = kPublishedRules; }},
        {"manylods", [](Settings& s) { s.side[0].method = Method::manylods; }},
        {"none", [](Settings& s) { s.side[0].method = Method::none; }},
        {"compared", [](Settings& s) { compareWith(s, Method::manylods); }},
        {"shared maps",
         [](Settings& s) {
             s.views.maps = 24;
             s.gather.undecided = Undecided::rays;
         }},
    };
    const Settings first = settings;
    for (const auto& [name, choose] : cases) {
        settings = first;
        choose(settings);
        startLate();
        settled();
        gl::forgetWaits();
        for (int i = 0; i < 4; ++i) {
            moveCamera();
            frame();
        }
        EXPECT_EQ(waited(), "") << name << ", camera moving";
        gl::forgetWaits();
        for (int i = 0; i < 4; ++i) {
            settings.scene.lightScale *= 1.1;
            frame();
        }
        settled();
        EXPECT_EQ(waited(), "") << name << ", light moving";
    }
}

TEST_F(LateFrame, OnceNothingMovesItIsTheSame) {
    for (const std::int64_t maps : {0, 24}) {
        SCOPED_TRACE(maps);
        settings.views.maps = maps;
        if (maps > 0) settings.gather.undecided = Undecided::rays;
        settled();
        settings.scene.lightScale *= 2;
        moveCamera();
        frame();
        EXPECT_TRUE(renderer->underWay());
        const FrameStatistics late = settled();
        FrameStatistics exact;
        EXPECT_EQ(display(), exactDisplay(exact));
        EXPECT_EQ(late.methods[0].pairs, exact.methods[0].pairs);
        EXPECT_EQ(late.methods[0].occupancy, exact.methods[0].occupancy);
        EXPECT_EQ(late.viewLeaves, exact.viewLeaves);
        EXPECT_EQ(late.badPixels, exact.badPixels);
    }
}

// Whatever changes the light, it comes to rest, and at what a renderer that waits shows.
TEST_F(LateFrame, EveryChangeOfTheLightComesToRest) {
    const struct {
        const char* name;
        void (*change)(Settings&);
    } changes[] = {
        {"white sky", [](Settings& s) { s.scene.environment.source = "white"; }},
        {"its scale", [](Settings& s) { s.scene.environment.scale = 0.5; }},
        {"its turn", [](Settings& s) { s.scene.environment.rotationDeg = 40; }},
        {"no sky", [](Settings& s) { s.scene.environment.source = "none"; }},
        {"seed", [](Settings& s) { s.seed = 5; }},
        {"views", [](Settings& s) { s.views.vpls = 300; }},
        {"bounces", [](Settings& s) { s.views.bounces = 2; }},
        {"particles", [](Settings& s) { s.views.particles = 100; }},
    };
    settled();
    for (const auto& [name, change] : changes) {
        SCOPED_TRACE(name);
        change(settings);
        settled();
        FrameStatistics exact;
        EXPECT_EQ(display(), exactDisplay(exact));
        const std::uint64_t views = renderer->viewsVersion();
        frame();
        EXPECT_EQ(renderer->viewsVersion(), views);
    }
}

TEST_F(LateFrame, APictureThatLacksPairsIsNeverShown) {
    settings.side[0].pairs.queueMemoryMiB = 1;
    settings.side[0].pairs.size = 0.35;
    ASSERT_EQ(settled().methods[0].passes.made, 1u);
    const std::vector<std::uint8_t> before = display();
    settings.views.vpls = 2000;
    FrameStatistics exact;
    const std::vector<std::uint8_t> after = exactDisplay(exact);
    ASSERT_GT(exact.methods[0].passes.made, 1u);  // so that the first attempt overflows
    ASSERT_NE(before, after);
    bool changed = false;
    for (int i = 0; i < 20; ++i) {
        const FrameStatistics statistics = frame();
        const std::vector<std::uint8_t> shown = display();
        changed = changed || shown != before;
        ASSERT_EQ(shown, changed ? after : before) << i;
        if (!renderer->underWay()) {
            EXPECT_EQ(statistics.methods[0].pairs, exact.methods[0].pairs);
            break;
        }
    }
    EXPECT_TRUE(changed);
}

// Lines over the picture are held with it.
TEST_F(LateFrame, ItsOverlayIsHeldWithIt) {
    settled();
    settings.scene.lightScale = 3;
    FrameStatistics statistics = frame();  // traces
    const Line line{};
    renderer->drawOverlay(std::span(&line, 1), 1, statistics);
    const std::vector<std::uint8_t> before = display();
    frame();  // of the new views, unproved
    FrameStatistics none;
    EXPECT_FALSE(renderer->render(settings, input, none));  // its results are still held
    EXPECT_EQ(display(), before);
    settled();
    EXPECT_NE(display(), before);
}

}  // namespace
}  // namespace mv
