// Presets, states and scripts on the command line: who wins, what is restored, what is refused.

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/common/state.h"
#include "cli/process.h"
#include "megaviews/settings/actions.h"
#include "megaviews/settings/presets.h"
#include "megaviews/settings/settings_table.h"

namespace mv::test {
namespace {

using Json = nlohmann::json;

// The settings in effect, without rendering.
Json settingsOf(const Sandbox& sandbox, std::vector<std::string> arguments) {
    arguments.emplace_back("--info=json");
    const ProcessResult r = sandbox.megaviews(arguments);
    EXPECT_EQ(r.code, 0) << r.err;
    return r.code == 0 ? Json::parse(r.out).at("settings") : Json();
}

std::string metadata(const std::filesystem::path& file, const std::string& key) {
    const auto input = OIIO::ImageInput::open(file.string());
    return input ? std::string(input->spec().get_string_attribute(key)) : "no picture";
}

void expectRefused(const ProcessResult& r, int code, const std::vector<std::string>& parts) {
    EXPECT_EQ(r.code, code) << r.err;
    EXPECT_EQ(r.out, "");
    for (const std::string& part : parts) {
        EXPECT_NE(r.errLine().find(part), std::string::npos) << r.err;
    }
    EXPECT_EQ(r.errLine().find('\n'), std::string::npos) << r.err;
}

TEST(Presets, AreListedAndAppliedBeforeTheRestOfTheLine) {
    const Sandbox sandbox;
    std::string names, actions;
    for (const PresetInfo& preset : presetsTable()) names.append(preset.name).append("\n");
    for (const ActionInfo& action : actionsTable()) actions.append(idOf(action)).append("\n");
    EXPECT_EQ(sandbox.megaviews({"--list", "presets"}).out, names);
    EXPECT_EQ(sandbox.megaviews({"--list", "actions"}).out, actions);

    sandbox.write("config/megaviews/config.json", R"({"vpls": 77, "seed": 5})");
    for (const PresetInfo& preset : presetsTable()) {
        Settings expected;
        expected.seed = 5;  // of the configuration, which the preset beats elsewhere
        expected.views.vpls = 77;
        applyPreset(expected, preset);
        const std::string name(preset.name);
        EXPECT_EQ(settingsOf(sandbox, {"builtin:cornell", "--preset", name}),
                  Json(toJson(expected)))
            << name;
        expected.gather.samples = 3;
        EXPECT_EQ(
            settingsOf(sandbox, {"builtin:cornell", "--preset", name, "--gather-samples", "3"}),
            Json(toJson(expected)));
        EXPECT_EQ(
            settingsOf(sandbox, {"builtin:cornell", "-Dgather-samples=3", "--preset=" + name}),
            Json(toJson(expected)));
    }
    // As of every option that is given twice, the last holds, and nothing of the first.
    EXPECT_EQ(
        settingsOf(sandbox, {"builtin:cornell", "--preset", "paper-manylods", "--preset", "fast"}),
        settingsOf(sandbox, {"builtin:cornell", "--preset", "fast"}));
    EXPECT_EQ(sandbox.run("megaviews-bench", {"sweep", "--preset", "best"}).code, 2);
}

// Soft edges are those of the settings that a picture carries, in every frame and again.
TEST(States, PicturesOfManyPointsRepeat) {
    const Sandbox sandbox;
    const std::vector<std::string> soft =
        smallPicture({"--pixel-samples", "3", "--frames", "2", "-o", "a.png", "-o", "a.exr"});
    const ProcessResult r = sandbox.megaviews(soft);
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(metadata(sandbox.file("a.0000.exr"), "megaviews.pixelSamples"), "3");
    const ProcessResult again = sandbox.megaviews(
        {"--headless", "--no-cache", "--load-state", "a.0000.png", "-o", "b.png", "-o", "b.exr"});
    ASSERT_EQ(again.code, 0) << again.err;
    const auto soft8 = pixelsOf(sandbox.file("a.0000.png")),
               exr = pixelsOf(sandbox.file("a.0000.exr"));
    EXPECT_EQ(pixelsOf(sandbox.file("b.png")), soft8);
    EXPECT_EQ(pixelsOf(sandbox.file("b.exr")), exr);
    const ProcessResult hard = sandbox.megaviews(smallPicture({"-o", "c.png", "-o", "c.exr"}));
    ASSERT_EQ(hard.code, 0) << hard.err;
    EXPECT_EQ(metadata(sandbox.file("c.exr"), "megaviews.pixelSamples"), "1");
    EXPECT_NE(pixelsOf(sandbox.file("c.png")), soft8);
    EXPECT_NE(pixelsOf(sandbox.file("c.exr")), exr);
}

// One free camera, settings away from their defaults, and the picture comes back from all three.
TEST(States, RestoreTheSamePicture) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.megaviews(smallPicture({"-o",
                                                            "a.png",
                                                            "-o",
                                                            "a.exr",
                                                            "--save-state",
                                                            "a.json",
                                                            "--camera-position",
                                                            "0.31,0.9,2.7",
                                                            "--camera-target",
                                                            "0.1,0.7,-0.3",
                                                            "--camera-up",
                                                            "0.1,1,0.05",
                                                            "--fov",
                                                            "61.7",
                                                            "--seed",
                                                            "3",
                                                            "--time",
                                                            "0.37",
                                                            "--compare",
                                                            "manylods",
                                                            "--split",
                                                            "0.3",
                                                            "--rules",
                                                            "published"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(r.out, "a.png\na.exr\na.json\n");
    const std::string settings = metadata(sandbox.file("a.png"), "megaviews.settings");
    EXPECT_EQ(metadata(sandbox.file("a.exr"), "megaviews.settings"), settings);
    EXPECT_EQ(Json::parse(sandbox.text("a.json")).at("settings"), Json::parse(settings));
    ASSERT_GT(pixelsOf(sandbox.file("a.png")).size(), 0u);
    for (const std::string from : {"a.png", "a.exr", "a.json"}) {
        SCOPED_TRACE(from);
        // Neither configuration nor working directory matter.
        sandbox.write("config/megaviews/config.json", R"({"vpls": 77, "exposure": 9})");
        const ProcessResult again = sandbox.megaviews(
            {"--headless", "--no-cache", "--load-state", from, "-o", "b.png", "-o", "b.exr"});
        ASSERT_EQ(again.code, 0) << again.err;
        EXPECT_EQ(again.errLine(), "");
        EXPECT_EQ(sandbox.text("b.png"), sandbox.text("a.png"));
        EXPECT_EQ(sandbox.text("b.exr"), sandbox.text("a.exr"));
        EXPECT_EQ(pixelsOf(sandbox.file("b.png")), pixelsOf(sandbox.file("a.png")));
        EXPECT_EQ(metadata(sandbox.file("b.png"), "megaviews.settings"), settings);
        EXPECT_EQ(settingsOf(sandbox, {"--load-state", from}), Json::parse(settings));
    }
}

// What a hand made of the camera in the window is restored with and without one.
TEST(States, TheWindowAndThePictureAgree) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.megaviews(smallPicture(
        {"--resolution", "320x200", "--camera-up", "0.1,1,0.05", "--actions",
         "save a.png; drag 60%,50% 66%,53%; scroll 1; wait-still; save b.png; save-state b.json"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_NE(sandbox.text("a.png"), sandbox.text("b.png"));  // the hand did move it
    for (const std::string from : {"b.png", "b.json"}) {
        const ProcessResult again =
            sandbox.megaviews({"--headless", "--no-cache", "--load-state", from, "-o", "c.png"});
        ASSERT_EQ(again.code, 0) << again.err;
        // Buffers of the window may have grown: memory is not compared.
        EXPECT_EQ(pixelsOf(sandbox.file("c.png")), pixelsOf(sandbox.file("b.png"))) << from;
    }
    const ProcessResult window =
        sandbox.megaviews({"--headless", "--no-cache", "--load-state", "b.png", "--resolution",
                           "320x200", "--actions", "wait-still; save d.png; expect vpls=256"});
    ASSERT_EQ(window.code, 0) << window.err;
    EXPECT_EQ(pixelsOf(sandbox.file("d.png")), pixelsOf(sandbox.file("b.png")));
}

TEST(Scripts, AnExpectationThatIsNotMetIsCode1) {
    const Sandbox sandbox;
    const ProcessResult r =
        sandbox.megaviews(smallPicture({"--actions", "next-method; wait; expect method=none"}));
    MV_SKIP_WITHOUT_GL(r);
    EXPECT_EQ(r.code, 1) << r.err;
    EXPECT_NE(r.errLine().find("command 3"), std::string::npos) << r.err;
    EXPECT_NE(r.errLine().find("method is manylods and should be none"), std::string::npos)
        << r.err;
    expectRefused(sandbox.megaviews({"--headless", "--actions", "save no/such/a.png"}), 5,
                  {"no/such"});
}

TEST(States, TheLineBeatsThem) {
    const Sandbox sandbox;
    State state;
    state.scene = "builtin:cornell";
    state.settings.views.vpls = 99;
    state.settings.camera.position = {{1, 2, 3}};
    state.settings.camera.target = {{0, 0, 0}};
    saveState(sandbox.file("s.json").string(), state);
    EXPECT_EQ(settingsOf(sandbox, {"--load-state", "s.json"}).at("vpls"), 99);
    EXPECT_EQ(settingsOf(sandbox, {"--vpls", "5", "--load-state", "s.json"}).at("vpls"), 5);
    // States beat presets, which beat the configuration.
    const Json both = settingsOf(sandbox, {"--load-state", "s.json", "--preset", "quality"});
    EXPECT_EQ(both.at("vpls"), 99);
    EXPECT_EQ(both.at("view-res"), 16);
    // A camera by its name is not moved to where the state's stood.
    const Json named = settingsOf(sandbox, {"--load-state", "s.json", "--camera", "0"});
    EXPECT_EQ(named.at("camera-position"), nullptr);
    EXPECT_EQ(named.at("camera-target"), nullptr);
    EXPECT_EQ(named.at("vpls"), 99);
    const Json moved =
        settingsOf(sandbox, {"--load-state", "s.json", "--camera-position", "3,2,1"});
    EXPECT_EQ(moved.at("camera-position"), Json({3.0, 2.0, 1.0}));
    EXPECT_EQ(moved.at("camera-target"), Json({0.0, 0.0, 0.0}));
    const ProcessResult other = sandbox.megaviews(
        {"--load-state", "s.json", "builtin:hairball", "--camera", "0", "--info=json"});
    EXPECT_EQ(Json::parse(other.out).at("scene").at("name"), "builtin:hairball");
    // Another scene has no camera of that name: it is seen from where that one stood.
    state.settings.camera.name = "inside";
    saveState(sandbox.file("s.json").string(), state);
    const Json elsewhere = settingsOf(sandbox, {"--load-state", "s.json", "builtin:hairball"});
    EXPECT_EQ(elsewhere.at("camera"), "");
    EXPECT_EQ(elsewhere.at("camera-position"), Json({1.0, 2.0, 3.0}));
    EXPECT_EQ(settingsOf(sandbox, {"--load-state", "s.json"}).at("camera"), "inside");
}

TEST(States, BadFilesAreCode3) {
    const Sandbox sandbox;
    sandbox.write("bad.json", "{");
    sandbox.write("key.json", R"({"schema": 1, "scene": "builtin:cornell", "sped": 1})");
    sandbox.write("setting.json",
                  R"({"schema": 1, "scene": "builtin:cornell", "settings": {"vpl": 1}})");
    sandbox.write("gone.json", R"({"schema": 1, "scene": "gone.glb"})");
    sandbox.write("text.png", "no picture");
    const auto load = [&](const std::string& file) {
        return sandbox.megaviews({"--headless", "--load-state", file, "-o", "x.png"});
    };
    expectRefused(load("bad.json"), 3, {"bad.json: not valid JSON"});
    expectRefused(load("key.json"), 3, {"key.json: unknown key 'sped'; did you mean speed?"});
    expectRefused(load("setting.json"), 3,
                  {"setting.json: settings: unknown setting 'vpl'; did you mean vpls?"});
    expectRefused(load("gone.json"), 3, {"gone.json: its scene '", "gone.glb' is missing"});
    expectRefused(load("absent.json"), 3, {"absent.json"});
    expectRefused(load("absent.png"), 3, {"'absent.png' cannot be read"});
    expectRefused(load("text.png"), 3, {"'text.png' is no picture"});
    // A picture of another program.
    const std::vector<unsigned char> black(3 * 4, 0);
    const auto plain = OIIO::ImageOutput::create("png");
    plain->open(sandbox.file("plain.png").string(), OIIO::ImageSpec(2, 2, 3));
    plain->write_image(OIIO::TypeDesc::UINT8, black.data());
    plain->close();
    expectRefused(load("plain.png"), 3, {"'plain.png' carries no state of this program"});
    expectRefused(sandbox.megaviews({"--headless", "--save-state", "no/such/folder.json"}), 5,
                  {"no/such"});
    EXPECT_FALSE(std::filesystem::exists(sandbox.file("x.png")));
}

// What the file refers to counts as it does, and so does the file of views.
TEST(States, WhateverWasReadAndChangedIsAWarning) {
    const Sandbox sandbox;
    sandbox.write("s.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "s.bin"}]})");
    const auto writeTriangle = [&](float x) {
        const float positions[] = {0, 0, 0, 1, 0, 0, x, 1, 0};
        sandbox.write("s.bin",
                      std::string(reinterpret_cast<const char*>(positions), sizeof positions));
    };
    const auto writeViews = [&](const std::string& flux) {
        sandbox.write(
            "v.ply",
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
            "property float z\nproperty float red\nproperty float green\n"
            "property float blue\nend_header\n0.5 0.5 0 " +
                flux + "\n");
    };
    writeTriangle(0);
    writeViews("1 1 1");
    const std::vector<std::string> small = {"--headless",   "--no-cache", "--scene-depth", "5",
                                            "--resolution", "16x16",      "--view-depth",  "5"};
    std::vector<std::string> save = small, load = small;
    save.insert(save.end(), {"s.gltf", "--views", "v.ply", "--save-state", "t.json"});
    load.insert(load.end(), {"--load-state", "t.json", "-o", "x.png"});
    const ProcessResult saved = sandbox.megaviews(save);
    MV_SKIP_WITHOUT_GL(saved);
    ASSERT_EQ(saved.code, 0) << saved.err;
    const auto warns = [&] {
        const ProcessResult r = sandbox.megaviews(load);
        EXPECT_EQ(r.code, 0) << r.err;
        return r.err.find("changed since its state was saved") != std::string::npos;
    };
    EXPECT_FALSE(warns());
    writeTriangle(0.5f);
    EXPECT_TRUE(warns());
    writeTriangle(0);
    EXPECT_FALSE(warns());
    writeViews("2 1 1");
    EXPECT_TRUE(warns());
}

TEST(States, ASceneThatChangedIsAWarning) {
    const Sandbox sandbox;
    State state;
    state.scene = "builtin:cornell";
    state.sceneHash = "0000";
    state.settings.scene.octreeDepth = state.settings.views.octreeDepth = 5;
    state.settings.views.vpls = 16;
    state.settings.resolution.width = state.settings.resolution.height = 16;
    saveState(sandbox.file("s.json").string(), state);
    const ProcessResult r =
        sandbox.megaviews({"--headless", "--no-cache", "--load-state", "s.json", "-o", "x.png"});
    MV_SKIP_WITHOUT_GL(r);
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.errLine().find("builtin:cornell: the scene has changed"), std::string::npos)
        << r.err;
}

}  // namespace
}  // namespace mv::test
