// A state comes back as it was saved, bit by bit where a picture depends on it; whatever else is in
// the file is refused by name.

#include "app/common/state.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "app/temp_folder.h"
#include "megaviews/core/error.h"
#include "megaviews/settings/presets.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

using test::TempFolder;

std::string noPictures(const std::string& file) {
    throw Error(ExitCode::input, file + ": no pictures here");
}

State sample() {
    State state;
    state.scene = "builtin:cornell";
    state.sceneHash = "abc";
    applyPreset(state.settings, *findPreset("paper-manylods"));
    compareWith(state.settings, Method::none);
    state.settings.camera.position = {{1.0 / 3, -2e-7, 1e9}};
    state.settings.camera.target = {{0, 0.1, 0.2}};
    state.settings.display.exposureEv = -0.1;
    state.settings.scene.timeS = 1.1;
    state.playing = true;
    state.speed = 0.25;
    return state;
}

TEST(State, ComesBackAsItWas) {
    const TempFolder folder;
    for (const State& state : {State(), sample()}) {
        EXPECT_EQ(stateFromText(toText(state), "x"), state);
        saveState(folder.file("s.json"), state);
        EXPECT_EQ(loadState(folder.file("s.json"), noPictures), state);
        // One line of ASCII, for text chunks of pictures.
        for (const char c : toText(state)) EXPECT_TRUE(c >= ' ' && c < 127);
    }
    State named = sample();
    named.settings.camera.name = "K\xc3\xa4mera \"1\"\n";
    EXPECT_EQ(stateFromText(toText(named), "x"), named);
    // Bytes that are no text are replaced, not a reason to lose the picture.
    named.settings.camera.name = "\xff";
    EXPECT_NO_THROW(stateFromText(toText(named), "x"));
}

// States of before the hash changed: a file's SHA-256 tells nothing, a built-in scene's version
// does.
TEST(State, OlderHashesAreReadWhereTheyStillTell) {
    nlohmann::json json = nlohmann::json::parse(toText(sample()));
    json.erase("sceneHash");
    json["sceneSha256"] = std::string(64, 'a');
    EXPECT_EQ(stateFromText(json.dump(), "x").sceneHash, "");
    json["sceneSha256"] = "builtin:cornell/1";
    EXPECT_EQ(stateFromText(json.dump(), "x").sceneHash, "builtin:cornell/1");
}

TEST(State, HoldsEverySetting) {
    const nlohmann::json json = nlohmann::json::parse(toText(sample()));
    EXPECT_EQ(json.at("schema"), kStateSchema);
    EXPECT_TRUE(json.at("program").get<std::string>().starts_with("megaviews "));
    EXPECT_EQ(json.at("settings").size(), settingsTable().size());
}

// The picture can only be the same if the camera is the same, in every bit.
TEST(State, GivesTheCameraBackBitByBit) {
    for (const char* name : {"builtin:cornell", "builtin:atrium"}) {
        Settings settings;
        const auto assets = loadAssetsWithoutHierarchy(name, settings);
        std::mt19937 random(11);
        std::uniform_real_distribution<float> place(-1, 2), angle(0, 6.2831853f);
        for (int i = 0; i < 4000; ++i) {
            // As a hand moves it: by angles, in floats.
            const float yaw = angle(random), pitch = 0.24f * (angle(random) - 3.14159265f);
            FrameCamera camera;
            camera.position = {place(random), place(random), place(random)};
            camera.forward = {std::cos(pitch) * std::sin(yaw), std::sin(pitch),
                              -std::cos(pitch) * std::cos(yaw)};
            camera.yfovRad = 0.2f + 0.3f * angle(random);
            if (i % 2 == 0) {  // an up that is part of an orthogonal frame, or a direction only
                const glm::vec3 right =
                    glm::normalize(glm::cross(camera.forward, glm::vec3(0, 1, 0)));
                camera.up = glm::cross(right, camera.forward);
            }
            const Settings saved = withCamera(settings, camera, assets->scene.root);
            State state;
            state.scene = name;
            state.settings = saved;
            const State back = stateFromText(toText(state), "x");
            const FrameCamera restored = chosenCamera(back.settings, *assets, 0);
            ASSERT_EQ(restored.position, camera.position) << i;
            ASSERT_EQ(restored.forward, camera.forward) << i;
            ASSERT_EQ(restored.yfovRad, camera.yfovRad) << i;
            if (i % 2 == 0) {
                ASSERT_EQ(restored.up, camera.up) << i;
            }
            // What is drawn with is the same even where only a direction was given.
            ASSERT_LT(glm::length(glm::cross(restored.forward, restored.up) -
                                  glm::normalize(glm::cross(camera.forward, camera.up))),
                      1e-5f);
            // And saving it again says the same.
            ASSERT_EQ(withCamera(settings, restored, assets->scene.root).camera.target,
                      saved.camera.target);
        }
    }
}

TEST(State, FilesAreFoundFromAnyFolder) {
    const TempFolder folder;
    const std::string scene = folder.write("scenes/a.glb", "x");
    const std::string file =
        folder.write("s.json", R"({"schema": 1, "scene": "scenes/../scenes/a.glb",
                      "settings": {"views": "v.ply"}} // by hand)");
    const State state = loadState(file, noPictures);
    EXPECT_EQ(state.scene, scene);
    EXPECT_EQ(state.settings.views.file, folder.file("v.ply"));
    requireScene(state, file);
    std::filesystem::remove(scene);
    try {
        requireScene(state, file);
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.code, ExitCode::input);
        EXPECT_EQ(error.what(), file + ": its scene '" + scene + "' is missing");
    }
    State relative;
    relative.scene = "a.glb";
    EXPECT_EQ(nlohmann::json::parse(toText(relative)).at("scene"),
              (std::filesystem::current_path() / "a.glb").string());
}

TEST(State, PicturesAreReadByTheirEnding) {
    for (const char* name : {"a.png", "b.EXR"}) {
        std::string asked;
        const State state = loadState(name, [&](const std::string& file) {
            asked = file;
            return toText(sample());
        });
        EXPECT_EQ(asked, name);
        EXPECT_EQ(state, sample());
        EXPECT_TRUE(isStateFile(name));
    }
    EXPECT_TRUE(isStateFile("a.json"));
    EXPECT_FALSE(isStateFile("a.glb"));
    EXPECT_FALSE(isStateFile("builtin:atrium"));
}

TEST(State, ErrorsNameFilePlaceAndReason) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"", "not valid JSON"},
        {"{", "not valid JSON"},
        {"[1]", "holds no JSON object"},
        {"{}", "it has no 'schema' and 'scene'"},
        {R"({"vpls": 3})", "it has no 'schema' and 'scene'"},
        {R"({"schema": 9, "scene": "a"})", "schema 9 is not known; this program reads 1"},
        {R"({"schema": 1, "scene": 3})", "scene: 3 is not a name"},
        {R"({"schema": 1, "scene": ""})", "scene: is empty"},
        {R"({"schema": 1, "scene": "a", "sped": 1})", "unknown key 'sped'; did you mean speed?"},
        {R"({"schema": 1, "scene": "a", "speed": 0})", "speed: 0 is outside 1/1024..1024"},
        {R"({"schema": 1, "scene": "a", "speed": "x"})", "speed: \"x\" is not a number"},
        {R"({"schema": 1, "scene": "a", "playing": 1})", "playing: 1 is not true or false"},
        {R"({"schema": 1, "scene": "a", "scene": "b"})", "'scene' is given twice"},
        {R"({"schema": 1, "scene": "a", "settings": 3})", "settings: not an object"},
        {R"({"schema": 1, "scene": "a", "settings": {"vpl": 3}})",
         "settings: unknown setting 'vpl'; did you mean vpls?"},
        {R"({"schema": 1, "scene": "a", "settings": {"vpls": 0}})",
         "settings: vpls: '0' is outside"},
        {R"({"schema": 1, "scene": "a", "settings": {"difference": "absolute"}})",
         "settings: difference: needs a second method"},
    };
    const TempFolder folder;
    for (const auto& [text, message] : cases) {
        const std::string file = folder.write("s.json", text);
        try {
            loadState(file, noPictures);
            ADD_FAILURE() << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.code, ExitCode::input) << text;
            EXPECT_TRUE(std::string(error.what()).starts_with(file + ": ")) << error.what();
            EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
        }
    }
    for (const std::string& file : {folder.file("absent.json"), folder.file("")}) {
        EXPECT_THROW(loadState(file, noPictures), Error);
    }
    folder.write("big.json", std::string(2 << 20, ' '));
    EXPECT_THROW(loadState(folder.file("big.json"), noPictures), Error);
}

TEST(State, ADamagedFileIsRefusedOrRead) {
    std::mt19937 random(5);
    const std::string good = toText(sample());
    int refused = 0;
    for (int i = 0; i < 3000; ++i) {
        std::string text = good;
        for (std::size_t k = 1 + random() % 3; k > 0; --k) {
            const std::size_t at = random() % text.size();
            switch (random() % 3) {
                case 0:
                    text[at] = static_cast<char>(random());
                    break;
                case 1:
                    text.erase(at, 1 + random() % 8);
                    break;
                default:
                    text.insert(at, text.substr(random() % text.size(), random() % 12));
            }
            if (text.empty()) text = " ";
        }
        try {
            const State state = stateFromText(text, "x");
            validate(state.settings);
        } catch (const Error& error) {
            ASSERT_EQ(error.code, ExitCode::input) << text;
            ++refused;
        }
    }
    EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace mv
