// Sets of samples averaged while nothing changes: what the mean is, when it grows and when it
// begins anew.

#include "gpu/frame_fixture.h"
#include "megaviews/settings/statistics_table.h"

namespace mv {
namespace {

using test::FrameTest;

double squaredError(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double d = double{a[i]} - double{b[i]};
        sum += d * d;
    }
    return sum;
}

class Accumulation : public FrameTest {
  protected:
    void SetUp() override {
        FrameTest::SetUp();
        settings.picture.view = DebugView::indirect;
        settings.picture.accumulate = 16;
    }
    void renderTo(int sets) {
        while (render().accumulatedFrames < sets) {
        }
    }
};

TEST_F(Accumulation, ErrorFallsLikeOneOverTheSets) {
    settings.gather.filter = false;
    settings.gather.clampDistance =
        0.25;  // no rare bright samples: their variance would need more sets
    Settings full = settings;
    full.gather.samples = 0;
    EXPECT_EQ(render(full).accumulatedFrames, 1);
    EXPECT_EQ(render(full).accumulatedFrames, 1);  // a full sum has nothing to average
    const auto exact = radiance();

    std::vector<double> errors;
    for (int n = 1; n <= 16; ++n) {
        EXPECT_EQ(render().accumulatedFrames, n);
        errors.push_back(squaredError(radiance(), exact) * n);
    }
    // About 3000 pixels of independent sets.
    for (const double error : errors) {
        EXPECT_GT(error, 0.7 * errors.front());
        EXPECT_LT(error, 1.4 * errors.front());
    }
    // That is all of them; the picture rests.
    const auto last = radiance();
    for (int i = 0; i < 2; ++i) {
        const FrameStatistics rest = render();
        EXPECT_EQ(rest.accumulatedFrames, 16);
        EXPECT_TRUE(rest.stagesOfBothSides.empty());
        EXPECT_TRUE(rest.methods[0].stages.empty());
        EXPECT_EQ(radiance(), last);
    }
}

TEST_F(Accumulation, FilteredAndUnfilteredMeansConvergeToo) {
    for (const DebugView view : {DebugView::indirect, DebugView::unfiltered}) {
        for (const int scale : {1, 2}) {
            settings.picture.view = view;
            settings.gather.cull.scale = scale;
            settings.gather.filter = true;
            input.reuse = false;
            render();
            input.reuse = true;
            const auto first = radiance();
            renderTo(6);
            const auto later = radiance();
            renderTo(16);
            const auto last = radiance();
            EXPECT_GT(squaredError(first, later), 0);
            EXPECT_LT(squaredError(later, last), squaredError(first, last));
        }
    }
}

TEST_F(Accumulation, RepeatsItselfByteForByte) {
    renderTo(5);
    const auto one = radiance();
    startAfresh();
    renderTo(5);
    EXPECT_EQ(radiance(), one);
    input.reuse = false;
    EXPECT_EQ(render().accumulatedFrames, 1);
    input.reuse = true;
    renderTo(5);
    EXPECT_EQ(radiance(), one);
    // More sets may be asked for later; fewer than there are begin anew.
    settings.picture.accumulate = 5;
    EXPECT_EQ(render().accumulatedFrames, 5);
    settings.picture.accumulate = 6;
    EXPECT_EQ(render().accumulatedFrames, 6);
    settings.picture.accumulate = 5;
    EXPECT_EQ(render().accumulatedFrames, 1);
    renderTo(5);
    EXPECT_EQ(radiance(), one);
    settings.picture.accumulate = 1;
    EXPECT_EQ(render().accumulatedFrames, 1);
}

TEST_F(Accumulation, EveryChangeOfWhatIsGatheredBeginsAnew) {
    const std::vector<std::pair<const char*, void (*)(Settings&, FrameInput&)>> changes = {
        {"camera", [](Settings&, FrameInput& i) { i.camera.position.x += 0.01f; }},
        // Before particles, which have no clamp of their own.
        {"clamp", [](Settings& s, FrameInput&) { s.gather.clampDistance = 0.3; }},
        {"light scale", [](Settings& s, FrameInput&) { s.scene.lightScale = 2; }},
        {"sky", [](Settings& s, FrameInput&) { s.scene.environment.source = "white"; }},
        {"seed", [](Settings& s, FrameInput&) { s.seed = 1; }},
        {"VPLs", [](Settings& s, FrameInput&) { s.views.vpls = 210; }},
        {"particles", [](Settings& s, FrameInput&) { s.views.particles = 20; }},
        {"time", [](Settings&, FrameInput& i) { i.timeS = 1; }},
        {"size", [](Settings& s, FrameInput&) { s.resolution.width = 70; }},
        {"samples", [](Settings& s, FrameInput&) { s.gather.samples = 9; }},
        {"scale", [](Settings& s, FrameInput&) { s.gather.cull.scale = 2; }},
        {"cull level", [](Settings& s, FrameInput&) { s.gather.cull.level = 3; }},
        {"cutoff", [](Settings& s, FrameInput&) { s.gather.cull.cutoff = 0.5; }},
        {"bias", [](Settings& s, FrameInput&) { s.gather.bias = 0.5; }},
        {"filter", [](Settings& s, FrameInput&) { s.gather.filter = false; }},
        {"map resolution", [](Settings& s, FrameInput&) { s.side[0].maps.resolution = 8; }},
        {"rules", [](Settings& s, FrameInput&) { s.side[0].rules = kPublishedRules; }},
        {"method", [](Settings& s, FrameInput&) { s.side[0].method = Method::none; }},
        {"second side", [](Settings& s, FrameInput&) { compareWith(s, Method::megaviews); }},
        {"right side", [](Settings& s, FrameInput&) { s.side[1].maps.resolution = 16; }},
        {"no reuse", [](Settings&, FrameInput& i) { i.reuse = false; }},
    };
    settings.gather.samples = 4;
    render();
    for (const auto& [name, change] : changes) {
        EXPECT_EQ(render().accumulatedFrames, 2) << "before " << name;
        EXPECT_EQ(render().accumulatedFrames, 3) << "before " << name;
        change(settings, input);
        EXPECT_EQ(render().accumulatedFrames, 1) << name;
        // The same as without a past.
        const auto got = radiance();
        input.reuse = false;
        EXPECT_EQ(render().accumulatedFrames, 1) << name;
        EXPECT_EQ(radiance(), got) << name;
        input.reuse = true;
    }
}

TEST_F(Accumulation, WhatOnlyShowsTheLightGathersNothing) {
    compareWith(settings, Method::none);
    settings.picture.view = DebugView::final;
    settings.picture.accumulate = 2;
    renderTo(2);
    const auto light = radiance();
    const std::vector<std::pair<const char*, void (*)(Settings&)>> changes = {
        {"exposure", [](Settings& s) { s.display.exposureEv = 2; }},
        {"tone map", [](Settings& s) { s.display.toneMap = ToneMap::neutral; }},
        {"split", [](Settings& s) { s.display.split = 0.2; }},
        {"difference", [](Settings& s) { s.display.difference = Difference::absolute; }},
        {"range", [](Settings& s) { s.display.differenceRange = 0.5; }},
        {"view", [](Settings& s) { s.picture.view = DebugView::normals; }},
        {"another view", [](Settings& s) { s.picture.view = DebugView::unfiltered; }},
    };
    auto shown = display();
    for (const auto& [name, change] : changes) {
        change(settings);
        const FrameStatistics statistics = render();
        EXPECT_EQ(statistics.accumulatedFrames, 2) << name;
        const auto expectShownOnly = [what =
                                          std::string(name)](const std::vector<StageTime>& stages) {
            for (const StageTime& stage : stages) {
                EXPECT_EQ(infoOf(stage.stage).group, StageGroup::picture)
                    << what << ": " << infoOf(stage.stage).name;
            }
        };
        expectShownOnly(statistics.stagesOfBothSides);
        expectShownOnly(statistics.methods[0].stages);
        EXPECT_NE(display(), shown) << name;
        shown = display();
    }
}

}  // namespace
}  // namespace mv
