// References and measurements in the window: nothing waits for them.

#include <chrono>
#include <cmath>

#include "app/common/frame_images.h"
#include "app/temp_folder.h"
#include "app/viewer/references.h"
#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

class WindowReferences : public ViewerTest {
  protected:
    static Settings fewRays() {
        Settings s = Viewer::smallSettings();
        s.views.vpls = 16;
        s.side[0].referenceSamples = 1;
        return s;
    }
};

TEST_F(WindowReferences, AreMadeWhileFramesGoOn) {
    Settings settings = fewRays();
    settings.side[0].referenceSamples = 200;
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
    EXPECT_EQ(viewer.settings().side[0].method, Method::megaviews);
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
    EXPECT_EQ(viewer.settings().side[0].method, Method::exact);
}

TEST_F(WindowReferences, ThatCannotBeAreGivenUpWithAReason) {
    Viewer viewer(480, 320, fewRays());
    viewer.run("method=manylods; wait-still; particles=5; method=pathtraced; wait 2");
    for (int i = 0; i < 2000 && viewer.model().error.empty(); ++i) viewer.frame();
    EXPECT_NE(viewer.model().error.find("pathtraced"), std::string::npos);
    EXPECT_EQ(viewer.settings().side[0].method, Method::manylods);
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

// What a run without a window finds for the sides' maps; nothing for those without maps.
std::vector<std::optional<MapErrorReport>> expectedMapErrors(const Settings& settings,
                                                             std::size_t count) {
    const auto assets = loadAssets("builtin:cornell", settings, {});
    FrameRenderer renderer;
    renderer.setScene(assets->scene, assets->bvh, assets->hierarchy);
    FrameInput input;
    input.camera = chosenCamera(settings, *assets, 0);
    input.animation = assets->animation;
    FrameStatistics statistics;
    renderer.render(settings, input, statistics);
    References references(*assets, {}, {});
    std::vector<Settings> sides = {settings};
    if (settings.compare) sides.push_back(sideAlone(settings, 1));
    std::vector<std::optional<MapErrorReport>> reports;
    for (const Settings& side : sides) {
        const ReferenceRequest request{side, input, renderer.readViews().views, {}};
        reports.push_back(mapErrorsOf(references.maps(request, count), request.views, renderer,
                                      side, static_cast<int>(reports.size())));
    }
    return reports;
}

void expectMapErrors(const Viewer& viewer, std::size_t count, const std::string& what) {
    SCOPED_TRACE(what);
    const auto expected = expectedMapErrors(viewer.settings(), count);
    const std::vector<ui::ErrorTable>& found = viewer.model().errors.maps;
    ASSERT_EQ(found.size(), expected.size());
    EXPECT_FALSE(viewer.model().errors.mapsWait);
    for (std::size_t side = 0; side < found.size(); ++side) {
        if (!expected[side]) {
            EXPECT_NE(found[side].reason.find("no depth maps"), std::string::npos);
            EXPECT_TRUE(found[side].values.empty());
            continue;
        }
        EXPECT_EQ(found[side].reason, "");
        ASSERT_EQ(found[side].values.size(), mapMetricsTable().size());
        for (std::size_t i = 0; i < mapMetricsTable().size(); ++i) {
            EXPECT_EQ(found[side].values[i].value,
                      mapMetricsTable()[i].percent(expected[side]->errors))
                << side << " " << mapMetricsTable()[i].name;
        }
        EXPECT_GT(expected[side]->errors.texels, 0u);
        EXPECT_EQ(found[side].badPixels, expected[side]->errors.bad);
    }
}

TEST_F(WindowReferences, MapErrorsAreThoseOfARunWithoutAWindow) {
    Viewer viewer(640, 400);
    viewer.run("errors; wait-still");
    ASSERT_EQ(viewer.model().errors.maps.size(), 1u);
    EXPECT_FALSE(viewer.model().errors.maps[0].values.at(0).value) << "nobody asked";
    viewer.run("click @map-views; wait 2; click @map-views=64; wait-still");
    expectMapErrors(viewer, 64, "one side");
    // The same exact maps serve whatever makes other maps of these views.
    viewer.run("pair-size=4; wait-still");
    expectMapErrors(viewer, 64, "larger pairs");
    viewer.run("pair-size=1; compare=ism; wait-still");
    expectMapErrors(viewer, 64, "two sides");
    viewer.run("compare-view-res=16; wait-still");
    expectMapErrors(viewer, 64, "of two resolutions");
    viewer.run("compare-view-res=0; method=none; wait-still");
    expectMapErrors(viewer, 64, "left without maps");
    viewer.run("compare=off; method=manylods; vpls=40; wait-still");
    expectMapErrors(viewer, 64, "other views, fewer than asked for");
    viewer.run("move 80%,50%; view=normals; exposure=1; wait-still");
    expectMapErrors(viewer, 64, "whatever is shown");
    for (const char* method : {"none", "rays", "exact", "pathtraced"}) {
        viewer.run(std::string("reference-samples=1; method=") + method + "; wait 2");
        ASSERT_EQ(viewer.model().errors.maps.size(), 1u);
        EXPECT_NE(viewer.model().errors.maps[0].reason, "") << method;
    }
    viewer.run("method=megaviews; reload-scene; wait-loading; wait-still");
    expectMapErrors(viewer, 64, "the scene anew");
    // Maps that could not be made are not read.
    viewer.run("fusion=off; gpu-memory=1; wait-still; view-res=256; wait 4");
    EXPECT_NE(viewer.model().error, "");
    viewer.run("key Escape; wait-still");
    expectMapErrors(viewer, 64, "after maps that did not fit");
    viewer.run("errors; wait-still");
    EXPECT_TRUE(viewer.model().errors.maps.empty());
}

TEST_F(WindowReferences, ExactMapsAreMadeWhileFramesGoOn) {
    Settings settings = Viewer::smallSettings();
    settings.views.vpls = 1024;
    settings.side[0].maps.resolution = 32;
    settings.side[0].method = Method::ism;
    Viewer viewer(640, 400, settings);
    viewer.run("errors; wait-still; click @map-views; wait 2; click @map-views=1024");
    viewer.frames(3);
    EXPECT_FALSE(viewer.session->still());
    EXPECT_TRUE(viewer.model().errors.mapsWait);
    EXPECT_NE(viewer.model().referenceStage, "");
    EXPECT_GE(viewer.model().referenceFraction, 0);
    // Neither camera nor what only shows the light begins them anew; they are given up by a key.
    viewer.run("move 60%,50%; scroll 2; tonemap=neutral; move 10%,30%");
    EXPECT_TRUE(viewer.model().errors.mapsWait);
    viewer.run("key Escape");
    EXPECT_EQ(viewer.model().errors.mapViews, 0);
    EXPECT_EQ(viewer.settings().side[0].method, Method::ism);
    viewer.run("wait-still");
    EXPECT_EQ(viewer.model().referenceStage, "");
    EXPECT_FALSE(viewer.model().errors.mapsWait);
    EXPECT_EQ(viewer.model().error, "");
}

TEST_F(WindowReferences, ExactMapsWaitUntilViewsStandStill) {
    Viewer viewer(640, 400);
    viewer.run("errors; click @map-views; wait 2; click @map-views=64; wait-still");
    for (std::uint32_t seed = 5; seed < 9; ++seed) {
        viewer.session->editSettings().seed = seed;
        viewer.frame();
        EXPECT_TRUE(viewer.model().errors.mapsWait);
        EXPECT_FALSE(viewer.model().errors.maps.at(0).values.at(0).value);
        EXPECT_TRUE(viewer.session->model().referenceStage.empty());
    }
    viewer.run("wait-still");
    expectMapErrors(viewer, 64, "the last seed");
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
    EXPECT_EQ(viewer.settings().resolution.width, size.resolution.width);
}

TEST_F(WindowReferences, AKeptPictureIsOfItsCamera) {
    Viewer viewer(480, 320, fewRays());
    viewer.run("wait-still; keep-left-as-reference; wait-still; method=none; wait-still");
    ASSERT_EQ(viewer.model().errors.tables.size(), 1u);
    EXPECT_EQ(viewer.model().errors.tables[0].reason, "");
    EXPECT_TRUE(viewer.model().errors.tables[0].values.at(0).value);
    viewer.run("fov=40; wait-still");
    ASSERT_EQ(viewer.model().errors.tables.size(), 1u);
    EXPECT_NE(viewer.model().errors.tables[0].reason.find("another camera"), std::string::npos);
    EXPECT_FALSE(viewer.model().errors.tables[0].values.at(0).value);
    viewer.run("open builtin:door; wait-loading; wait-still");
    ASSERT_EQ(viewer.model().errors.tables.size(), 1u);
    EXPECT_NE(viewer.model().errors.tables[0].reason.find("another scene"), std::string::npos);
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
    EXPECT_EQ(viewer.settings().display.difference, Difference::flip);
    EXPECT_EQ(viewer.pictureHash(), flip);
}

}  // namespace
}  // namespace mv
