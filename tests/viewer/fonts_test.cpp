// Names that the built-in font cannot write: glyphs come from its further characters or from fonts
// of the system, and only then.

#include <gtest/gtest.h>
#include <imgui.h>

#include <filesystem>
#include <string>

#include "app/temp_folder.h"
#include "app/viewer/system_fonts.h"
#include "scene/gltf_builder.h"
#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

constexpr char32_t kNowhere = 0xe123;  // private use: no font that is right has it

const ImFont& font() { return *ImGui::GetIO().Fonts->Fonts[0]; }

bool drawn(const std::u32string& text) {
    for (const char32_t c : text) {
        if (!font().FindGlyphNoFallback(static_cast<ImWchar>(c))) return false;
    }
    return true;
}

// A lit square in a file of this name, with names for a camera and two lights.
std::string sceneFile(const test::TempFolder& folder, const std::string& name) {
    testing::GltfBuilder builder = testing::GltfBuilder::square();
    builder.json["extensionsUsed"] = {"KHR_lights_punctual"};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"name", "Лампа"}, {"intensity", 10}},
        {{"type", "point"}, {"name", "主光源"}, {"intensity", 10}}};
    builder.json["cameras"] = {{{"type", "perspective"},
                                {"name", "カメラ"},
                                {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    builder.node({{"camera", 0}, {"name", "カメラ"}, {"translation", {0.5, 0.5, 2}}});
    for (const int light : {0, 1}) {
        builder.node({{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}},
                      {"name", light == 0 ? "Лампа" : "主光源"},
                      {"translation", {light, 0, 1}}});
    }
    const testing::Bytes bytes = builder.glb();
    return folder.write(name, {bytes.begin(), bytes.end()});
}

class FontsTest : public ViewerTest {
  protected:
    void SetUp() override {
        ViewerTest::SetUp();
        if (systemFonts({U'日'}).empty()) GTEST_SKIP() << "no font of the system has Japanese";
    }
};

TEST_F(FontsTest, NamesOfSceneCameraAndLightsAreLegible) {
    const test::TempFolder folder;
    const std::string file = sceneFile(folder, "日本語シーン.glb");
    Viewer viewer(640, 900, Viewer::smallSettings(), file);
    viewer.frame();
    EXPECT_TRUE(drawn(U"日本語シーンカメラ主光源"));
    EXPECT_TRUE(drawn(U"Лампа"));
    EXPECT_TRUE(font().FindGlyph(U'日')->Visible);
    EXPECT_NE(font().FindGlyph(U'日'), font().FallbackGlyph);
    EXPECT_EQ(viewer.session->imgui().fontSearches(), 1) << "one search for all of them";
    EXPECT_TRUE(ImGui::GetIO().Fonts->Fonts[1]->FindGlyphNoFallback(U'日')) << "titles too";
    // Another size keeps them, and is drawn.
    viewer.run("larger-interface; wait 2");
    EXPECT_TRUE(drawn(U"日本語"));
    EXPECT_EQ(viewer.session->imgui().fontSearches(), 1);
}

TEST_F(FontsTest, FilesInTheBrowserAndWhatIsTypedAreLegible) {
    const test::TempFolder folder;
    folder.write("日本語/漢字.json", "{}");
    Viewer viewer;
    ASSERT_FALSE(drawn(U"日"));
    viewer.run("open; wait 2; type " + folder.file("日本語") + "; wait 1; key Enter; wait 2");
    EXPECT_TRUE(drawn(U"日本語漢字"));
    viewer.run("type 中文; wait 1");
    EXPECT_TRUE(drawn(U"中文"));
    const int searches = viewer.session->imgui().fontSearches();
    viewer.run("key Enter; wait 3");  // "there is no file", with its name
    EXPECT_EQ(viewer.session->imgui().fontSearches(), searches);
}

TEST_F(FontsTest, WhatNoFontHasIsABoxAndAskedForOnce) {
    Viewer viewer;
    viewer.run("open; wait 2; type \xee\x84\xa3; wait 3; type \xee\x84\xa3; wait 3");
    EXPECT_FALSE(drawn({kNowhere}));
    EXPECT_TRUE(font().FallbackGlyph->Visible);
    EXPECT_EQ(font().FallbackChar, 0xfffd);
    EXPECT_EQ(viewer.session->imgui().fontSearches(), 1);
}

class NoFontsTest : public ViewerTest {};

TEST_F(NoFontsTest, LatinAloneAsksForNoFontAndGrowsNothing) {
    Viewer viewer;
    const ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    const int width = atlas.TexWidth, height = atlas.TexHeight, glyphs = font().Glyphs.size();
    viewer.run("key Ctrl+K; wait 2; type Größe; wait 1; key Escape; wait 1; views; errors; wait 2");
    EXPECT_EQ(viewer.session->imgui().fontSearches(), 0);
    EXPECT_EQ(atlas.TexWidth, width);
    EXPECT_EQ(atlas.TexHeight, height);
    EXPECT_EQ(font().Glyphs.size(), glyphs);
    // The built-in font has Greek and Cyrillic: more glyphs, still nothing of the system's.
    viewer.run("open; wait 2; type Лампа; wait 2");
    EXPECT_TRUE(drawn(U"Лампа"));
    EXPECT_GT(font().Glyphs.size(), glyphs);
    EXPECT_EQ(viewer.session->imgui().fontSearches(), 0);
}

TEST_F(NoFontsTest, AnotherScaleIsDrawn) {
    Viewer viewer;
    viewer.run("pause-rendering; wait 2");
    const auto lit = [&] {
        const auto bytes = viewer.pixels();
        std::size_t bright = 0;  // texts of the menu bar, in the last rows of the picture
        for (std::size_t p = bytes.size() - 640 * 4 * 20; p < bytes.size(); p += 4) {
            bright += bytes[p] > 150;
        }
        return bright;
    };
    ASSERT_GT(lit(), 100u);
    viewer.run("larger-interface; wait 2");
    EXPECT_GT(lit(), 100u);
}

}  // namespace
}  // namespace mv
