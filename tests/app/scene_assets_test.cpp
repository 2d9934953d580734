// Which of a file's scenes is loaded, and what is said of it.

#include "app/common/scene_assets.h"

#include <gtest/gtest.h>

#include "app/common/scene_report.h"
#include "app/temp_folder.h"
#include "megaviews/core/error.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

constexpr const char* kTwoScenes = R"({
    "asset": {"version": "2.0"}, "scene": 1,
    "extensionsUsed": ["KHR_lights_punctual", "KHR_something_else"],
    "scenes": [{"name": "day", "nodes": [0]}, {"nodes": [1]}],
    "nodes": [{"name": "sun", "extensions": {"KHR_lights_punctual": {"light": 0}}},
              {"name": "lamp", "extensions": {"KHR_lights_punctual": {"light": 1}}}],
    "extensions": {"KHR_lights_punctual": {"lights": [
        {"type": "directional", "name": "sun"}, {"type": "point", "name": "lamp"}]}}})";

TEST(SceneAssets, AreOfTheChosenSceneOfTheFile) {
    const test::TempFolder folder;
    const std::string file = folder.write("two.gltf", kTwoScenes);
    const auto lightOf = [&](const char* fileScene) {
        Settings settings;
        setFromText(settings, *findSetting("file-scene"), fileScene, "test");
        return loadAssetsWithoutHierarchy(file, settings, {})->scene.lights.at(0).name;
    };
    EXPECT_EQ(lightOf("default"), "lamp");
    EXPECT_EQ(lightOf("0"), "sun");
    EXPECT_EQ(lightOf("1"), "lamp");
    EXPECT_THROW(lightOf("2"), Error);
}

TEST(SceneAssets, SayWhatTheFileUsesAndWhatWasAdded) {
    const test::TempFolder folder;
    const Settings settings;
    const auto assets =
        loadAssetsWithoutHierarchy(folder.write("two.gltf", kTwoScenes), settings, {});
    const Scene& scene = assets->scene;
    EXPECT_EQ(scene.fileScenes, (std::vector<std::string>{"day", "scene 1"}));
    EXPECT_EQ(scene.extensions, std::vector<std::string>{"KHR_lights_punctual"});
    EXPECT_EQ(scene.ignored, std::vector<std::string>{"KHR_something_else"});
    ASSERT_EQ(scene.notes.size(), 1u) << "a camera was placed, no light";
    const std::string info = infoText(*assets, settings);
    for (const char* said : {"file scene  0, day", "extension   KHR_lights_punctual",
                             "not used    KHR_something_else", "note        no camera"}) {
        EXPECT_NE(info.find(said), std::string::npos) << said << "\n" << info;
    }
}

TEST(SceneAssets, SayThatTheFilesSunStandsInABlackSky) {
    const test::TempFolder folder;
    const std::string file = folder.write("two.gltf", kTwoScenes);
    const auto isSaid = [&](const char* fileScene, const char* environment) {
        Settings settings;
        setFromText(settings, *findSetting("file-scene"), fileScene, "test");
        setFromText(settings, *findSetting("environment"), environment, "test");
        const auto assets = loadAssetsWithoutHierarchy(file, settings, {});
        return assets->scene.notes.back().find("--environment sky") != std::string::npos;
    };
    EXPECT_TRUE(isSaid("0", "auto"));
    EXPECT_FALSE(isSaid("0", "none"));
    EXPECT_FALSE(isSaid("1", "auto")) << "a lamp";
}

TEST(SceneAssets, HaveTheMaterialsOfTheChosenVariant) {
    const test::TempFolder folder;
    const std::string file = folder.write("shoe.gltf", R"({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "extensionsUsed": ["KHR_materials_variants"],
        "extensions": {"KHR_materials_variants": {"variants": [{"name": "red"}, {}]}},
        "materials": [{"name": "own"}, {"name": "crimson"}, {"name": "blue"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0, "extensions": {
            "KHR_materials_variants": {"mappings": [
                {"material": 1, "variants": [0]}, {"material": 2, "variants": [1]}]}}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri":
            "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
    const auto materialOf = [&](const char* variant) {
        Settings settings;
        setFromText(settings, *findSetting("variant"), variant, "test");
        const auto assets = loadAssetsWithoutHierarchy(file, settings, {});
        EXPECT_NE(infoText(*assets, settings).find("variant     0, red\nvariant     1, variant 1"),
                  std::string::npos);
        return assets->scene.materials[assets->scene.triangleMaterials.at(0)].name;
    };
    EXPECT_EQ(materialOf(""), "own");
    EXPECT_EQ(materialOf("red"), "crimson");
    EXPECT_EQ(materialOf("0"), "crimson");
    EXPECT_EQ(materialOf("1"), "blue");
    EXPECT_EQ(materialOf("variant 1"), "blue");
    EXPECT_THROW(materialOf("green"), Error);
    Settings settings;
    settings.scene.variant = "red";
    EXPECT_THROW(loadAssetsWithoutHierarchy("builtin:cornell", settings, {}), Error);
}

}  // namespace
}  // namespace mv
