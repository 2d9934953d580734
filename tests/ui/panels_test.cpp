// What the mouse and the keyboard do to the panels.

#include <gtest/gtest.h>
#include <imgui_internal.h>

#include "screen.h"

namespace mv::ui {
namespace {

TEST(Panels, WhatIsKnownOfTheSceneOpensFromTheStatusBar) {
    Screen s(1280, 720, 1);
    s.model.ignored = {"normal maps"};
    s.frame(2);
    s.clear();
    s.click("about-scene");
    EXPECT_EQ(s.everRequested.actions, std::vector<Action>{Action::aboutScene});
    s.model.aboutScene = true;
    s.frame(2);
    EXPECT_TRUE(s.has("panel:about-scene"));
    s.click("about-scene.close");
    EXPECT_FALSE(s.model.aboutScene);
}

TEST(Panels, TransportAsksForWhatItSays) {
    Screen s(1280, 720, 1);
    s.frame(2);
    for (const Action action : {Action::restart, Action::stepBackward, Action::playPause,
                                Action::stepForward, Action::slower, Action::faster}) {
        s.clear();
        s.click(idOf(infoOf(action)));
        EXPECT_EQ(s.everRequested.actions, std::vector<Action>{action});
    }
    s.drag("scrub", 100, 0);
    EXPECT_TRUE(s.everRequested.timeChanged);
    EXPECT_GT(s.model.timeS, 5);
    s.clear();
    s.click("bookmark-2");  // stored: goes there
    s.click("bookmark-3");  // empty: stores
    ImGui::GetIO().KeyCtrl = true;
    s.click("bookmark-1");
    ImGui::GetIO().KeyCtrl = false;
    EXPECT_EQ(s.everRequested.actions,
              (std::vector<Action>{Action::recallBookmark2, Action::storeBookmark3,
                                   Action::storeBookmark1}));
}

TEST(Panels, LightsAreMovedByRequest) {
    Screen s(1280, 1400, 1);
    s.frame(2);
    s.click("group:Lights");
    s.drag("light.1.position", 30, 0);
    ASSERT_FALSE(s.everRequested.lights.empty());
    EXPECT_EQ(s.everRequested.lights[0].light, 1u);
    EXPECT_TRUE(s.everRequested.lights[0].position);
    s.clear();
    s.click("light.1.reset");
    ASSERT_EQ(s.everRequested.lights.size(), 1u);
    EXPECT_TRUE(s.everRequested.lights[0].reset);
    EXPECT_FALSE(s.has("light.0.reset"));  // as the scene has it
}

TEST(Panels, TabsChooseTheInstrument) {
    Screen s(1280, 720, 1);
    s.model.instrument = Instrument::profiler;
    s.frame(2);
    s.click("tab:views");
    EXPECT_EQ(s.model.instrument, Instrument::views);
    s.click("views.pick-b");
    EXPECT_EQ(s.model.picking, Picking::viewB);
    s.click("tab:steps");
    s.click("next-step");
    EXPECT_EQ(s.everRequested.actions, std::vector<Action>{Action::stepTraversal});
    s.drag("step", 4000, 0);
    EXPECT_EQ(s.settings.inspect.step, 19);
    s.click("tab:pixel");
    s.click("pixel.pick");
    EXPECT_EQ(s.model.picking, Picking::pixel);
    s.click("tab:traversal");
    s.click("traversal.shares");
    s.click("tab:memory");
    s.click("dock.close");
    EXPECT_FALSE(s.model.instrument);
}

TEST(Panels, StepsAreFilteredExplainedAndBegunElsewhere) {
    Screen s(1280, 1000, 1);
    s.model.instrument = Instrument::steps;
    s.settings.inspect.step = 3;
    s.frame(2);
    InspectSettings& inspect = s.settings.inspect;
    s.click("outcome:culled");
    s.click("outcome:split-view");
    EXPECT_EQ(inspect.stepHidden, (std::array<bool, 6>{true, false, false, false, true, false}));
    s.click("outcome:culled");
    EXPECT_FALSE(inspect.stepHidden[0]);
    s.click("step-pairs");
    s.click("step-pairs=largest");
    EXPECT_EQ(inspect.stepPairs, StepPairs::largest);
    inspect.pairScene = 5;
    inspect.pairView = 2;
    s.click("steps.from-pair");
    EXPECT_EQ(inspect.step, 1);
    EXPECT_EQ(inspect.stepScene, 5);
    EXPECT_EQ(inspect.stepView, 2);
    s.click("steps.no-pair");
    EXPECT_FALSE(inspect.pairScene || inspect.pairView);
    s.click("steps.roots");
    EXPECT_EQ(inspect.stepScene + inspect.stepView, 0);
    for (const auto& [name, picking] : {std::pair{"steps.pick-scene", Picking::sceneNode},
                                        std::pair{"steps.pick-view", Picking::viewNode}}) {
        s.click(name);
        EXPECT_EQ(s.model.picking, picking);
        s.click(name);
        EXPECT_EQ(s.model.picking, Picking::none);
    }
    s.model.steps.picked.reset();
    s.frame(2);
    EXPECT_FALSE(s.has("steps.from-pair"));
}

// At any scale, of both views, on both faces.
TEST(Panels, ATexelUnderThePointerIsAskedForAndSaid) {
    for (const float scale : {1.0f, 1.5f, 2.0f}) {
        Screen s(2400, 2400, scale);
        s.model.instrument = Instrument::views;
        s.frame(2);
        for (const bool ofA : {true, false}) {
            const auto map = s.panels.findItem(ofA ? "map-a.picture" : "map-b.picture");
            ASSERT_TRUE(map);
            // 64 x 32 texels: the middle of some, on either face.
            for (const auto& [x, y] : {std::pair{0, 0}, {5, 20}, {31, 16}, {32, 16}, {63, 31}}) {
                ImGui::GetIO().MousePos = {
                    map->x + (static_cast<float>(x) + 0.5f) / 64 * map->width,
                    map->y + (static_cast<float>(y) + 0.5f) / 32 * map->height};
                s.frame();
                const MapPlace place{ofA, 0, x, y};
                ASSERT_EQ(s.model.views.hovered, place) << scale << " " << x << " " << y;
                EXPECT_TRUE(s.requests.redraw) << "what it says is known a frame later";
                EXPECT_FALSE(s.tooltip());
                s.model.views.texel = {place, "Front (+x)", {1, 0, 0}, "2 world units away"};
                s.frame(2);
                EXPECT_FALSE(s.requests.redraw);
                EXPECT_TRUE(s.tooltip());
                s.model.views.texel.reset();
                s.frame(2);
            }
        }
        s.pointAt(1200, 1200);
        EXPECT_FALSE(s.model.views.hovered);
    }
}

TEST(Panels, MapsAreColouredByWhatIsChosen) {
    Screen s(1280, 1400, 1);
    s.model.instrument = Instrument::views;
    s.frame(2);
    s.click("map-colours");
    s.click("map-colours=depth");
    EXPECT_EQ(s.settings.inspect.mapColours, MapQuantity::depth);
    s.settings.side[0].method = Method::ism;
    s.frame(2);
    EXPECT_FALSE(s.has("map-colours")) << "maps without pairs have depths alone";
}

TEST(Panels, TheProfilersBudgetIsDraggedAndItsFiguresFrozen) {
    Screen s(1280, 720, 1);
    s.model.instrument = Instrument::profiler;
    s.model.budgetMs = 100;
    s.panels.addFrame(s.statistics, {}, false);
    s.frame(2);
    s.click("profiler.plot");  // the middle of a scale that ends above the frame's 427 ms
    const double middle = s.model.budgetMs;
    EXPECT_NEAR(middle, 250, 5);
    s.drag("profiler.plot", 0, -30);
    EXPECT_GT(s.model.budgetMs, middle + 50);
    const auto drawnAfterFrames = [&] {  // each frame is a bar of the plot
        for (int i = 0; i < 50; ++i) s.panels.addFrame(s.statistics, {}, false);
        s.frame(2);
        return ImGui::GetDrawData()->TotalVtxCount;
    };
    s.click("profiler.freeze");
    s.pointAt(600, 400);
    const int frozen = ImGui::GetDrawData()->TotalVtxCount;
    EXPECT_EQ(drawnAfterFrames(), frozen);
    s.click("profiler.freeze");
    s.pointAt(600, 400);
    const int running = ImGui::GetDrawData()->TotalVtxCount;
    EXPECT_GE(drawnAfterFrames(), running + 50 * 4);
}

TEST(Panels, AnAnimationIsChosenAmongSeveral) {
    Screen s(1280, 720, 1);
    s.frame(2);
    EXPECT_FALSE(s.has("animation-choice"));
    s.model.animations = {"Walk", "Run"};
    s.frame(2);
    s.click("animation-choice");
    s.click("animation=1");
    EXPECT_EQ(s.settings.scene.animation, "1");
}

TEST(Panels, TheKeyboardAloneMovesThroughThem) {
    Screen s(1280, 720, 1);
    s.frame(2);
    ImGuiIO& io = ImGui::GetIO();
    io.KeyCtrl = true;  // Ctrl+Tab goes from part to part
    s.press(ImGuiKey_Tab);
    io.KeyCtrl = false;
    s.frame(2);
    s.press(ImGuiKey_DownArrow);
    EXPECT_TRUE(io.NavActive);
    EXPECT_TRUE(io.NavVisible);
    const ImGuiID before = ImGui::GetCurrentContext()->NavId;
    s.press(ImGuiKey_DownArrow);
    EXPECT_NE(ImGui::GetCurrentContext()->NavId, before);
}

TEST(Panels, HiddenMeansNothingButThePicture) {
    Screen s(1280, 720, 1);
    compareWith(s.settings, Method::manylods);
    s.statistics.methods.resize(2);
    s.model.hidden = true;
    s.model.instrument = Instrument::views;
    s.frame(3);
    EXPECT_EQ(s.panels.itemRects().size(), 1u);  // the picture
}

TEST(Panels, TheSplitIsDragged) {
    Screen s(1280, 720, 1);
    compareWith(s.settings, Method::manylods);
    s.statistics.methods.resize(2);
    s.frame(2);
    s.drag("split.handle", 94, 0);
    EXPECT_NEAR(s.settings.display.split, 0.6, 0.01);  // the picture is 940 pixels wide
    EXPECT_TRUE(s.has("plate:label-left"));
    s.model.otherSide = true;
    s.frame(2);
    EXPECT_FALSE(s.has("plate:label-left"));
    EXPECT_TRUE(s.has("plate:held"));
}

// A plate that it gave way to goes in the very frame in which the mouse comes.
TEST(Panels, APlateStaysUnderTheMouse) {
    Screen s(1280, 720, 1);
    s.model.tour = {"title", "text", true, true};
    s.model.outside = true;
    s.frame(3);
    const auto placed = [&] { return s.panels.findItem("plate:tour")->y; };
    const float before = placed();
    s.model.outside = false;
    s.point("tour.next");
    int steps = 0;
    for (const bool down : {true, false}) {
        ImGui::GetIO().MouseDown[0] = down;
        s.frame();
        EXPECT_EQ(placed(), before);
        steps += s.requests.tour;
    }
    EXPECT_EQ(steps, 1);
    s.pointAt(640, 300);
    EXPECT_GT(placed(), before + 10) << "where there is room again";
}

TEST(Panels, TheDifferencesRangeIsLocked) {
    Screen s(1280, 720, 1);
    compareWith(s.settings, Method::manylods);
    s.settings.display.difference = Difference::absolute;
    s.statistics.methods.resize(2);
    s.model.difference = Legend{"Difference", "", 0, 0.125, false, {{0, 0, 0}, {1, 1, 1}}, {}};
    s.frame(2);
    s.click("difference.lock");
    EXPECT_EQ(s.settings.display.differenceRange, 0.125);
    s.click("difference.lock");
    EXPECT_FALSE(s.settings.display.differenceRange);
}

TEST(Panels, ExactMapsAreAskedForAndGivenUp) {
    Screen s(1280, 720, 1);
    s.model.instrument = Instrument::errors;
    s.model.errors = {};
    s.frame(2);
    EXPECT_FALSE(s.has("maps.cancel"));
    s.click("map-views");
    s.click("map-views=256");
    EXPECT_EQ(s.model.errors.mapViews, 256);
    s.model.errors.maps = {{"MegaViews", {}, {{"Empty", "%", "Help.", false, {}}}, 0, {}}};
    s.model.errors.mapsWait = true;
    s.frame(2);
    s.click("maps.cancel");
    EXPECT_EQ(s.model.errors.mapViews, 0);
    EXPECT_FALSE(s.has("maps.cancel"));
    // A number of the command line is one more choice.
    s.model.errors.mapViews = 9;
    s.model.errors.mapsWait = false;
    s.frame(2);
    s.click("map-views");
    s.click("map-views=0");
    EXPECT_EQ(s.model.errors.mapViews, 0);
}

TEST(Panels, ErrorsStayUntilTheyAreClosed) {
    Screen s(1280, 720, 1);
    s.model.error = "no such file";
    s.model.errorHint = "/tmp/a.gltf";
    s.frame(4);
    EXPECT_TRUE(s.has("panel:error"));
    s.click("error.copy");
    EXPECT_NE(std::string(ImGui::GetClipboardText()).find("/tmp/a.gltf"), std::string::npos);
    EXPECT_FALSE(s.everRequested.errorDismissed);
    s.click("error.close");
    EXPECT_TRUE(s.everRequested.errorDismissed);
    s.frame(2);
    EXPECT_FALSE(s.has("panel:error"));
    s.model.error = "again";
    s.frame(4);
    s.clear();
    s.press(ImGuiKey_Escape);
    EXPECT_TRUE(s.everRequested.errorDismissed);
}

TEST(Panels, LoadingIsCancelled) {
    Screen s(1280, 720, 1);
    s.model.loadingStage = "reading";
    s.frame(3);
    s.click("loading.cancel");
    EXPECT_TRUE(s.everRequested.cancelLoading);
}

TEST(Panels, ToastsFadeAndGo) {
    Screen s(1280, 720, 1);
    s.model.toasts = {{"picture written: a.png"}};
    s.frame(60);
    EXPECT_FALSE(s.requests.redraw);  // nothing moves while it stands
    EXPECT_EQ(s.model.toasts.size(), 1u);
    s.frame(60 * 4 - 40);
    EXPECT_TRUE(s.requests.redraw);
    s.frame(60);
    EXPECT_TRUE(s.model.toasts.empty());
    EXPECT_FALSE(s.requests.redraw);
}

TEST(Panels, WarningsAreCountedInASmallWindow) {
    for (const int width : {420, 480, 560, 640, 800}) {
        Screen s(width, 360, 1);
        s.model.warnings = {"one", "two"};
        s.model.ignored.clear();
        s.model.notes.clear();
        s.model.software = true;
        s.model.draft = s.settings;
        s.model.atRest = false;
        s.frame(2);
        EXPECT_TRUE(s.has("about-scene")) << width;
    }
}

TEST(Panels, HelpIsSearchedAndActs) {
    Screen s(1280, 720, 1);
    s.model.help = true;
    s.frame(4);
    EXPECT_TRUE(s.has("help:open"));
    s.type("next camera");
    EXPECT_FALSE(s.has("help:open"));
    s.click("help:next-camera");
    EXPECT_EQ(s.everRequested.actions, std::vector<Action>{Action::nextCamera});
    s.press(ImGuiKey_Escape);
    s.press(ImGuiKey_Escape);
    EXPECT_FALSE(s.model.help);
}

// Else it hides what else there is to choose.
TEST(Panels, APathOfRecentFilesIsSaidBesideTheList) {
    Screen s(1280, 800, 2);
    s.model.recent[0].path = "/" + std::string(80, 'a') + "/" + std::string(80, 'b') + ".glb";
    s.frame(2);
    s.click("menu:File");
    s.point("menu:Open Recent");
    s.frame(30);
    for (const char* item : {"recent:0", "recent:1"}) {
        s.point(item);
        s.frame(4);
        const ImGuiWindow* tooltip = s.tooltip();
        ASSERT_TRUE(tooltip) << item;
        const ImRect said = tooltip->Rect();
        EXPECT_TRUE(ImRect({0, 0}, {1280, 800}).Contains(said)) << item;
        for (const char* other : {"recent:0", "recent:1"}) {
            const auto rect = s.panels.findItem(other);
            ASSERT_TRUE(rect);
            EXPECT_FALSE(
                said.Overlaps({rect->x, rect->y, rect->x + rect->width, rect->y + rect->height}))
                << item << " over " << other;
        }
    }
    s.model.recent[0].path = "/a.glb";
    s.point("recent:0");
    s.frame(4);
    EXPECT_FALSE(s.tooltip()) << "all of it is there";
}

TEST(Panels, RecentFilesAreOpenedUnlessMissing) {
    Screen s(1280, 720, 1);
    s.frame(2);
    s.click("menu:File");
    s.point("menu:Open Recent");
    s.frame(30);
    s.click("recent:1");
    EXPECT_EQ(s.everRequested.openFile, "");
    s.click("recent:0");
    EXPECT_EQ(s.everRequested.openFile, s.model.recent[0].path);
}

}  // namespace
}  // namespace mv::ui
