// Every action, by its name and by its key: it changes what it says.

#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include "app/temp_folder.h"
#include "megaviews/io/save_scene.h"
#include "megaviews/scene/load_scene.h"
#include "megaviews/settings/settings_table.h"
#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

class ActionsTest : public ViewerTest {};

// What an action may change, in one comparable piece.
struct Seen {
    Settings settings;
    bool playing = false, paused = false, hidden = false, help = false, otherSide = false;
    bool palette = false, aboutScene = false, start = false;
    double speed = 0, timeS = 0;
    std::optional<ui::Instrument> instrument;
    ui::Browse browse = ui::Browse::none;
    bool vsync = true, fullScreen = false, closed = false, loading = false;
    std::array<bool, 9> bookmarks{};
    State state;
    bool operator==(const Seen&) const = default;
};

Seen look(const Viewer& viewer) {
    const ui::Model& m = viewer.model();
    Seen seen{viewer.settings(),
              m.playing,
              m.renderingPaused,
              m.hidden,
              m.help,
              m.otherSide,
              m.palette,
              m.aboutScene,
              m.start,
              m.speed,
              m.timeS,
              m.instrument,
              m.browse,
              viewer.screen.vsync,
              viewer.screen.fullScreen,
              viewer.session->closed(),
              viewer.session->loading(),
              m.bookmarks,
              viewer.session->state()};
    return seen;
}

// Writes down where files went.
std::size_t filesIn(const std::string& folder) {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        count += entry.is_regular_file();
    }
    return count;
}

TEST_F(ActionsTest, MethodsFollowEachOther) {
    Viewer viewer;
    viewer.run("pause-rendering");
    std::vector<Method> forth, back;
    for (const MethodInfo& info : kMethods) {
        if (isReference(info.method)) continue;
        forth.push_back(viewer.settings().side[0].method);
        viewer.run("next-method");
    }
    EXPECT_EQ(std::set(forth.begin(), forth.end()).size(), forth.size());
    EXPECT_EQ(viewer.settings().side[0].method, forth.front());
    for (std::size_t i = 0; i < forth.size(); ++i) {
        viewer.run("previous-method");
        back.push_back(viewer.settings().side[0].method);
    }
    EXPECT_TRUE(std::equal(back.begin(), back.end(), forth.rbegin()));
}

TEST_F(ActionsTest, EachChangesWhatItSays) {
    const test::TempFolder folder;
    const test::Variable pictures("XDG_PICTURES_DIR", folder.file(""));
    using A = Action;
    // What has to be done before, so that there is something to change.
    const std::map<Action, std::string> before = {
        {A::splitLeft, "side-by-side"},
        {A::splitRight, "side-by-side"},
        {A::swapSides, "side-by-side"},
        {A::showOtherSide, "side-by-side"},
        {A::flipSides, "side-by-side"},
        {A::keepReference, "wait-still"},
        {A::undo, "vpls=32"},
        {A::redo, "vpls=32; undo"},
        {A::resetSettings, "vpls=32"},
        {A::restart, "time 3"},
        {A::resetCamera, "scroll 2"},
        {A::exposureReset, "brighter"},
        {A::stepTraversalBack, "step=3"},
        {A::recallBookmark1, "store-bookmark-1; move 30%,50%; scroll 3"},
        {A::recallBookmark2, "store-bookmark-2; move 30%,50%; scroll 3"},
        {A::recallBookmark3, "store-bookmark-3; move 30%,50%; scroll 3"},
        {A::recallBookmark4, "store-bookmark-4; move 30%,50%; scroll 3"},
        {A::recallBookmark5, "store-bookmark-5; move 30%,50%; scroll 3"},
        {A::recallBookmark6, "store-bookmark-6; move 30%,50%; scroll 3"},
        {A::recallBookmark7, "store-bookmark-7; move 30%,50%; scroll 3"},
        {A::recallBookmark8, "store-bookmark-8; move 30%,50%; scroll 3"},
        {A::recallBookmark9, "store-bookmark-9; move 30%,50%; scroll 3"},
    };
    // What is seen in the picture. Of the others none is rendered, which would take minutes.
    const std::set<Action> rendered = {A::keepReference, A::measureFrames,  A::copyNumbers,
                                       A::saveNumbers,   A::pauseRendering, A::reloadShaders,
                                       A::reload};
    Viewer viewer;
    for (const ActionInfo& info : actionsTable()) {
        SCOPED_TRACE(std::string(info.name));
        if (info.action == A::quit) continue;  // last
        if (info.action == A::tour) continue;  // of its own: HandsTest
        viewer.run("key Escape; move 30%,50%");
        if (viewer.model().renderingPaused == rendered.contains(info.action)) {
            viewer.run("pause-rendering");
        }
        if (const auto found = before.find(info.action); found != before.end()) {
            viewer.run(found->second);
        }
        const Seen old = look(viewer);
        const std::size_t files = filesIn(folder.file(""));
        viewer.screen.title.clear();
        viewer.run(idOf(info));
        const Seen now = look(viewer);
        switch (info.action) {
            case A::screenshotPng:
            case A::screenshotExr:
            case A::screenshotWindow:
            case A::saveNumbers:
                EXPECT_EQ(filesIn(folder.file("")), files + 1);
                break;
            case A::keepReference:
                EXPECT_EQ(viewer.model().instrument, ui::Instrument::errors);
                viewer.run("errors");  // which would lie under the mouse
                break;
            case A::measureFrames:
                viewer.frame();
                EXPECT_TRUE(viewer.model().frameRun.running);
                viewer.run(idOf(info));
                EXPECT_FALSE(viewer.model().frameRun.running);
                break;
            case A::copyNumbers:
                EXPECT_EQ(viewer.model().toasts.back().text, "numbers copied");
                break;
            case A::copyTable:
                EXPECT_EQ(viewer.model().toasts.back().text, "numbers copied as CSV");
                break;
            case A::largerInterface:
                EXPECT_EQ(viewer.model().toasts.back().text,
                          "there is no room for a larger interface");
                break;
            case A::reloadShaders:
                EXPECT_TRUE(viewer.model().shaderErrors.empty());
                break;
            case A::reload:
                viewer.waitForScene();
                EXPECT_NE(viewer.screen.title, "") << "set by whatever was loaded";
                break;
            default:
                EXPECT_NE(now, old);
        }
        // Back to where the next one starts. Of presets the octree would take its time.
        if (viewer.session->loading()) viewer.run("key Escape");
        viewer.session->editSettings() = Viewer::smallSettings();
        while (viewer.session->loading()) viewer.frame();
        viewer.run("key Escape");
        EXPECT_EQ(viewer.model().error, "");
        if (viewer.model().hidden) viewer.run("hide-panels");
        if (viewer.model().help) viewer.run("help");
        if (viewer.model().otherSide) viewer.run("show-other-side");
    }
    viewer.run("quit");
    EXPECT_TRUE(viewer.session->closed());
}

TEST_F(ActionsTest, KeysDoWhatTheTableSays) {
    Viewer viewer;
    const auto check = [&](const std::string& keys, const std::function<bool()>& holds) {
        viewer.run(keys);
        EXPECT_TRUE(holds()) << keys;
    };
    check("key M", [&] { return viewer.settings().side[0].method == Method::manylods; });
    check("key Shift+M", [&] { return viewer.settings().side[0].method == Method::megaviews; });
    check("key B", [&] {
        return (viewer.settings().compare && viewer.settings().side[1].method == Method::manylods);
    });
    check("hold X", [&] { return viewer.model().otherSide; });
    check("release X", [&] { return !viewer.model().otherSide; });
    check("key Ctrl+Z", [&] { return !viewer.settings().compare; });
    check("key Ctrl+Shift+Z", [&] { return viewer.settings().compare; });
    check("key F2", [&] { return viewer.model().hidden; });
    check("key F2", [&] { return !viewer.model().hidden; });
    check("key F1", [&] { return viewer.model().help; });
    check("key F1", [&] { return !viewer.model().help; });
    check("key P", [&] { return viewer.model().instrument == ui::Instrument::profiler; });
    check("key T", [&] { return viewer.model().instrument == ui::Instrument::traversal; });
    check("key ]", [&] { return viewer.settings().picture.view == DebugView::direct; });
    check("key [", [&] { return viewer.settings().picture.view == DebugView::final; });
    check("key Space", [&] { return viewer.model().playing; });
    check("key Ctrl+Q", [&] { return viewer.session->closed(); });
}

TEST_F(ActionsTest, KeysAreLeftToTextThatIsTyped) {
    Viewer viewer;
    viewer.run("key Ctrl+O; wait 2");
    ASSERT_EQ(viewer.model().browse, ui::Browse::open);
    viewer.run("type \"mmm\"; key M; key B");
    EXPECT_EQ(viewer.settings().side[0].method, Method::megaviews);
    EXPECT_FALSE(viewer.settings().compare);
    viewer.run("key Escape; wait 2");
    EXPECT_EQ(viewer.model().browse, ui::Browse::none);
    viewer.run("key M");
    EXPECT_EQ(viewer.settings().side[0].method, Method::manylods);
}

TEST_F(ActionsTest, TheOtherSideFillsThePictureWhileItsKeyIsHeld) {
    Viewer viewer;
    viewer.run("hide-panels; method=none; compare=megaviews; split=1; wait-still");
    const auto left = viewer.pictureHash();
    viewer.run("hold X; wait-still");
    const auto right = viewer.pictureHash();
    viewer.run("release X; wait-still");
    EXPECT_NE(left, right);
    EXPECT_EQ(viewer.pictureHash(), left);
    viewer.run("split=0; wait-still");
    EXPECT_EQ(viewer.pictureHash(), right);
}

TEST_F(ActionsTest, SamplesAccumulateWhileNothingMovesAndStartAnewWhenItDoes) {
    Settings settings = Viewer::smallSettings();
    settings.picture.accumulate = 5;
    Viewer viewer(640, 400, settings);
    viewer.run("wait-still");
    EXPECT_EQ(viewer.session->statistics().accumulatedFrames, 5);
    EXPECT_TRUE(viewer.session->resting());
    viewer.run("move 30%,50%; scroll 1");
    EXPECT_LT(viewer.session->statistics().accumulatedFrames, 5);
    viewer.run("wait-still");
    EXPECT_EQ(viewer.session->statistics().accumulatedFrames, 5);
    // What only shows the light differently takes no sample away.
    viewer.run("tonemap=neutral; show-octree=2");
    EXPECT_EQ(viewer.session->statistics().accumulatedFrames, 5);
}

TEST_F(ActionsTest, MouseOrbitsPansDolliesAndFlies) {
    Viewer viewer;
    const auto position = [&] { return *viewer.session->state().settings.camera.position; };
    for (const char* gesture :
         {"drag 20%,50% 30%,60%", "drag 20%,50% 30%,60% middle", "move 30%,50%; scroll 3"}) {
        const auto before = position();
        viewer.run(gesture);
        EXPECT_NE(position(), before) << gesture;
    }
    const auto before = position();
    viewer.run("drag 20%,50% 25%,50% right");
    EXPECT_EQ(position(), before) << "looking around stays in place";
    // On a panel the same gestures leave the camera alone.
    const auto target = viewer.session->state().settings.camera.target;
    viewer.run("drag 90%,50% 80%,50% right; move 90%,50%; scroll 3");
    EXPECT_EQ(viewer.session->state().settings.camera.target, target);
}

TEST_F(ActionsTest, FailuresKeepTheSceneAndSayWhy) {
    Viewer viewer;
    const std::string name = viewer.model().sceneName;
    viewer.run("open no-such-file.glb; wait-loading; wait 2");
    EXPECT_NE(viewer.model().error.find("no-such-file.glb"), std::string::npos);
    EXPECT_EQ(viewer.model().sceneName, name);
    viewer.run("key Escape; wait 2");
    EXPECT_EQ(viewer.model().error, "");
    viewer.run("drop no-such-state.json; wait 2");
    EXPECT_NE(viewer.model().error.find("no-such-state.json"), std::string::npos);
    viewer.run("key Escape; wait 2; fusion=off; gpu-memory=1; wait 2; view-res=256; wait 2");
    EXPECT_NE(viewer.model().error, "") << "maps that do not fit are refused";
    EXPECT_EQ(viewer.settings().side[0].maps.resolution,
              Viewer::smallSettings().side[0].maps.resolution)
        << "and what was there before is back";
    viewer.run("key Escape; compare=raster; wait-still; compare-view-res=256; wait 4");
    EXPECT_NE(viewer.model().error, "") << "also where their draft fits";
    EXPECT_EQ(viewer.settings().side[1].maps, viewer.settings().side[0].maps);
    viewer.run("key Escape; wait 4; wait-still");
    EXPECT_EQ(viewer.model().error, "") << "said once";
}

TEST_F(ActionsTest, DroppedPicturesRestoreTheirState) {
    const test::TempFolder folder;
    const std::string picture = folder.file("a.png");
    Viewer viewer;
    viewer.run("method=manylods; vpls=100; seed=7; move 30%,50%; scroll 2; wait-still");
    const State saved = viewer.session->state();
    viewer.session->savePicture(picture);
    viewer.run("method=none; vpls=50; scroll -5; tonemap=none; wait 1; drop " + picture +
               "; wait-loading; wait-still");
    EXPECT_EQ(viewer.model().error, "");
    const State restored = viewer.session->state();
    EXPECT_EQ(restored.settings.side[0].method, Method::manylods);
    EXPECT_EQ(restored.settings.views.vpls, 100);
    EXPECT_EQ(restored.settings.seed, 7u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR((*restored.settings.camera.position)[i], (*saved.settings.camera.position)[i],
                    1e-4);
    }
}

TEST_F(ActionsTest, BookmarksAndRecentFilesOutliveTheSession) {
    const test::TempFolder folder;
    const std::string file = folder.file("viewer.json");
    {
        Viewer viewer(640, 400, Viewer::smallSettings(), "builtin:cornell", 1, file);
        viewer.run("move 30%,50%; scroll 3; key Ctrl+4");
        EXPECT_TRUE(viewer.model().bookmarks[3]);
    }
    Viewer viewer(640, 400, Viewer::smallSettings(), "builtin:cornell", 1, file);
    ASSERT_EQ(viewer.model().recent.size(), 1u);
    EXPECT_TRUE(viewer.model().bookmarks[3]);
    EXPECT_FALSE(viewer.model().bookmarks[2]);
    const auto before = *viewer.session->state().settings.camera.position;
    viewer.run("key 4");
    EXPECT_NE(*viewer.session->state().settings.camera.position, before);
}

std::vector<std::string> cameraNames(const Scene& scene) {
    std::vector<std::string> names;
    for (const Camera& camera : scene.cameras) names.push_back(camera.name);
    return names;
}

TEST_F(ActionsTest, ASavedSceneHasTheLightsAndTheBookmarks) {
    const test::TempFolder folder;
    const std::string file = folder.file("saved.glb"), again = folder.file("again.glb");
    Viewer viewer;
    viewer.run("hide-panels; save-scene " + file);
    std::vector<std::string> names = {"front", "inside"};  // the scene's own
    EXPECT_EQ(cameraNames(loadScene(file)), names) << "none of them was moved";

    viewer.run("lights=0:0.5,4,0.1::30,20,60; store-bookmark-2; move 30%,50%; scroll 3");
    viewer.run("store-bookmark-4; scroll -1; exposure=2; wait-still; save-scene " + file);
    const auto picture = viewer.pictureHash();
    const State before = viewer.session->state();
    const Scene saved = loadScene(file);
    names = {"Picture", "Bookmark 2", "Bookmark 4", "front", "inside"};
    EXPECT_EQ(cameraNames(saved), names);
    ASSERT_EQ(saved.lights.size(), viewer.session->assets()->scene.lights.size());
    const PosedLight lamp = saved.lightsAt(0, -1).at(0);
    EXPECT_EQ(lamp.position, glm::dvec3(0.5, 4, 0.1));
    EXPECT_EQ(lamp.light.intensity, glm::vec3(30, 20, 60));

    viewer.run("key 4; wait 2");
    const State bookmarked = viewer.session->state();
    viewer.run("open " + file + "; wait-loading; exposure=2; wait-still");
    EXPECT_EQ(viewer.pictureHash(), picture);
    const auto expectAt = [&](const State& state) {
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_NEAR((*viewer.session->state().settings.camera.position)[i],
                        (*state.settings.camera.position)[i], 1e-4);
        }
    };
    expectAt(before);
    viewer.run("camera=Bookmark 4; wait 2");
    expectAt(bookmarked);

    // What a user chooses in the dialog.
    viewer.run("store-bookmark-2; hide-panels; key Ctrl+E; wait 2");
    ASSERT_EQ(viewer.model().browse, ui::Browse::saveScene);
    viewer.run("type \"" + folder.file("again") + "\"; key Enter; wait 2");
    EXPECT_EQ(viewer.model().toasts.back().text, "scene written: " + again);
    EXPECT_EQ(cameraNames(loadScene(again)),
              (std::vector<std::string>{"Bookmark 4", "Bookmark 2", "Picture", "Bookmark 2 2",
                                        "front", "inside"}));
    viewer.run("key Ctrl+E; wait 2; type \"" + file + "\"; key Enter; wait 2");
    EXPECT_NE(viewer.model().error.find("would be overwritten"), std::string::npos);
    EXPECT_EQ(viewer.model().sceneName, file);
    EXPECT_EQ(cameraNames(loadScene(file)), names);
}

TEST_F(ActionsTest, ASavedSceneKeepsTheLensOfACameraThatWasMoved) {
    const test::TempFolder folder;
    const Scene scene = loadScene("builtin:cornell");
    std::vector<PosedCamera> cameras(2, scene.camerasAt(0, -1).at(0));
    cameras[1].camera.name = "plan";
    cameras[1].camera.orthoHalfHeight = 3;
    saveScene(folder.file("two.glb"), {.scene = scene, .lights = {}, .cameras = cameras});
    Viewer viewer(640, 400, Viewer::smallSettings(), folder.file("two.glb"));
    viewer.run("camera=plan; wait 2; frame-scene; wait 2");
    ASSERT_EQ(viewer.settings().camera.name, "");
    viewer.run("save-scene " + folder.file("saved.glb"));
    const Scene saved = loadScene(folder.file("saved.glb"));
    EXPECT_EQ(cameraNames(saved),
              (std::vector<std::string>{"Picture", cameras[0].camera.name, "plan"}));
    EXPECT_TRUE(saved.cameras.at(0).orthoHalfHeight);
}

TEST_F(ActionsTest, LightsAreDraggedInThePictureAndInThePanel) {
    Viewer viewer(1280, 720);
    const auto lights = [&] { return viewer.settings().scene.lights; };
    viewer.run("click @group:Lights; wait 2");
    ASSERT_TRUE(viewer.model().lights.at(0).place.has_value());
    viewer.run("drag @light.0.handle by -60,40; wait-still");
    const std::string moved = lights();
    EXPECT_NE(moved, "");
    const auto camera = *viewer.session->state().settings.camera.position;
    viewer.run("drag @light.0.handle by 30,-10; wait-still");
    EXPECT_NE(lights(), moved);
    EXPECT_EQ(*viewer.session->state().settings.camera.position, camera) << "the camera stays";
    viewer.run("click @light.0.reset; wait 2");
    EXPECT_EQ(lights(), "");
    viewer.run("undo");
    EXPECT_NE(lights(), "");
}

TEST_F(ActionsTest, WidgetsAreReachedByNameResetIncluded) {
    Viewer viewer(1280, 720);
    viewer.run("click @side-by-side; wait 2");
    EXPECT_TRUE(viewer.settings().compare);
    viewer.run("vpls=32; wait 1; click @vpls right; wait 2; click @reset:vpls; wait 2");
    EXPECT_EQ(viewer.settings().views.vpls, Settings{}.views.vpls);
    viewer.run("click @File; wait 2; hover @\"Open Recent\"; hover @Scenes; key Escape; wait 2");
    EXPECT_THROW(viewer.run("click @no-such-widget"), Error);
}

// State holds the camera and the size in use, not what was asked for.
TEST_F(ActionsTest, SettingsOfCameraSizeAndSceneTakeEffect) {
    Viewer viewer;
    const auto now = [&] { return viewer.session->state().settings; };
    const auto before = now();
    ASSERT_TRUE(before.camera.position && before.camera.target && before.camera.fovDeg);
    viewer.run("camera-position=0.3,0.4,0.5; wait 2");
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR((*now().camera.position)[i], 0.3 + 0.1 * static_cast<double>(i), 1e-4);
    }
    EXPECT_NEAR(*now().camera.fovDeg, *before.camera.fovDeg, 1e-3) << "only what was given changes";
    viewer.run("fov=33; wait 2");
    EXPECT_NEAR(*now().camera.fovDeg, 33, 1e-3);
    EXPECT_NEAR((*now().camera.position)[1], 0.4, 1e-4);
    viewer.run("camera-target=0.3,0.4,-3; wait 2");
    EXPECT_NEAR((*now().camera.target)[0], 0.3, 1e-4) << "straight ahead";
    EXPECT_NEAR((*now().camera.target)[1], 0.4, 1e-4);
    const std::string leaves = viewer.model().sceneSummary;
    viewer.run("scene-depth=4; wait-loading; wait 2");
    EXPECT_EQ(viewer.model().error, "");
    EXPECT_NE(viewer.model().sceneSummary, leaves) << "fewer leaves";
    EXPECT_NEAR((*now().camera.position)[0], 0.3, 1e-4) << "the camera stays";
}

TEST_F(ActionsTest, TwoViewsArePickedInThePicture) {
    Settings settings = Viewer::smallSettings();
    settings.views.vpls = 1024;
    settings.scene.octreeDepth = settings.views.octreeDepth = 8;
    Viewer viewer(1280, 720, settings);
    viewer.run("views; wait 2");
    for (int y = 80; y > 40 && !viewer.settings().inspect.pickA; y -= 2) {
        viewer.run("click 50%," + std::to_string(y) + "%; wait 2");
    }
    ASSERT_TRUE(viewer.settings().inspect.pickA) << "no view in the middle column of the picture";
    viewer.run("pick-a=12; wait 2; click @views.nearest; wait 2");
    ASSERT_TRUE(viewer.settings().inspect.pickB);
    const ui::ViewsData& views = viewer.model().views;
    ASSERT_TRUE(views.a && views.b);
    EXPECT_EQ(views.a->view.slot, viewer.settings().inspect.pickA);
    EXPECT_EQ(views.a->maps.size(), views.shared.size() + 1) << "the fused map and one a level";
    std::uint64_t common = 0, texels = 0;
    for (const ui::SharedLevel& level : views.shared) {
        if (level.common) {
            EXPECT_EQ(level.pairsA, level.pairsB);
        }
        common += level.common ? level.pairsA : 0;
        texels += level.texelsA;
    }
    EXPECT_GT(common, 0u) << "neighbours share pairs";
    EXPECT_GT(texels, 30u);
}

TEST_F(ActionsTest, APixelShowsWhatItGathered) {
    Viewer viewer(1280, 720);
    viewer.run("pixel; wait-still; click 50%,60%; wait 2");
    const ui::PixelData& pixel = viewer.model().pixel;
    ASSERT_TRUE(pixel.picked.has_value());
    ASSERT_TRUE(pixel.picked->surface);
    EXPECT_FALSE(pixel.gathered.empty());
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(pixel.picked->radiance[c], pixel.picked->direct[c] + pixel.picked->indirect[c],
                    1e-4f);
    }
    viewer.run("profiler; wait 2");
    EXPECT_FALSE(viewer.model().pixel.picked.has_value()) << "a closed instrument holds nothing";
}

TEST_F(ActionsTest, BrokenShadersAreShownUntilTheyAreMended) {
    const test::TempFolder folder;
    std::filesystem::copy(MEGAVIEWS_SOURCE_DIR "/shaders", folder.file("shaders"),
                          std::filesystem::copy_options::recursive);
    const test::Variable where("MEGAVIEWS_SHADER_DIR", folder.file("shaders"));
    Viewer viewer;
    viewer.run("hide-panels; wait-still");
    const auto before = viewer.pictureHash();
    const std::string good = folder.text("shaders/passes/tonemap.frag");
    folder.write("shaders/passes/tonemap.frag", good + "\nnonsense\n");
    viewer.run("key F5; wait-still");
    ASSERT_EQ(viewer.model().shaderErrors.size(), 1u);
    EXPECT_NE(viewer.model().shaderErrors[0].find("tonemap.frag"), std::string::npos);
    folder.write("shaders/passes/tonemap.frag", good);
    viewer.run("key F5; wait-still");
    EXPECT_TRUE(viewer.model().shaderErrors.empty());
    EXPECT_EQ(viewer.pictureHash(), before);
}

TEST_F(ActionsTest, AnInterfaceThatIsScaledStillFits) {
    Viewer viewer(1280, 720);
    const float before = viewer.session->interface().findItem("panel:controls")->width;
    viewer.run("key Ctrl+=; wait 2");
    EXPECT_GT(viewer.session->interface().findItem("panel:controls")->width, before);
    viewer.run("key Ctrl+-; wait 2");
    EXPECT_FLOAT_EQ(viewer.session->interface().findItem("panel:controls")->width, before);
}

}  // namespace
}  // namespace mv
