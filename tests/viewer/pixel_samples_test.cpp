// Soft edges in the window: when they come, what they leave alone, and that they end.

#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

class PixelSamples : public ViewerTest {
  protected:
    static Settings settings() {
        Settings s = Viewer::smallSettings();
        s.picture.accumulate = 6;
        return s;
    }
    static std::vector<std::uint8_t> picture(const Viewer& viewer) {
        return viewer.session->picture().renderer().display().readBytes(4);
    }
};

TEST_F(PixelSamples, WindowRefinesOverThemAndThenRests) {
    Viewer viewer(640, 400, settings());
    EXPECT_EQ(viewer.settings().picture.pixelSamples, 6) << "as many as sets, of which it has few";
    viewer.run("wait-still");
    const LivePicture& live = viewer.session->picture();
    const std::uint64_t number = live.number(), views = live.renderer().viewsVersion();
    const std::uint64_t maps = live.renderer().mapsVersion(0);
    EXPECT_EQ(viewer.session->statistics().accumulatedFrames, 6);
    EXPECT_TRUE(viewer.session->resting());
    viewer.frames(5);
    EXPECT_EQ(live.number(), number) << "nothing is rendered any more";
    const auto soft = picture(viewer);
    // Of the same views and maps at more points.
    viewer.run("pixel-samples=9; wait-still");
    EXPECT_EQ(viewer.session->statistics().accumulatedFrames, 9);
    EXPECT_EQ(live.renderer().viewsVersion(), views);
    EXPECT_EQ(live.renderer().mapsVersion(0), maps);
    EXPECT_NE(picture(viewer), soft);
    viewer.run("pixel-samples=6; wait-still");
    EXPECT_EQ(picture(viewer), soft);
    viewer.run("fresh-views=off; wait-still");
    EXPECT_NE(picture(viewer), soft) << "on by default";
    viewer.run("fresh-views=on; wait-still");
    EXPECT_EQ(picture(viewer), soft);
    viewer.run("pixel-samples=1; wait-still");
    EXPECT_EQ(viewer.session->statistics().accumulatedFrames, 6);
    EXPECT_NE(picture(viewer), soft);
}

TEST_F(PixelSamples, WhatIsExplainedAndMeasuredIsOfCentres) {
    Viewer viewer(640, 400, settings());
    viewer.run("wait-still");
    const auto soft = picture(viewer);
    for (const std::string panel : {"pixel", "errors"}) {
        viewer.run(panel + "; wait-still");
        EXPECT_FALSE(viewer.session->picture().effective().averagesPixels()) << panel;
        EXPECT_FALSE(viewer.session->picture().effective().averagesViews()) << panel;
        EXPECT_EQ(viewer.settings().picture.pixelSamples, 6) << "the setting stays";
        viewer.run(panel + "; wait-still");
        EXPECT_TRUE(viewer.session->picture().effective().averagesPixels()) << panel;
        EXPECT_TRUE(viewer.session->picture().effective().averagesViews()) << panel;
        EXPECT_EQ(picture(viewer), soft) << panel;
    }
}

// A picture that was saved halfway is made again by what it carries.
TEST_F(PixelSamples, StateSaysHowFarThePictureHasCome) {
    Viewer viewer(640, 400, settings());
    viewer.run("wait-still; seed=3");
    while (viewer.session->statistics().accumulatedFrames != 3) viewer.frame();
    const State state = viewer.session->state();
    EXPECT_EQ(state.settings.setsWanted(), viewer.settings().setsWanted());
    const State carried = stateOf(viewer.session->pictureInfo());
    EXPECT_EQ(carried.settings.setsWanted(), 3);
    EXPECT_TRUE(carried.settings.averagesPixels());
}

}  // namespace
}  // namespace mv
