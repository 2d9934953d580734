#include "ui/file_browser.h"

#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <filesystem>
#include <fstream>

#include "screen.h"

namespace mv::ui {
namespace {

class Browsing : public ::testing::Test {
  protected:
    void SetUp() override {
        folder = std::filesystem::temp_directory_path() / "megaviews-browser-test";
        std::filesystem::remove_all(folder);
        std::filesystem::create_directories(folder / "inner");
        for (const char* name : {"b.gltf", "a.glb", "notes.txt", "inner/c.gltf"}) {
            std::ofstream(folder / name) << "x";
        }
    }
    void TearDown() override { std::filesystem::remove_all(folder); }
    std::filesystem::path folder;
};

TEST_F(Browsing, ChoosesAFileWithTheMouse) {
    Screen s(1280, 720, 1);
    s.model.browse = Browse::open;
    s.model.browseFolder = folder.string();
    s.frame(4);
    EXPECT_TRUE(s.has("file:a.glb"));
    EXPECT_FALSE(s.has("file:notes.txt"));
    s.click("browser.all");
    EXPECT_TRUE(s.has("file:notes.txt"));
    s.doubleClick("file:inner");
    EXPECT_TRUE(s.has("file:c.gltf"));
    s.click("browser.parent");
    s.click("file:b.gltf");
    EXPECT_EQ(s.everRequested.openFile, "");
    s.click("browser.accept");
    EXPECT_EQ(s.everRequested.openFile, (folder / "b.gltf").string());
    EXPECT_EQ(s.model.browse, Browse::none);
    EXPECT_EQ(s.model.browseFolder, folder.string());
    s.frame(2);
    EXPECT_FALSE(s.has("panel:browser"));
}

TEST_F(Browsing, SaysWhichFileWouldBeReplaced) {
    FileBrowser browser;
    browser.open(Browse::saveScene, folder.string());
    EXPECT_TRUE(browser.replaces("a.glb"));
    EXPECT_TRUE(browser.replaces("a")) << "which gets the extension";
    EXPECT_TRUE(browser.replaces((folder / "a").string()));
    for (const char* name : {"", "b", "b.gltf", "inner"}) EXPECT_FALSE(browser.replaces(name));
    EXPECT_EQ(browser.choose("b.gltf"), (folder / "b.gltf.glb").string());
    EXPECT_EQ(browser.choose("B.GLB"), (folder / "B.GLB").string());
    EXPECT_EQ(browser.choose("none/a"), "");
    EXPECT_NE(browser.problem().find("no folder"), std::string::npos);
    browser.open(Browse::open, folder.string());
    EXPECT_FALSE(browser.replaces("a.glb"));
}

TEST_F(Browsing, WaitsForAnErrorToBeClosed) {
    Screen s(1280, 720, 1);
    s.model.browse = Browse::open;
    s.model.browseFolder = folder.string();
    s.frame(4);
    s.model.error = "this file is broken";
    s.frame(4);
    EXPECT_TRUE(s.has("panel:error"));
    EXPECT_FALSE(s.has("panel:browser"));
    s.click("error.close");
    s.frame(4);
    EXPECT_TRUE(s.has("panel:browser"));
}

TEST_F(Browsing, AcceptsATypedPathAndRefusesAMissingOne) {
    Screen s(1280, 720, 1);
    s.model.browse = Browse::loadState;
    s.model.browseFolder = folder.string();
    s.frame(4);
    s.click("browser.path");
    s.type("nothing.json");
    s.press(ImGuiKey_Enter);
    EXPECT_EQ(s.everRequested.loadState, "");
    EXPECT_EQ(s.model.browse, Browse::loadState);
    s.click("browser.cancel");
    s.model.browse = Browse::saveState;
    s.frame(4);
    s.click("browser.path");
    s.type("mine");
    s.click("browser.accept");
    EXPECT_EQ(s.everRequested.saveState, (folder / "mine.json").string());
    s.model.browse = Browse::saveScene;
    s.frame(4);
    s.click("browser.path");
    s.type("mine.v2");
    s.click("browser.accept");
    EXPECT_EQ(s.everRequested.saveScene, (folder / "mine.v2.glb").string());
    s.model.browse = Browse::open;
    s.frame(4);
    s.press(ImGuiKey_Escape);
    s.press(ImGuiKey_Escape);
    EXPECT_EQ(s.model.browse, Browse::none);
}

}  // namespace
}  // namespace mv::ui
