// Where things are: at every size and scale the parts of the window lie inside it and apart, main
// controls are in sight, no text is wider than its place, and every setting and action has its
// widget.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "megaviews/settings/actions.h"
#include "megaviews/settings/settings_table.h"
#include "screen.h"

namespace mv::ui {
namespace {

struct WindowSize {
    int width, height;
    float scale;
};
constexpr WindowSize kSizes[] = {{1000, 600, 1},     {1280, 720, 1},     {1280, 720, 1.5f},
                                 {1280, 720, 2},     {1920, 1080, 1.5f}, {2560, 1440, 1},
                                 {2560, 1440, 1.5f}, {2560, 1440, 2}};

std::string nameOf(const WindowSize& s) {
    return std::to_string(s.width) + "x" + std::to_string(s.height) + " at " +
           std::to_string(s.scale);
}

bool inside(const ItemRect& inner, const ItemRect& outer) {
    constexpr float kSlack = 1.01f;  // window positions are whole pixels
    return inner.x >= outer.x - kSlack && inner.y >= outer.y - kSlack &&
           inner.x + inner.width <= outer.x + outer.width + kSlack &&
           inner.y + inner.height <= outer.y + outer.height + kSlack;
}

bool overlap(const ItemRect& a, const ItemRect& b) {
    constexpr float kSlack = 1.01f;
    return a.x + kSlack < b.x + b.width && b.x + kSlack < a.x + a.width &&
           a.y + kSlack < b.y + b.height && b.y + kSlack < a.y + a.height;
}

void expectTidy(Screen& s, const std::string& what) {
    const ItemRect display{"display", 0, 0, static_cast<float>(s.width),
                           static_cast<float>(s.height)};
    std::vector<ItemRect> fixed;
    for (const ItemRect& item : s.panels.itemRects()) {
        if (!item.name.starts_with("panel:") && !item.name.starts_with("plate:")) continue;
        // Six plates at once have no room beside each other in 640 x 360.
        const bool roomy = static_cast<float>(s.height) >= 460 * s.scale;
        if (roomy && item.name.starts_with("plate:")) fixed.push_back(item);
        EXPECT_TRUE(inside(item, display)) << what << ": " << item.name << " at " << item.x << ","
                                           << item.y << " " << item.width << "x" << item.height;
        for (const char* part : {"menu", "controls", "dock", "status"}) {
            if (item.name == std::string("panel:") + part) fixed.push_back(item);
        }
    }
    for (std::size_t i = 0; i < fixed.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            EXPECT_FALSE(overlap(fixed[i], fixed[j]))
                << what << ": " << fixed[i].name << " and " << fixed[j].name;
        }
    }
    EXPECT_EQ(s.panels.clippedTexts(), std::vector<std::string>{}) << what;
    EXPECT_EQ(s.panels.outOfReach(), std::vector<std::string>{}) << what;
    const Viewport picture = pictureViewport(s.width, s.height, s.scale, s.model);
    EXPECT_GE(static_cast<float>(picture.width), 200 * s.scale) << what;
    EXPECT_GE(static_cast<float>(picture.height), 200 * s.scale) << what;
}

void compareMethods(Screen& s) {
    compareWith(s.settings, Method::manylods);
    s.statistics.methods.push_back(s.statistics.methods[0]);
}

constexpr Instrument kInstruments[] = {
    Instrument::profiler, Instrument::traversal, Instrument::memory, Instrument::views,
    Instrument::pixel,    Instrument::steps,     Instrument::errors};

TEST(Layout, PartsLieInsideAndApartAtEverySize) {
    for (const WindowSize& size : kSizes) {
        for (int instrument = -1; instrument < 7; ++instrument) {
            for (const bool comparing : {false, true}) {
                Screen s(size.width, size.height, size.scale);
                if (comparing) compareMethods(s);
                if (instrument >= 0) s.model.instrument = kInstruments[instrument];
                s.settings.inspect.pickA = 1204;
                s.settings.inspect.step = 3;
                s.frame(3);
                expectTidy(s, nameOf(size) + ", instrument " + std::to_string(instrument) +
                                  (comparing ? ", comparing" : ""));
                EXPECT_EQ(s.has("panel:dock"), instrument >= 0);
            }
        }
    }
}

TEST(Layout, TheScaleFitsTheWindow) {
    EXPECT_EQ(fittingScale(1280, 720, 1.5f), 1.5f);
    EXPECT_EQ(fittingScale(1280, 720, 2), 2);
    EXPECT_EQ(fittingScale(1280, 720, 3), 2);
    EXPECT_EQ(fittingScale(800, 1000, 2), 1.25f);
    EXPECT_EQ(fittingScale(1200, 360, 2), 1);
    EXPECT_EQ(fittingScale(300, 200, 3), 1);
    EXPECT_EQ(fittingScale(300, 200, 0.5f), 0.5f);
    EXPECT_EQ(fittingScale(1285, 900, 8), 2);  // in steps
}

TEST(Layout, OverlaysLieInsideAtEverySize) {
    for (const WindowSize& size : kSizes) {
        const auto with = [&](const char* what, auto prepare) {
            Screen s(size.width, size.height, size.scale);
            prepare(s);
            s.frame(5);
            expectTidy(s, nameOf(size) + ", " + what);
        };
        with("help", [](Screen& s) { s.model.help = true; });
        with("commands", [](Screen& s) { s.model.palette = true; });
        with("about the scene", [](Screen& s) {
            s.model.aboutScene = true;
            s.model.warnings.assign(
                40, "a warning that is long enough to be wrapped " + std::string(80, 'w'));
        });
        for (const bool docked : {false, true}) {
            with("tour", [docked](Screen& s) {
                if (docked) s.model.instrument = Instrument::views;
                s.model.tour = {"2 of 5: one map a view", std::string(60, 't'), true, true};
                for (int i = 0; i < 25; ++i) s.model.tour->text += " some words";
            });
            with("commands beside a dock", [docked](Screen& s) {
                if (docked) s.model.instrument = Instrument::views;
                s.model.palette = true;
            });
        }
        with("steps and picked views of both sides", [](Screen& s) {
            compareMethods(s);
            s.model.instrument = Instrument::steps;
            s.settings.inspect.step = 3;
            const Legend legend{"Traversal step", "", 0, 1, false, {}, std::vector<LegendEntry>(9)};
            s.model.legends = {legend, {"Picked views", "", 0, 1, false, {}, {{}, {}, {}}}};
        });
        with("browser", [](Screen& s) {
            s.model.browse = Browse::open;
            s.model.browseFolder = MEGAVIEWS_SOURCE_DIR;
        });
        with("error", [](Screen& s) {
            s.model.error = std::string(400, 'x') + " " + std::string(300, 'y');
            s.model.errorHint = "Try another one.";
        });
        with("start page", [](Screen& s) {
            s.model.start = true;
            for (const char* scene : {"builtin:a", "builtin:b", "builtin:c", "builtin:d"}) {
                s.model.startTiles.push_back({scene, {}});
            }
            s.model.recent = {{"/home/somebody/" + std::string(200, 'r') + ".glb", true}};
            s.model.startFound = {"/home/somebody/" + std::string(200, 'f') + ".gltf"};
        });
        with("a picture under way", [](Screen& s) {
            s.model.work = Work{"gather", 0.43f, 12, 40};
            s.model.draft = s.settings;
        });
        with("a draft that is enough", [](Screen& s) {
            s.model.settled = true;
            s.model.draft = s.settings;
        });
        with("loading, toasts, shaders", [](Screen& s) {
            s.model.loadingStage = "building the octree of a scene with a rather long stage name";
            s.model.toasts = {{std::string(200, 't')}, {"short"}};
            for (int i = 0; i < 3; ++i) {
                s.model.shaderErrors.push_back("shaders/passes/gather.frag:" + std::to_string(i) +
                                               ": undeclared");
            }
            s.model.legends = {{"Sharing", "views", 1, 512, true, {{0, 0, 0}, {1, 1, 1}}, {}}};
        });
        with("all that stands over the picture", [](Screen& s) {
            compareMethods(s);
            s.model.instrument = Instrument::profiler;
            s.model.toasts = {{"picture written: /home/somebody/megaviews-1.png"}, {"short"}};
            s.model.shaderErrors = {"shaders/passes/gather.frag:12: undeclared"};
            s.model.legends = {{"Sharing", "views", 1, 512, true, {{0, 0, 0}, {1, 1, 1}}, {}}};
        });
        with("difference, legend and toast", [](Screen& s) {
            compareMethods(s);
            s.settings.display.difference = Difference::signedValue;
            s.model.instrument = Instrument::traversal;
            s.model.toasts = {{"picture written: /home/somebody/megaviews-1.png"}};
            s.model.difference =
                Legend{"Right minus left", "", -1, 1, false, {{0, 0, 0}, {1, 1, 1}}, {}};
            s.model.legends = {{"Sharing", "views", 1, 512, true, {{0, 0, 0}, {1, 1, 1}}, {}}};
        });
        with("difference", [](Screen& s) {
            compareMethods(s);
            s.settings.display.difference = Difference::relative;
            s.model.difference =
                Legend{"Relative difference", "", 0, 0.25, false, {{0, 0, 0}, {1, 1, 1}}, {}};
        });
    }
}

TEST(Layout, EveryMenuAndSectionIsReachedAtEverySize) {
    std::set<std::string> menus;
    for (const ActionInfo& action : actionsTable())
        menus.insert("menu:" + std::string(action.menu));
    for (const WindowSize& size : kSizes) {
        for (const bool comparing : {false, true}) {
            Screen s(size.width, size.height, size.scale);
            if (comparing) compareMethods(s);
            s.settings.display.difference = Difference::absolute;
            s.model.preset = "paper-megaviews";
            s.model.lightsOpen = true;
            for (int i = 0; i < 20; ++i) s.model.recent.push_back({std::string(99, 'r'), true});
            s.frame(2);
            for (const std::string& menu : menus) {
                s.click(menu);
                expectTidy(s, nameOf(size) + ", " + menu);
                s.press(ImGuiKey_Escape);
            }
            for (const char* group :
                 {"Instruments", "Picture", "Gather", "Views", "Method", "Scene", "Lights"}) {
                s.show(std::string("group:") + group);
                s.click(std::string("group:") + group);
                expectTidy(s, nameOf(size) + ", " + group);
            }
        }
    }
}

TEST(Layout, AWindowWithoutRoomForTheControlsSaysSo) {
    Screen s(360, 300, 1);
    s.frame(2);
    EXPECT_FALSE(s.has("panel:controls"));
    EXPECT_TRUE(s.has("no-room"));
    EXPECT_EQ(pictureViewport(360, 300, 1, s.model).width, 360);
}

TEST(Layout, MainControlsAreInSightWithoutScrolling) {
    for (const bool docked : {false, true}) {
        Screen s(1280, 720, 1);
        if (docked) s.model.instrument = Instrument::profiler;
        s.frame(3);
        const auto panel = s.panels.findItem("panel:controls");
        ASSERT_TRUE(panel);
        for (const char* name :
             {"preset", "play-or-pause", "step-forward", "scrub", "camera", "bookmark-9", "method",
              "traversal", "rules", "view-res", "side-by-side", "vpls", "bounces", "gather-samples",
              "accumulate", "filter", "view", "exposure", "tonemap"}) {
            const auto item = s.panels.findItem(name);
            ASSERT_TRUE(item) << name;
            EXPECT_TRUE(inside(*item, *panel)) << name;
        }
    }
}

TEST(Layout, AWindowTooNarrowForAllShowsTheDockInsteadOfTheControls) {
    Screen s(1280, 720, 2);
    s.model.instrument = Instrument::traversal;
    s.frame(2);
    EXPECT_TRUE(s.has("panel:dock"));
    EXPECT_FALSE(s.has("panel:controls"));
    EXPECT_GE(pictureViewport(1280, 720, 2, s.model).width, 400);
    s.click("dock.close");
    EXPECT_FALSE(s.model.instrument);
    EXPECT_TRUE(s.has("panel:controls"));
}

TEST(Layout, ThePictureTakesWhatIsLeft) {
    Model model;
    const Viewport whole = pictureViewport(1280, 720, 1, model);
    model.instrument = Instrument::memory;
    const Viewport docked = pictureViewport(1280, 720, 1, model);
    EXPECT_EQ(whole.x, 0);
    EXPECT_GT(docked.x, 300);
    EXPECT_EQ(docked.x + docked.width, whole.x + whole.width);
    EXPECT_EQ(docked.height, whole.height);
    model.hidden = true;
    const Viewport hidden = pictureViewport(1280, 720, 1, model);
    EXPECT_EQ(hidden.width, 1280);
    EXPECT_EQ(hidden.height, 720);
    for (const int tiny : {0, 1, 10}) {  // a window being made smaller than any of its parts
        model.hidden = false;
        EXPECT_GE(pictureViewport(tiny, tiny, 2, model).width, 1);
        EXPECT_GE(pictureViewport(tiny, tiny, 2, model).height, 1);
    }
}

TEST(Layout, EverySettingHasAWidget) {
    Screen s(1280, 4000, 1);
    compareMethods(s);
    s.settings.display.difference = Difference::absolute;
    s.frame(2);
    for (const char* group : {"Scene", "Method", "Views", "Gather", "Picture", "Instruments"}) {
        s.click(std::string("group:") + group);
    }
    for (const SettingInfo& setting : settingsTable()) {
        EXPECT_TRUE(s.has(std::string(setting.key))) << setting.key;
    }
}

TEST(Layout, EveryActionIsReachedFromItsMenu) {
    Screen s(1280, 720, 1);
    s.model.bookmarks.fill(true);
    s.model.canUndo = s.model.canRedo = true;
    compareMethods(s);
    s.frame(2);
    for (const ActionInfo& action : actionsTable()) {
        ASSERT_FALSE(action.menu.empty()) << action.name;
        s.click("menu:" + std::string(action.menu));
        s.clear();
        s.click(idOf(action));
        EXPECT_EQ(s.everRequested.actions, std::vector<Action>{action.action}) << action.name;
        s.pointAt(600, 400);
        s.press(ImGuiKey_Escape);
    }
}

TEST(Layout, NothingIsDrawnOfADockThatIsClosed) {
    Screen s(1280, 720, 1);
    s.frame(2);
    for (const ItemRect& item : s.panels.itemRects()) {
        EXPECT_FALSE(item.name.starts_with("tab:") || item.name.starts_with("views.")) << item.name;
    }
}

TEST(Layout, EmptyDataIsDrawnToo) {
    for (int instrument = -1; instrument < 7; ++instrument) {
        Screen s(1000, 600, 1);
        s.model = {};
        s.statistics = {};
        s.settings = {};
        compareWith(s.settings, Method::none);  // asked for, not rendered yet
        if (instrument >= 0) s.model.instrument = kInstruments[instrument];
        s.frame(3);
        expectTidy(s, "empty, instrument " + std::to_string(instrument));
    }
}

}  // namespace
}  // namespace mv::ui
