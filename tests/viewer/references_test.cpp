// References and measurements in the window: nothing waits for them.

#include <chrono>
#include <cmath>

#include "app/temp_folder.h"
#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

class WindowReferences : public ViewerTest {
  protected:
    static Settings fewRays() {
        Settings s = Viewer::smallSettings();
        s.vpls = 16;
        s.referenceSamples = 1;
        return s;
    }
};

TEST_F(WindowReferences, AreMadeWhileFramesGoOn) {
    Settings settings = fewRays();
    settings.referenceSamples = 200;
    Viewer viewer(480, 320, settings);
    viewer.run("wait-still");
    const auto light = viewer.pictureHash();
    viewer.run("method=pathtraced");
    // Long before it is there, the window answers.
    viewer.frames(3);
    EXPECT_FALSE(viewer.session->still());
    EXPECT_NE(viewer.model().referenceStage, "");
    viewer.run("profiler");
    EXPECT_EQ(viewer.model().instrument, ui::Instrument::profiler);
    viewer.run("profiler; key Escape");
    EXPECT_EQ(viewer.settings().method, Method::megaviews);
    EXPECT_EQ(viewer.model().error, "");
    viewer.run("wait-still");
    EXPECT_EQ(viewer.model().referenceStage, "");
    EXPECT_EQ(viewer.pictureHash(), light);
}

TEST_F(WindowReferences, StandOnEitherSideOfTheSplit) {
    Viewer viewer(480, 320, fewRays());
    viewer.run("side-by-side; compare=exact; wait-still");
    EXPECT_EQ(viewer.model().referenceStage, "");
    EXPECT_EQ(viewer.model().error, "");
    viewer.run("split=1; wait-still");
    const auto left = viewer.pictureHash();
    viewer.run("split=0; wait-still");
    const auto right = viewer.pictureHash();
    EXPECT_NE(left, right);
    // Something it depends on begins it anew, and what it shows in the end is another picture.
    viewer.run("vpls=24; wait-still");
    EXPECT_NE(viewer.pictureHash(), right);
    viewer.run("vpls=16; wait-still");
    EXPECT_EQ(viewer.pictureHash(), right);
    // Where it needs no second method it has the picture for itself.
    viewer.run("compare=off; method=exact; wait-still");
    EXPECT_EQ(viewer.model().referenceStage, "");
    EXPECT_EQ(viewer.settings().method, Method::exact);
}

TEST_F(WindowReferences, ThatCannotBeAreGivenUpWithAReason) {
    Viewer viewer(480, 320, fewRays());
    viewer.run("method=manylods; wait-still; particles=5; method=pathtraced; wait 2");
    for (int i = 0; i < 2000 && viewer.model().error.empty(); ++i) viewer.frame();
    EXPECT_NE(viewer.model().error.find("pathtraced"), std::string::npos);
    EXPECT_EQ(viewer.settings().method, Method::manylods);
    viewer.run("key Escape; wait-still");
    EXPECT_EQ(viewer.model().error, "");
}

TEST_F(WindowReferences, ErrorsAreMeasuredOnceThePictureIsComplete) {
    const test::TempFolder folder;
    Viewer viewer(480, 320, fewRays());
    viewer.run("wait-still; errors; wait-still");
    EXPECT_TRUE(viewer.model().errors.tables.empty());  // nothing to compare with
    viewer.run("side-by-side; compare=none; wait-still");
    ASSERT_EQ(viewer.model().errors.tables.size(), 1u);
    const ui::ErrorTable first = viewer.model().errors.tables[0];
    EXPECT_EQ(first.of, "Right: no visibility");
    EXPECT_EQ(first.against, "Left: MegaViews");
    EXPECT_EQ(first.values.size(), 9u);
    for (const ui::ErrorValue& value : first.values) {
        ASSERT_TRUE(value.value) << value.label;
        EXPECT_TRUE(std::isfinite(*value.value)) << value.label;
    }
    // A reference is the truth on whichever side it stands.
    viewer.run("compare=exact; wait-still");
    EXPECT_EQ(viewer.model().errors.tables.at(0).of, "Left: MegaViews");
    EXPECT_NE(viewer.model().errors.tables[0].values[0].value, first.values[0].value);
    viewer.run("view=normals; wait-still");
    EXPECT_NE(viewer.model().errors.tables.at(0).reason, "");
    viewer.run("errors; view=final; wait-still");
    EXPECT_TRUE(viewer.model().errors.tables.empty());
}

TEST_F(WindowReferences, BothSidesAreMeasuredAgainstAFile) {
    const test::TempFolder folder;
    const std::string file = folder.file("r.exr");
    Settings settings = fewRays();
    {
        Viewer viewer(480, 320, settings);
        viewer.run("method=none; wait-still; save " + file);
    }
    Viewer viewer(480, 320, settings, "builtin:cornell", 1, {}, file);
    viewer.run("method=none; errors; wait-still; wait 2; wait-still");
    // The dock takes room: the picture is no longer as large as the file.
    ASSERT_EQ(viewer.model().errors.tables.size(), 1u);
    EXPECT_NE(viewer.model().errors.tables[0].reason.find("resolution"), std::string::npos);
    const auto size = viewer.settings();
    viewer.run("side-by-side; wait-still");
    EXPECT_EQ(viewer.model().errors.tables.size(), 3u);
    EXPECT_EQ(viewer.settings().width, size.width);
}

TEST_F(WindowReferences, FlipIsShownOnceBothSidesAreComplete) {
    Viewer viewer(480, 320, fewRays());
    viewer.run("side-by-side; compare=none; split=0; wait-still");
    const auto split = viewer.pictureHash();
    viewer.run("difference=flip; wait-still");
    const auto flip = viewer.pictureHash();
    EXPECT_NE(flip, split);
    ASSERT_TRUE(viewer.model().difference);
    EXPECT_EQ(viewer.model().difference->title, "FLIP");
    EXPECT_EQ(viewer.model().difference->high, 1);
    viewer.run("difference=absolute; wait-still");
    EXPECT_NE(viewer.pictureHash(), flip);
    viewer.run("next-difference; next-difference; next-difference; wait-still");
    EXPECT_EQ(viewer.settings().difference, Difference::flip);
    EXPECT_EQ(viewer.pictureHash(), flip);
}

}  // namespace
}  // namespace mv
