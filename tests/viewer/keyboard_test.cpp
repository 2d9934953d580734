// The window by the keyboard alone: every panel, list, dialog and menu, and back to the picture.

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <cmath>
#include <functional>

#include "app/common/user_state.h"
#include "app/temp_folder.h"
#include "app/viewer/key_bindings.h"
#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

class KeyboardTest : public ViewerTest {};

// A viewer whose mouse is not there.
class Keys : public Viewer {
  public:
    using Viewer::Viewer;

    void key(const std::string& chord) { run("key " + chord + "; wait 2"); }
    static const ImGuiContext& gui() { return *ImGui::GetCurrentContext(); }
    static std::string window() {
        return gui().NavWindow ? gui().NavWindow->RootWindow->Name : std::string();
    }
    bool onPicture() const { return !session->imgui().takesKeyboard(); }

    void press(int code, int modifiers, bool pressed) {
        session->input().push(KeyChanged{code, modifiers, pressed});
        frames(2);
    }
    void alt() {
        press(GLFW_KEY_LEFT_ALT, GLFW_MOD_ALT, true);
        press(GLFW_KEY_LEFT_ALT, 0, false);
        frames(2);
    }
    // Ctrl+Tab until the window has the keyboard.
    void enter(const std::string& wanted) {
        for (int tabs = 1; tabs < 8 && window() != wanted; ++tabs) {
            press(GLFW_KEY_LEFT_CONTROL, GLFW_MOD_CONTROL, true);
            for (int i = 0; i < tabs; ++i) {
                press(GLFW_KEY_TAB, GLFW_MOD_CONTROL, true);
                press(GLFW_KEY_TAB, GLFW_MOD_CONTROL, false);
            }
            press(GLFW_KEY_LEFT_CONTROL, 0, false);
            frames(2);
        }
        ASSERT_EQ(window(), wanted);
    }
    // Back to the picture.
    void leave() {
        for (int i = 0; i < 3 && !onPicture(); ++i) key("Escape");
        EXPECT_TRUE(onPicture());
    }
    // Of what has it.
    static ImRect place() {
        ImGuiWindow* in = gui().NavWindow;
        return ImGui::WindowRectRelToAbs(in, in->NavRectRel[gui().NavLayer]);
    }
    // Arrows until the named item has the keyboard.
    void reach(const std::string& name) {
        for (int i = 0; i < 60; ++i) {
            const auto item = session->interface().findItem(name);
            ASSERT_TRUE(item) << "there is no " << name;
            ASSERT_TRUE(gui().NavWindow) << name;
            const ImRect at = place();
            const float x = item->centerX() - at.GetCenter().x;
            const float y = item->centerY() - at.GetCenter().y;
            if (gui().NavId != 0 && std::abs(y) < 5 && std::abs(x) < item->width / 2) return;
            if (std::abs(y) < 5) {
                key(x > 0 ? "Right" : "Left");
            } else {
                key(y > 0 ? "Down" : "Up");
            }
        }
        FAIL() << name << " is not reached; the keyboard is in " << window();
    }
    void use(const std::string& name) {
        reach(name);
        if (::testing::Test::HasFatalFailure()) return;
        key("Space");
    }
    // Through the menu bar to an entry.
    void menu(const std::string& entry, const std::string& menu, const std::string& inner = {}) {
        key("F10");
        reach("menu:" + menu);
        key("Down");
        if (!inner.empty()) {
            reach("menu:" + inner);
            key("Right");
        }
        use(entry);
    }
};

TEST_F(KeyboardTest, AltAndF10OpenTheMenus) {
    Keys viewer;
    const auto f10 = [&] { viewer.key("F10"); };
    const auto alt = [&] { viewer.alt(); };
    for (const auto& way : std::initializer_list<std::function<void()>>{f10, alt}) {
        way();
        EXPECT_EQ(Keys::window(), "##MainMenuBar");
        way();
        EXPECT_NE(Keys::window(), "##MainMenuBar") << "a second time leaves it";
        EXPECT_TRUE(viewer.onPicture());
    }
    viewer.key("Alt+Up");
    EXPECT_NE(Keys::window(), "##MainMenuBar") << "Alt with another key is no menu";
    viewer.menu("profiler", "Instruments");
    EXPECT_EQ(viewer.model().instrument, ui::Instrument::profiler);
    viewer.menu("open:builtin:hairball", "File", "Scenes");
    viewer.run("wait-loading; wait 2");
    EXPECT_EQ(viewer.model().sceneName, "builtin:hairball");
    viewer.leave();
}

TEST_F(KeyboardTest, ARecentFileIsOpenedFromTheMenu) {
    const test::TempFolder folder;
    updateUserState(folder.file("viewer.json"),
                    [](UserState& state) { state.noteRecent("builtin:hairball"); });
    Keys viewer(640, 400, Viewer::smallSettings(), "builtin:cornell", 1,
                folder.file("viewer.json"));
    ASSERT_EQ(viewer.model().recent.size(), 2u);
    viewer.menu("recent:1", "File", "Open Recent");
    viewer.run("wait-loading; wait 2");
    EXPECT_EQ(viewer.model().sceneName, "builtin:hairball");
}

TEST_F(KeyboardTest, ControlsAreChanged) {
    Keys viewer(640, 500);
    viewer.run("pause-rendering; wait 2");
    viewer.enter("controls");
    viewer.use("preset");
    viewer.use("preset-fast");
    EXPECT_EQ(viewer.model().preset, "fast");
    const auto vpls = viewer.settings().views.vpls;
    viewer.use("vpls");
    viewer.key("Right");
    viewer.key("Space");
    EXPECT_GT(viewer.settings().views.vpls, vpls);
    viewer.reach("vpls");
    viewer.key("Enter");
    viewer.run("type 3K; wait 1; key Enter; wait 2");
    EXPECT_EQ(viewer.settings().views.vpls, 3072);
    const bool filter = viewer.settings().gather.filter;
    viewer.use("filter");
    EXPECT_NE(viewer.settings().gather.filter, filter);
    viewer.use("group:Views");
    viewer.reach("particles");
    viewer.leave();
    viewer.key("P");
    EXPECT_EQ(viewer.model().instrument, ui::Instrument::profiler);
}

TEST_F(KeyboardTest, EveryInstrumentIsUsed) {
    Keys viewer(1000, 600);
    viewer.run("wait-still; pause-rendering; wait 2");
    viewer.key("P");
    viewer.enter("dock");
    viewer.use("profiler.freeze");
    viewer.use("tab:traversal");
    EXPECT_EQ(viewer.model().instrument, ui::Instrument::traversal);
    viewer.run("pause-rendering; wait-still; pause-rendering; wait 2");  // levels are counted
    viewer.use("traversal.shares");
    viewer.use("tab:memory");
    viewer.use("gpu-memory");
    viewer.key("Right");
    viewer.key("Space");
    EXPECT_NE(viewer.settings().side[0].maps.memoryMiB, Settings().side[0].maps.memoryMiB);
    viewer.use("tab:views");
    viewer.reach("show-views");
    viewer.key("Down");   // the list
    viewer.key("Space");  // into it
    viewer.key("Space");
    EXPECT_TRUE(viewer.settings().inspect.pickA);
    viewer.use("tab:errors");
    viewer.use("map-views");
    viewer.use("map-views=64");
    EXPECT_EQ(viewer.model().errors.mapViews, 64);
    viewer.use("tab:steps");
    viewer.use("next-step");
    EXPECT_EQ(viewer.settings().inspect.step, 1);
    viewer.use("tab:pixel");
    viewer.use("pixel.pick");
    EXPECT_EQ(viewer.model().picking, ui::Picking::pixel);
    viewer.leave();
    viewer.key("Enter");  // the middle of the picture
    ASSERT_TRUE(viewer.model().pixel.picked);
    EXPECT_NEAR(viewer.model().pixel.picked->x, viewer.settings().resolution.width / 2, 1);
    viewer.key("I");
    EXPECT_FALSE(viewer.model().instrument);
}

TEST_F(KeyboardTest, DialogsAreAnswered) {
    const test::TempFolder folder;
    folder.write("one.json", "{}");
    Keys viewer;
    const auto open = [&] { return viewer.session->imgui().popupOpen(); };
    for (const char* answer : {"Escape", "Enter"}) {
        viewer.run("drop no-such-file.glb; wait 3");
        ASSERT_NE(viewer.model().error, "");
        viewer.key(answer);
        EXPECT_EQ(viewer.model().error, "") << answer;
        EXPECT_FALSE(open());
        viewer.run("about-the-scene; wait 3");
        ASSERT_TRUE(viewer.model().aboutScene);
        viewer.key(answer);
        EXPECT_FALSE(viewer.model().aboutScene) << answer;
        EXPECT_FALSE(open());
    }
    viewer.key("F1");
    viewer.run("type fil; wait 1");
    EXPECT_TRUE(viewer.model().help);
    viewer.key("Escape");
    EXPECT_FALSE(viewer.model().help);
    viewer.key("Ctrl+K");
    viewer.key("Escape");
    EXPECT_FALSE(viewer.model().palette);
    viewer.key("Ctrl+O");
    viewer.key("Escape");
    EXPECT_EQ(viewer.model().browse, ui::Browse::none);
    EXPECT_FALSE(open());
    // Beyond the path that has the keyboard first: its buttons.
    viewer.run("open; wait 2; type " + folder.file("") + "; wait 1; key Enter; wait 2");
    viewer.key("Tab");  // the only name
    viewer.key("Tab");  // nothing to complete: on to the buttons
    viewer.use("browser.all");
    viewer.use("browser.cancel");
    EXPECT_EQ(viewer.model().browse, ui::Browse::none);
}

TEST_F(KeyboardTest, TheTourIsTaken) {
    Keys viewer(800, 480);
    viewer.run("pause-rendering; tour; wait-loading; wait 12");
    ASSERT_TRUE(viewer.model().tour);
    viewer.enter("tour");
    viewer.use("tour.next");
    viewer.run("wait 16");
    EXPECT_NE(viewer.model().tour->title.find("2 of"), std::string::npos);
    viewer.use("tour.leave");
    EXPECT_FALSE(viewer.model().tour);
}

TEST_F(KeyboardTest, KeysFlyOnceThePictureHasThemBack) {
    Keys viewer;
    viewer.enter("controls");
    const auto before = viewer.model().camera.position;
    viewer.run("hold W; wait 5; release W; wait 2");
    EXPECT_EQ(viewer.model().camera.position, before) << "the keyboard is the panel's";
    viewer.key("Escape");
    viewer.run("hold W; wait 5; release W; wait 2");
    EXPECT_NE(viewer.model().camera.position, before);
    viewer.key("Left");
    EXPECT_TRUE(viewer.onPicture()) << "arrows are the picture's, too";
}

// X11 reports what was held before the key.
TEST(KeyBindings, ModifiersKnowTheirOwnKey) {
    EXPECT_EQ(modifiersAfter(GLFW_KEY_LEFT_CONTROL, 0, true), GLFW_MOD_CONTROL);
    EXPECT_EQ(modifiersAfter(GLFW_KEY_LEFT_CONTROL, GLFW_MOD_CONTROL, false), 0);
    EXPECT_EQ(modifiersAfter(GLFW_KEY_RIGHT_ALT, GLFW_MOD_SHIFT, true),
              GLFW_MOD_SHIFT | GLFW_MOD_ALT);
    EXPECT_EQ(modifiersAfter(GLFW_KEY_TAB, GLFW_MOD_CONTROL, false), GLFW_MOD_CONTROL);
}

}  // namespace
}  // namespace mv
