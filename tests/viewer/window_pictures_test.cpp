// The window as it was looked at and believed, at three sizes. These are the pictures that README
// shows. Times in it differ from run to run: a small share of the pixels may.

#include "image/golden_image.h"
#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

class WindowPicturesTest : public ViewerTest {
  protected:
    static Picture pictureOf(const Viewer& viewer) {
        Picture picture;
        picture.width = viewer.screen.color.width();
        picture.height = viewer.screen.color.height();
        const auto rgba = viewer.pixels();
        const auto w = static_cast<std::size_t>(picture.width);
        const auto h = static_cast<std::size_t>(picture.height);
        picture.rgb.resize(3 * w * h);
        for (std::size_t y = 0; y < h; ++y) {
            for (std::size_t x = 0; x < w; ++x) {
                for (std::size_t c = 0; c < 3; ++c) {
                    picture.rgb[3 * (y * w + x) + c] = rgba[4 * ((h - 1 - y) * w + x) + c];
                }
            }
        }
        return picture;
    }
    static Settings shownSettings() {
        Settings s;
        s.scene.octreeDepth = 8;
        s.views.octreeDepth = 8;
        s.views.vpls = 1024;
        s.gather.samples = 4;
        s.picture.accumulate = 1;
        return s;
    }
    // Of large windows, where the panels are what is looked at.
    static Settings quickSettings() {
        Settings s = shownSettings();
        s.gather.samples = 2;
        s.gather.cull.scale = 2;
        s.gather.undecided = Undecided::off;
        return s;
    }
    static constexpr Tolerance kTolerance{40, 0.03};
};

TEST_F(WindowPicturesTest, Default) {
    Viewer viewer(1280, 720, shownSettings(), "builtin:atrium");
    viewer.run("wait-still; wait 2");
    EXPECT_TRUE(matchesGolden(pictureOf(viewer), "window-default", kTolerance));
    viewer.run("profiler; side-by-side; wait-still; wait 2");
    EXPECT_TRUE(matchesGolden(pictureOf(viewer), "window-split-profiler", kTolerance));
    viewer.run("side-by-side; pixel; wait 2; click 55%,80%; wait-still; wait 2");
    EXPECT_TRUE(matchesGolden(pictureOf(viewer), "window-pixel", kTolerance));
    // Two views beside the fountain: it is near and seen apart, what is further off is shared.
    viewer.run("views; view=shared; pick-a=1580; wait 3; click @views.nearest; wait-still; wait 2");
    ASSERT_TRUE(viewer.model().views.a && viewer.model().views.b) << "both are alive";
    EXPECT_TRUE(matchesGolden(pictureOf(viewer), "window-two-views", kTolerance));
}

TEST_F(WindowPicturesTest, StepsOnASmallScene) {
    Settings settings = shownSettings();
    settings.views.vpls = 64;
    Viewer viewer(1280, 720, settings, "builtin:cornell");
    // A node of two views: what is near is split, what is further off is rendered.
    viewer.run("steps; step-view=12; step=4; wait-still; wait 2");
    EXPECT_TRUE(matchesGolden(pictureOf(viewer), "window-steps", kTolerance));
}

TEST_F(WindowPicturesTest, SmallWindow) {
    Settings settings = shownSettings();
    settings.picture.accumulate = 2;
    Viewer viewer(1000, 600, settings, "builtin:cornell");
    viewer.run("traversal; side-by-side; wait-still; wait 2");
    EXPECT_TRUE(matchesGolden(pictureOf(viewer), "window-1000x600", kTolerance));
}

TEST_F(WindowPicturesTest, OneAndAHalfTimesAsLarge) {
    Viewer viewer(1920, 1080, quickSettings(), "builtin:cornell", 1.5f);
    viewer.run("memory; wait-still; wait 2");
    EXPECT_TRUE(matchesGolden(pictureOf(viewer), "window-scale-1.5", kTolerance));
}

TEST_F(WindowPicturesTest, TwiceAsLarge) {
    Viewer viewer(2560, 1440, quickSettings(), "builtin:cornell", 2.0f);
    viewer.run("help; wait-still; wait 2");
    EXPECT_TRUE(matchesGolden(pictureOf(viewer), "window-scale-2", kTolerance));
}

}  // namespace
}  // namespace mv
