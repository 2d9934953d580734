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

}  // namespace
}  // namespace mv
