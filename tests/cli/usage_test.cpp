// What the command line refuses, how it says so, and what it answers without rendering. Nothing
// here needs OpenGL.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>

#include "app/common/command_line.h"
#include "app/common/output_names.h"
#include "cli/process.h"
#include "megaviews/core/error.h"
#include "megaviews/settings/settings_table.h"

namespace mv::test {
namespace {

TEST(Usage, HelpNamesEverySettingAndNeedsNothing) {
    const Sandbox sandbox;
    // Not even a driver: help is not the place to look for one.
    for (const char* flag : {"--help", "-h"}) {
        const ProcessResult r = sandbox.megaviews({flag}, {{"LIBGL_DRIVERS_PATH", "/nonexistent"}});
        EXPECT_EQ(r.code, 0);
        EXPECT_EQ(r.err, "");
        for (const SettingInfo& setting : settingsTable()) {
            EXPECT_NE(r.out.find("--" + std::string(setting.key) + " "), std::string::npos)
                << setting.key;
            EXPECT_NE(r.out.find(std::string(setting.help)), std::string::npos) << setting.key;
        }
        EXPECT_NE(r.out.find("--output"), std::string::npos);
    }
    // Help answers whatever else is wrong with the line.
    EXPECT_EQ(sandbox.megaviews({"--vpl", "3", "--help"}).code, 0);
}

// The header is looked after by every build, so that a commit needs no new configuration.
TEST(Usage, TheCommitIsTheOneThatWasBuilt) {
    const std::filesystem::path root = MEGAVIEWS_SOURCE_DIR;
    const Sandbox sandbox;
    const auto write = [&](const std::filesystem::path& of) {
        EXPECT_EQ(sandbox
                      .run("/usr/bin/env", {"cmake", "-DOUTPUT=commit.h", "-DROOT=" + of.string(),
                                            "-P", root / "app/common/write_commit.cmake"})
                      .code,
                  0);
        return sandbox.text("commit.h");
    };
    // No commit where there is no checkout, as in a tarball.
    EXPECT_EQ(write(sandbox.file(".")), "#define MEGAVIEWS_COMMIT \"\"\n");
    if (!std::filesystem::exists(root / ".git")) GTEST_SKIP() << "no checkout";
    const std::string commit = write(root);
    EXPECT_TRUE(std::regex_match(
        commit, std::regex("#define MEGAVIEWS_COMMIT \"[0-9a-f]{12,}(-dirty)?\"\n")))
        << commit;
    const auto written = std::filesystem::last_write_time(sandbox.file("commit.h"));
    EXPECT_EQ(write(root), commit);
    EXPECT_EQ(std::filesystem::last_write_time(sandbox.file("commit.h")), written);
}

TEST(Usage, VersionNamesProgramCommitAndLibraries) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.megaviews({"--version"});
    EXPECT_EQ(r.code, 0);
    EXPECT_TRUE(r.out.starts_with("megaviews ")) << r.out;
    for (const char* part : {"commit", "GLFW", "OpenImageIO", "ImGui", "small-groups"}) {
        EXPECT_NE(r.out.find(part), std::string::npos) << part;
    }
    EXPECT_TRUE(sandbox.run("megaviews-bench", {"--version"}).out.starts_with("megaviews-bench "));
}

struct Refused {
    std::vector<std::string> arguments;
    std::string message;  // contained in the one line on standard error
};

std::string joined(const std::vector<std::string>& arguments) {
    std::string line;
    for (const std::string& argument : arguments) line += argument + " ";
    return line;
}

// What the parser says, without the start of a process.
void expectRefused(const Refused& refused) {
    SCOPED_TRACE(joined(refused.arguments));
    std::vector<std::string> arguments = refused.arguments;
    if (std::find(arguments.begin(), arguments.end(), "--config") == arguments.end()) {
        arguments.insert(arguments.begin(), "--no-config");
    }
    try {
        parseCommandLine(arguments, {"megaviews", "", {}});
        ADD_FAILURE() << "taken";
    } catch (const Error& error) {
        EXPECT_EQ(error.code, ExitCode::usage);
        EXPECT_NE(std::string(error.what()).find(refused.message), std::string::npos)
            << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
}

void expectUsageError(const Refused& refused) {
    const Sandbox sandbox;
    SCOPED_TRACE(joined(refused.arguments));
    const ProcessResult r = sandbox.megaviews(refused.arguments);
    EXPECT_EQ(r.code, 2);
    EXPECT_EQ(r.out, "");
    EXPECT_TRUE(r.err.starts_with("megaviews: ")) << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    EXPECT_NE(r.err.find(refused.message), std::string::npos) << r.err;
}

TEST(Usage, WhatWouldNotBeDoneIsRefused) {
    expectUsageError({{"--no-config", "--info", "json", "--stats", "n.json"}, "--info and --list"});
    expectUsageError({{"--no-config", "--list", "views", "-o", "p.png"}, "--info and --list"});
    expectUsageError({{"--no-config", "--info", "--save-state", "s.json"}, "--info and --list"});
    for (const char* empty : {"--preset", "--config", "--load-state", "--stats"}) {
        expectUsageError({{empty, ""}, std::string(empty) + ": its value is empty"});
    }
    expectUsageError({{""}, "SCENE: its value is empty"});
    expectUsageError({{"--no-config", "--headless", "--tour"}, "--tour: needs panels"});
    expectUsageError({{"--no-config", "--tour"}, "no display: --tour: needs panels"});
    expectUsageError({{"--no-config", "-q", "builtin:cornell", "--file-scene", "3", "-o", "p.png"},
                      "'builtin:cornell' is a single scene"});
}

TEST(Usage, UnknownOptionsSuggestTheNearest) {
    expectRefused({{"--vpl", "4K"}, "unknown option --vpl; did you mean --vpls?"});
    expectRefused({{"--vpl=4K"}, "unknown option --vpl; did you mean --vpls?"});
    expectRefused({{"--headles"}, "did you mean --headless?"});
    expectRefused({{"-x"}, "unknown option -x"});
    // What is not built yet is unknown, not ignored.
    for (const char* flag : {"--benchmark"}) {
        expectRefused({{flag, "x"}, std::string("unknown option ") + flag});
    }
}

TEST(Usage, BadValuesNameTheFlag) {
    const std::vector<Refused> cases = {
        {{"--vpls"}, "--vpls: a value is missing"},
        {{"--vpls", "0"}, "--vpls: '0' is outside 1..1M"},
        {{"--vpls", "2M"}, "--vpls: '2M' is outside 1..1M"},
        {{"--vpls", "1.3"}, "--vpls: '1.3' is not a whole number"},
        {{"--vpls", "many"}, "--vpls: 'many' is not a number"},
        {{"--vpls="}, "--vpls"},
        {{"--view-res", "12"}, "--view-res: '12' is not a power of two"},
        {{"--scene-depth", "12"}, "--scene-depth: '12' is outside 1..11"},
        {{"--resolution", "0,0"}, "--resolution: '0' is outside 1..16384"},
        {{"--resolution", "640"}, "--resolution: '640' is not WxH"},
        {{"--resolution", "640x"}, "--resolution: '640x' is not WxH"},
        {{"--exposure", "bright"}, "--exposure"},
        {{"--camera-position", "1,2"}, "--camera-position: '1,2' is not X,Y,Z"},
        {{"--method", "megaview"}, "did you mean megaviews?"},
        {{"--step-hide", "cull"}, "--step-hide: 'cull' is not one of culled, rendered"},
        {{"--step-pairs", "large"}, "did you mean largest?"},
        {{"--map-colours", "height"}, "--map-colours: 'height' is not one of level, depth, views"},
        {{"--pair-scene", "-1"}, "--pair-scene: '-1' is outside"},
        {{"--filter", "maybe"}, "--filter: 'maybe' is neither on nor off"},
        {{"--compare", "megaviews"}, "compare"},
        {{"--views", "a.ply", "--particles", "5"}, "views and particles"},
        {{"--gl", "metal"}, "--gl: 'metal' is not one of auto, window, egl"},
        {{"--frames", "0"}, "--frames: '0' is outside"},
        {{"--frame-rate", "0"}, "--frame-rate: '0' is outside"},
        {{"--info=xml"}, "--info: 'xml'"},
        {{"--list", "lamps"}, "--list: 'lamps'"},
        {{"--log-level", "loud"}, "--log-level: 'loud'"},
        {{"--preset", "best"},
         "--preset: 'best' is not one of fast, balanced, quality, bench, paper-"},
        {{"--preset", "qualty"}, "did you mean quality?"},
        {{"--preset"}, "--preset: a value is missing"},
        {{"--save-state", "a.png"}, "--save-state: 'a.png' must end in .json"},
        {{"--load-state"}, "--load-state: a value is missing"},
        {{"--actions", "wait; nxt-method"},
         "--actions: command 2: unknown action 'nxt-method'; did you mean next-method?"},
        {{"--actions", "vpls=many"}, "--actions: command 1: vpls: 'many' is not a number"},
        {{"--actions", "@absent.txt"}, "--actions: 'absent.txt' cannot be read"},
        {{"-D", "vpls"}, "-D: 'vpls' is not KEY=VALUE"},
        {{"-D", "vpl=3"}, "-D: unknown setting 'vpl'; did you mean vpls?"},
        {{"-D", "vpls=x"}, "-D vpls: 'x' is not a number"},
        {{"-o", "a.jpg"}, "--output: 'a.jpg' must end in .png or .exr"},
        {{"-o", "a"}, "--output"},
        {{"-o"}, "--output: a value is missing"},
        {{"--stats", "a.csv"}, "--stats: 'a.csv' must end in .json"},
        {{"--save-views", "a.txt"}, "--save-views: 'a.txt' must end in .ply"},
        {{"--save-maps", "a.txt"}, "--save-maps: 'a.txt' must end in .npy"},
        {{"--save-scene", "a.gltf"}, "--save-scene: 'a.gltf' must end in .glb"},
        {{"a.glb", "b.glb"}, "only one scene"},
        {{"--config", "a.json", "--no-config"}, "--no-config"},
    };
    for (const Refused& refused : cases) expectRefused(refused);
}

TEST(Usage, TheProgramRefusesInOneLine) {
    expectUsageError({{"--vpl", "4K"}, "unknown option --vpl; did you mean --vpls?"});
    expectUsageError({{"--headless", "-o", "a.jpg"}, "--output: 'a.jpg' must end in"});
    expectUsageError({{"-o", "a.png", "-o", "./a.png"}, "would be written twice"});
    expectUsageError({{"--method", "none", "--save-maps", "a.npy"}, "--save-maps"});
    expectUsageError({{"--fusion", "off", "--save-maps", "a.npy"}, "--save-maps"});
}

TEST(Usage, ConfigurationErrorsNameFileAndKey) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"{\"vpl\": 3}", "unknown setting 'vpl'; did you mean vpls?"},
        {"{\"vpls\": \"x\"}", "vpls: 'x' is not a number"},
        {"{\"vpls\": 3", "not valid JSON"},
        {"", "not valid JSON"},
        {"[1]", "not an object"},
        {"{\"vpls\": 3, \"vpls\": 4}", "'vpls' is given twice"},
        {"{\"schema\": 99}", "schema 99"},
    };
    const Sandbox sandbox;
    const std::string file = sandbox.file("bad.json").string();
    for (const auto& [text, message] : cases) {
        sandbox.write("bad.json", text);
        expectRefused({{"--config", file}, "bad.json: "});
        expectRefused({{"--config", file}, message});
    }
    expectRefused({{"--config", sandbox.file("absent.json").string()}, "absent.json"});
    // The same as the user's own configuration, which --no-config leaves alone.
    sandbox.write("config/megaviews/config.json", "{\"vpl\": 3}");
    const ProcessResult r = sandbox.megaviews({"--list", "methods"});
    EXPECT_EQ(r.code, 2);
    EXPECT_NE(r.err.find("config.json: unknown setting 'vpl'"), std::string::npos) << r.err;
    EXPECT_EQ(sandbox.megaviews({"--list", "methods", "--no-config"}).code, 0);
}

TEST(Usage, CommandLineBeatsConfigurationBeatsDefaults) {
    const Sandbox sandbox;
    sandbox.write("config/megaviews/config.json", "{\"vpls\": \"2K\", \"bounces\": 2} // mine");
    sandbox.write("other.json", "{\"seed\": 9, \"vpls\": 77}");
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), {"--info=json", "builtin:cornell"});
        const ProcessResult r = sandbox.megaviews(more);
        EXPECT_EQ(r.code, 0) << r.err;
        return nlohmann::json::parse(r.out).at("settings");
    };
    const auto plain = with({});
    EXPECT_EQ(plain.at("vpls"), 2048);
    EXPECT_EQ(plain.at("bounces"), 2);
    EXPECT_EQ(plain.at("seed"), 0);
    EXPECT_EQ(with({"--vpls", "5"}).at("vpls"), 5);
    EXPECT_EQ(with({"--no-config"}).at("vpls"), 65536);
    const auto other = with({"--config", "other.json", "-D", "seed=3"});
    EXPECT_EQ(other.at("vpls"), 77);
    EXPECT_EQ(other.at("bounces"), 4);
    EXPECT_EQ(other.at("seed"), 3);
}

TEST(Usage, TheLastOfTwoValuesHolds) {
    const auto parse = [](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "--no-config");
        return parseCommandLine(arguments, {"megaviews", "", {}});
    };
    EXPECT_EQ(parse({"--vpls", "5", "-D", "vpls=6"}).settings.views.vpls, 6);
    EXPECT_EQ(parse({"-D", "vpls=6", "--vpls=5"}).settings.views.vpls, 5);
    EXPECT_EQ(parse({"-Dvpls=6", "-Dvpls=7"}).settings.views.vpls, 7);
    EXPECT_EQ(parse({"-q", "-v"}).run.logLevel, LogLevel::debug);
    const CommandLine line = parse({"-oa.png", "scene.glb", "-o", "b.exr", "--exposure", "-1.5",
                                    "--camera-position", "-1,2,3", "--info"});
    EXPECT_EQ(line.run.outputs, (std::vector<std::string>{"a.png", "b.exr"}));
    EXPECT_EQ(line.run.scene, "scene.glb");
    EXPECT_EQ(line.settings.display.exposureEv, -1.5);
    EXPECT_EQ((*line.settings.camera.position)[0], -1);
    EXPECT_EQ(line.run.info, InfoFormat::text);
    EXPECT_TRUE(line.run.isGiven("exposure"));
    EXPECT_FALSE(line.run.isGiven("vpls"));
    EXPECT_EQ(parse({}).run.scene, "builtin:atrium");
}

TEST(Output, NamesCarryTheFrame) {
    EXPECT_EQ(outputName("a.png", 3, 1), "a.png");
    EXPECT_EQ(outputName("a.png", 3, 2), "a.0003.png");
    EXPECT_EQ(outputName("d.e/a.b.png", 12345, 2), "d.e/a.b.12345.png");
    EXPECT_EQ(outputName("{frame}.png", 3, 1), "3.png");
    EXPECT_EQ(outputName("a{frame:03}b{frame}.png", 12, 2), "a012b12.png");
    EXPECT_EQ(outputName("}a{.png", 3, 1), "}a{.png");
    for (const char* unknown : {"{scene}", "{frame:3}", "{frame:00}", "{}", "{{frame}}"}) {
        EXPECT_THROW(outputName(std::string("a") + unknown + ".png", 3, 1), Error) << unknown;
    }
}

TEST(Inform, InfoDescribesTheScene) {
    const Sandbox sandbox;
    const ProcessResult json = sandbox.megaviews({"--info=json", "builtin:cornell"});
    ASSERT_EQ(json.code, 0) << json.err;
    const auto info = nlohmann::json::parse(json.out);
    EXPECT_EQ(info.at("schema"), 1);
    EXPECT_EQ(info.at("scene").at("name"), "builtin:cornell");
    EXPECT_FALSE(info.at("scene").at("hash").get<std::string>().empty());
    EXPECT_GT(info.at("scene").at("triangles"), 10);
    EXPECT_GE(info.at("scene").at("cameras").size(), 1u);
    EXPECT_EQ(info.at("settings").size(), settingsTable().size());

    EXPECT_EQ(sandbox.megaviews({"--info", "json", "builtin:cornell"}).out, json.out);
    EXPECT_EQ(sandbox.megaviews({"builtin:cornell", "--info", "json"}).out, json.out);

    // "--info SCENE": the scene is not the format.
    const ProcessResult text = sandbox.megaviews({"--info", "builtin:cornell"});
    ASSERT_EQ(text.code, 0) << text.err;
    for (const char* part : {"builtin:cornell", "triangles", "camera", "vpls", "65536"}) {
        EXPECT_NE(text.out.find(part), std::string::npos) << part;
    }
}

TEST(Inform, ListsPrintOneNameALine) {
    const Sandbox sandbox;
    EXPECT_EQ(
        sandbox.megaviews({"--list=methods"}).out,
        "megaviews\nmanylods\nnone\nrays\nshadow-rays\nraster\nism\nvir\nexact\npathtraced\n");
    EXPECT_NE(sandbox.megaviews({"--list", "views"}).out.find("normals\n"), std::string::npos);
    const ProcessResult cameras = sandbox.megaviews({"--list=cameras", "builtin:cornell"});
    EXPECT_EQ(cameras.code, 0) << cameras.err;
    EXPECT_FALSE(cameras.out.empty());
    EXPECT_EQ(sandbox.megaviews({"--list=animations", "builtin:cornell"}).code, 0);
}

TEST(Input, BadFilesAreCode3AndNamed) {
    const Sandbox sandbox;
    sandbox.write("text.gltf", "this is no JSON");
    sandbox.write("empty.glb", "");
    sandbox.write("basisu.gltf",
                  "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_texture_basisu\"],"
                  "\"extensionsRequired\":[\"KHR_texture_basisu\"]}");
    std::filesystem::create_directory(sandbox.file("folder.gltf"));
    for (const char* name : {"absent.gltf", "text.gltf", "empty.glb", "basisu.gltf", "folder.gltf",
                             "builtin:nothing"}) {
        for (const bool info : {true, false}) {
            const ProcessResult r = info ? sandbox.megaviews({"--info", name})
                                         : sandbox.megaviews({"--headless", "-o", "x.png", name});
            EXPECT_EQ(r.code, 3) << name << ": " << r.err;
            EXPECT_NE(r.errLine().find(name), std::string::npos) << r.err;
            EXPECT_EQ(r.out, "");
            EXPECT_FALSE(std::filesystem::exists(sandbox.file("x.png")));
        }
    }
    // Once, with panels too.
    const ProcessResult window =
        sandbox.megaviews({"--headless", "--ui", "-o", "x.png", "absent.gltf"});
    EXPECT_EQ(window.code, 3) << window.err;
    EXPECT_EQ(window.err.find("absent.gltf"), window.err.rfind("absent.gltf")) << window.err;
    const ProcessResult basisu = sandbox.megaviews({"--info", "basisu.gltf"});
    EXPECT_NE(basisu.err.find("KHR_texture_basisu"), std::string::npos) << basisu.err;
}

TEST(Input, CamerasAndAnimationsThatAreNotThereAreUsageErrors) {
    const Sandbox sandbox;
    for (const char* flag : {"--camera", "--animation"}) {
        const ProcessResult r = sandbox.megaviews({"--info", "builtin:cornell", flag, "nobody"});
        EXPECT_EQ(r.code, 2) << r.err;
        EXPECT_NE(r.err.find("nobody"), std::string::npos) << r.err;
    }
}

TEST(Output, IsCheckedBeforeAnythingElse) {
    const Sandbox sandbox;
    std::filesystem::create_directory(sandbox.file("folder.png"));
    const std::vector<std::vector<std::string>> cases = {
        {"-o", "nowhere/x.png"},          {"-o", "x.exr", "-o", "folder.png"},
        {"--save-maps", "nowhere/x.npy"}, {"--save-scene", "nowhere/x.glb"},
        {"--log-file", "nowhere/x.log"},
    };
    for (std::vector<std::string> arguments : cases) {
        // The scene does not exist: had it been looked for first, the code would be 3.
        arguments.insert(arguments.end(), {"--headless", "absent.glb"});
        const ProcessResult r = sandbox.megaviews(arguments);
        EXPECT_EQ(r.code, 5) << arguments[1] << ": " << r.err;
        EXPECT_FALSE(std::filesystem::exists(sandbox.file("x.exr")));
    }
}

TEST(Bench, UsageErrors) {
    const Sandbox sandbox;
    const auto bench = [&](std::vector<std::string> arguments) {
        return sandbox.run("megaviews-bench", arguments);
    };
    EXPECT_EQ(bench({}).code, 2);
    EXPECT_EQ(bench({"--help"}).code, 0);
    EXPECT_EQ(bench({"sweep", "--help"}).code, 0);
    EXPECT_NE(bench({"selftst"}).err.find("did you mean selftest?"), std::string::npos);
    EXPECT_EQ(bench({"sweep", "--headless"}).code, 2);  // the viewer's
    EXPECT_EQ(bench({"sweep", "--out", "nowhere/x"}).code, 5);
    EXPECT_EQ(bench({"sweep", "absent.glb"}).code, 3);
    EXPECT_EQ(bench({"cuts"}).code, 2);
    EXPECT_EQ(bench({"cuts", "builtin:cornell", "--view-res", "17"}).code, 2);
    EXPECT_EQ(bench({"cuts", "absent.glb"}).code, 3);
    EXPECT_EQ(bench({"cuts", "absent.glb", "--drift", "nan"}).code, 2);
    EXPECT_EQ(bench({"cuts", "absent.glb", "--frame-rate", "nan"}).code, 2);
    EXPECT_EQ(bench({"stress", "--json", "a.csv"}).code, 2);
    EXPECT_EQ(bench({"compare", "a.png", "b.png", "--json", "a.csv"}).code, 2);
    EXPECT_NE(bench({"stress", "--json", ""}).err.find("--json: its value is empty"),
              std::string::npos);
    // All before the scene, which does not exist, is looked for.
    const std::vector<std::pair<std::vector<std::string>, std::string>> refusals = {
        {{"--sweep", "vpl=1K"}, "did you mean vpls?"},
        {{"--sweep", "vpls=1K..8K"}, "has no step"},
        {{"--sweep", "method=megaviews,best"}, "'best' is not one of"},
        {{"--sweep", "vpls=64", "--sweep", "vpls=128"}, "swept twice"},
        {{"--sweep", "view=depth"}, "changes only what is shown"},
        {{"--sweep", "distribution=single", "--sweep", "bounces=1,2"}, "sets 'bounces'"},
        {{"--sweep", "distribution=bouncs"}, "did you mean bounces?"},
        {{"--sweep", "seed=0..1M:+1"}, "has more than 10000 values"},
        {{"--sweep", "seed=1..1000:+1", "--sweep", "vpls=1..20:+1"}, "more than 10000 points"},
        {{"--compare", "manylods"}, "--sweep method=A,B"},
        {{"--resume"}, "needs --out"},
        {{"--vary", "vpls=64,128"}, "needs --equal-time or --equal-error"},
        {{"--equal-time", "10"}, "needs --vary"},
        {{"--equal-time", "x", "--vary", "view-res=16,32"}, "'x' is not a number"},
        {{"--equal-error", "psnr:30", "--vary", "view-res=16,32"}, "needs --references"},
        {{"--equal-error", "pnsr:30", "--vary", "view-res=16,32"}, "did you mean psnr?"},
        {{"--sweep", "method=exact"}, "needs --references"},
        {{"--vary", "vpls=64,128", "--equal-time", "10", "--sweep", "vpls=64"}, "swept twice"}};
    for (const auto& [arguments, message] : refusals) {
        std::vector<std::string> all = {"sweep", "absent.glb"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const ProcessResult r = bench(all);
        EXPECT_EQ(r.code, 2) << r.err;
        EXPECT_NE(r.err.find(message), std::string::npos) << r.err;
    }
}

// A scene that moves, its lights and views with it: incremental cuts are the basic method's.
TEST(Bench, FollowsCuts) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.run(
        "megaviews-bench", {"cuts", "builtin:door", "--vpls", "64", "--scene-depth", "6",
                            "--frames", "2", "--frame-rate", "10", "--drift", "0.01",
                            "--scene-tree", "octree", "--scene-tree", "binary"});
    EXPECT_EQ(r.code, 0) << r.err;
    for (const char* row : {"1 % | octree | incremental | ", "1 % | binary | incremental | ",
                            "1/10 s | octree | incremental | ", "1/10 s | binary | incremental | ",
                            "1/10 s | binary | lazy 1 | ", "\noctree | 6 | ", "\nbinary | "})
        EXPECT_NE(r.out.find(row), std::string::npos) << r.out;
}

}  // namespace
}  // namespace mv::test
