// Pictures and results without a window, by the programs as built.

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "cli/process.h"
#include "megaviews/settings/settings_table.h"
#include "megaviews/settings/statistics_table.h"

namespace mv::test {
namespace {

using Json = nlohmann::json;

struct Picture {
    int width = 0, height = 0, channels = 0;
    std::string format;
    std::vector<float> values;  // 8-bit values are 0..1
    std::map<std::string, std::string> texts;
    const float* at(int x, int y) const {
        return &values[static_cast<std::size_t>((y * width + x) * channels)];
    }
};

Picture readPicture(const std::filesystem::path& file) {
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input) throw std::runtime_error(file.string() + ": " + OIIO::geterror());
    const OIIO::ImageSpec& spec = input->spec();
    Picture p;
    p.width = spec.width;
    p.height = spec.height;
    p.channels = spec.nchannels;
    p.format = std::string(input->format_name()) + " " + spec.format.c_str();
    p.values.resize(static_cast<std::size_t>(p.width * p.height * p.channels));
    input->read_image(0, 0, 0, p.channels, OIIO::TypeDesc::FLOAT, p.values.data());
    for (const auto& attribute : spec.extra_attribs) {
        p.texts[attribute.name().string()] = attribute.get_string();
    }
    return p;
}

TEST(Headless, SameSettingsGiveTheSameBytes) {
    const Sandbox sandbox;
    const auto render = [&](const std::string& name,
                            const std::map<std::string, std::string>& environment) {
        return sandbox.megaviews(
            smallPicture({"-o", name + ".png", "-o", name + ".exr", "--save-views", name + ".ply",
                          "--save-maps", name + ".npy"}),
            environment);
    };
    const ProcessResult first = render("a", {});
    MV_SKIP_WITHOUT_GL(first);
    ASSERT_EQ(first.code, 0) << first.err;
    // Results on standard output, one a line.
    EXPECT_EQ(first.out, "a.png\na.exr\na.ply\na.npy\na.centres.npy\na.views.npy\n");
    const ProcessResult counted =
        sandbox.megaviews(smallPicture({"-o", "s.png", "--stats", "s.json"}));
    ASSERT_EQ(counted.code, 0) << counted.err;
    EXPECT_TRUE(sandbox.text("s.png") == sandbox.text("a.png"));  // whatever else is asked for
    ASSERT_EQ(render("b", {}).code, 0);
    ASSERT_EQ(render("c", {{"LP_NUM_THREADS", "1"}}).code, 0);
    for (const char* end : {".png", ".exr", ".ply", ".npy", ".centres.npy", ".views.npy"}) {
        EXPECT_FALSE(sandbox.text(std::string("a") + end).empty()) << end;
        EXPECT_EQ(sandbox.text(std::string("a") + end), sandbox.text(std::string("b") + end))
            << end;
        EXPECT_EQ(sandbox.text(std::string("a") + end), sandbox.text(std::string("c") + end))
            << end;
    }
    // Another seed is another picture.
    ASSERT_EQ(sandbox.megaviews(smallPicture({"-o", "d.png", "--seed", "1"})).code, 0);
    EXPECT_NE(sandbox.text("a.png"), sandbox.text("d.png"));
}

TEST(Headless, PicturesAreNotBlankAndSayWhatMadeThem) {
    const Sandbox sandbox;
    const ProcessResult r =
        sandbox.megaviews(smallPicture({"-o", "a.png", "-o", "b.exr", "--seed", "7"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    for (const char* name : {"a.png", "b.exr"}) {
        const Picture p = readPicture(sandbox.file(name));
        EXPECT_EQ(p.format, std::string(name) == "a.png" ? "png uint8" : "openexr float");
        EXPECT_EQ(p.width, 96);
        EXPECT_EQ(p.height, 54);
        EXPECT_EQ(p.channels, 3);
        std::set<float> values(p.values.begin(), p.values.end());
        EXPECT_GT(values.size(), 50u) << name;

        const auto text = [&](const std::string& key) {
            const auto it = p.texts.find("megaviews." + key);
            return it == p.texts.end() ? "" : it->second;
        };
        EXPECT_EQ(text("scene"), "builtin:cornell");
        EXPECT_FALSE(text("sceneHash").empty());
        EXPECT_EQ(text("method"), "megaviews");
        EXPECT_EQ(text("seed"), "7");
        EXPECT_EQ(text("resolution"), "96x54");
        EXPECT_EQ(text("frame"), "0");
        EXPECT_EQ(text("tonemap"), "agx");
        for (const char* key : {"program", "exposure", "fov", "gl", "time"}) {
            EXPECT_NE(text(key), "") << key;
        }
        EXPECT_EQ(Json::parse(text("cameraMatrix")).size(), 16u);
        EXPECT_EQ(Json::parse(text("views")).at("requested"), 256);
        EXPECT_GT(Json::parse(text("methods")).at(0).at("pairs").at("processed"), 0);
        Settings settings;
        applyJson(settings, Json::parse(text("settings")), name);
        EXPECT_EQ(settings.views.vpls, 256);
        EXPECT_EQ(settings.resolution.width, 96);
        EXPECT_TRUE(settings.display.exposureEv.has_value());
        EXPECT_TRUE(settings.camera.position.has_value());
    }
}

TEST(Headless, MetadataMakesThePictureAgain) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.megaviews(smallPicture({"-o", "a.png"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    const Picture a = readPicture(sandbox.file("a.png"));
    sandbox.write("a.json", a.texts.at("megaviews.settings"));
    const ProcessResult again = sandbox.megaviews({"--headless", "--no-cache", "--config", "a.json",
                                                   "-o", "b.png", a.texts.at("megaviews.scene")});
    ASSERT_EQ(again.code, 0) << again.err;
    const Picture b = readPicture(sandbox.file("b.png"));
    // The camera went through decimal text and back through another matrix: edges may move by an
    // ulp, and a pixel whose receiver changes node draws other samples.
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        different += std::abs(a.values[i] - b.values[i]) > 3.0f / 255;
    }
    EXPECT_LT(different, a.values.size() / 50);
}

TEST(Headless, StatisticsAreComplete) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.megaviews(smallPicture(
        {"--stats", "s.json", "--compare", "manylods", "--frames", "3", "--warmup", "1"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(r.out, "s.json\n");
    const Json s = Json::parse(sandbox.text("s.json"));
    EXPECT_EQ(s.at("schema"), 1);
    for (const char* key : {"vendor", "renderer", "version", "platform"}) {
        EXPECT_FALSE(s.at("gl").at(key).get<std::string>().empty()) << key;
    }
    EXPECT_FALSE(s.at("host").at("cpu").get<std::string>().empty());
    const Json& scene = s.at("scene");
    EXPECT_EQ(scene.at("name"), "builtin:cornell");
    EXPECT_FALSE(scene.at("hash").get<std::string>().empty());
    EXPECT_GT(scene.at("triangles"), 10);
    ASSERT_EQ(scene.at("nodesPerLevel").size(), 6u);
    ASSERT_EQ(scene.at("leavesPerLevel").size(), 6u);
    EXPECT_EQ(scene.at("nodesPerLevel")[0], 1);
    EXPECT_EQ(scene.at("nodesPerLevel")[5], scene.at("leavesPerLevel")[5]);
    EXPECT_EQ(s.at("settings").size(), settingsTable().size());
    EXPECT_EQ(s.at("frames"), Json({{"warmup", 1}, {"measured", 3}, {"partial", false}}));
    EXPECT_EQ(s.at("deterministic"), true);
    EXPECT_EQ(s.at("views").at("requested"), 256);
    EXPECT_GT(s.at("views").at("alive"), 0);
    EXPECT_EQ(s.at("picture").at("badPixels"), 0);

    std::set<std::string> stages;
    const auto checkSummary = [](const Json& summary) {
        for (const char* key : {"median", "p95", "min", "max"}) {
            EXPECT_TRUE(summary.at(key).is_number()) << key;
        }
        EXPECT_LE(summary.at("min"), summary.at("median"));
        EXPECT_LE(summary.at("median"), summary.at("p95"));
        EXPECT_LE(summary.at("p95"), summary.at("max"));
    };
    checkSummary(s.at("frameMs"));
    ASSERT_EQ(s.at("methods").size(), 2u);
    EXPECT_EQ(s.at("methods")[0].at("method"), "megaviews");
    EXPECT_EQ(s.at("methods")[1].at("method"), "manylods");
    for (const Json& m : s.at("methods")) {
        for (const auto& info : methodStatistics()) {
            EXPECT_TRUE(m.contains(Json::json_pointer(std::string(info.path)))) << info.path;
        }
        const Json& pairs = m.at("pairs");
        EXPECT_EQ(pairs.at("processed").get<std::uint64_t>(),
                  pairs.at("culled").get<std::uint64_t>() +
                      pairs.at("rendered").get<std::uint64_t>() +
                      pairs.at("subdivided").get<std::uint64_t>() +
                      pairs.at("skipped").get<std::uint64_t>());
        EXPECT_GT(pairs.at("rendered"), 0);
        EXPECT_GE(m.at("viewsPerRenderedNode"), 1.0);
        EXPECT_GE(m.at("passes"), 1);
        for (const char* key : {"queue", "maps", "sceneHierarchy", "viewHierarchy"}) {
            EXPECT_GT(m.at("memoryBytes").at(key), 0) << key;
        }
        EXPECT_FALSE(m.at("clock").get<std::string>().empty());
        EXPECT_GT(m.at("ms").at("traverse").at("median"), 0);
        for (const auto& [stage, summary] : m.at("ms").items()) {
            stages.insert(stage);
            checkSummary(summary);
        }
    }
    for (const auto& [stage, summary] : s.at("shared").at("ms").items()) {
        stages.insert(stage);
        checkSummary(summary);
    }
    // Frames are measured whole: nothing is taken from the one before.
    EXPECT_GT(s.at("shared").at("ms").at("trace views").at("min"), 0);
    // Every stage that is timed is described.
    std::set<std::string> described;
    for (const StageInfo& stage : stageTable()) described.emplace(stage.name);
    for (const std::string& stage : stages) EXPECT_TRUE(described.contains(stage)) << stage;
}

TEST(Headless, TheSplitShowsBothMethods) {
    const Sandbox sandbox;
    const auto render = [&](const std::string& name, std::vector<std::string> more) {
        more.insert(more.end(), {"-o", name, "--exposure", "1"});
        return sandbox.megaviews(smallPicture(more));
    };
    const ProcessResult both = render("both.png", {"--compare", "manylods", "--split", "0.25"});
    MV_SKIP_WITHOUT_GL(both);
    ASSERT_EQ(both.code, 0) << both.err;
    ASSERT_EQ(render("left.png", {}).code, 0);
    ASSERT_EQ(render("right.png", {"--method", "manylods"}).code, 0);
    const Picture b = readPicture(sandbox.file("both.png"));
    const Picture l = readPicture(sandbox.file("left.png"));
    const Picture r = readPicture(sandbox.file("right.png"));
    for (int y = 0; y < b.height; ++y) {
        for (int x = 0; x < b.width; ++x) {
            const float* expected = x < 24 ? l.at(x, y) : r.at(x, y);
            for (int c = 0; c < 3; ++c) ASSERT_EQ(b.at(x, y)[c], expected[c]) << x << "," << y;
        }
    }
}

TEST(Headless, FramesAreNumbered) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.megaviews(smallPicture(
        {"--frames", "2", "-o", "a.png", "-o", "b{frame:02}.png", "-o", "{frame}.exr"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(r.out, "a.0000.png\nb00.png\n0.exr\na.0001.png\nb01.png\n1.exr\n");
    EXPECT_EQ(readPicture(sandbox.file("b01.png")).texts.at("megaviews.frame"), "1");
}

TEST(Headless, SavedViewsLightThePictureAlike) {
    const Sandbox sandbox;
    const ProcessResult r =
        sandbox.megaviews(smallPicture({"--save-views", "v.ply", "--stats", "a.json"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    const ProcessResult again =
        sandbox.megaviews(smallPicture({"--views", "v.ply", "--stats", "b.json"}));
    ASSERT_EQ(again.code, 0) << again.err;
    const Json a = Json::parse(sandbox.text("a.json")), b = Json::parse(sandbox.text("b.json"));
    EXPECT_EQ(a.at("views").at("alive"), b.at("views").at("alive"));
    EXPECT_EQ(b.at("views").at("requested"), a.at("views").at("alive"));
    EXPECT_EQ(a.at("methods")[0].at("maps"), b.at("methods")[0].at("maps"));

    sandbox.write("bad.ply", "ply\nformat ascii 1.0\nelement vertex 3\nend_header\n");
    const ProcessResult bad = sandbox.megaviews(smallPicture({"--views", "bad.ply"}));
    EXPECT_EQ(bad.code, 3) << bad.err;
    EXPECT_NE(bad.err.find("bad.ply"), std::string::npos);
    EXPECT_EQ(sandbox.megaviews(smallPicture({"--views", "absent.ply"})).code, 3);
}

TEST(Headless, MapsHaveTheShapeTheyPromise) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.megaviews(smallPicture(
        {"--save-maps", "m.npy", "--stats", "s.json", "--view-res", "8", "--placement", "traced"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    const Json s = Json::parse(sandbox.text("s.json"));
    const std::string maps = std::to_string(s.at("methods")[0].at("maps").get<std::uint64_t>());
    const std::string header = sandbox.text("m.npy").substr(0, 128);
    EXPECT_NE(header.find("(" + maps + ", 2, 8, 8)"), std::string::npos) << header;
    EXPECT_NE(header.find("<f4"), std::string::npos) << header;
    EXPECT_NE(sandbox.text("m.centres.npy").find("(" + maps + ", 3)"), std::string::npos);
    EXPECT_NE(sandbox.text("m.views.npy").find("(256,)"), std::string::npos);
}

// With lights elsewhere and brighter, a camera of the line's own, and at a time.
TEST(Headless, ASavedSceneDrawsTheSamePicture) {
    const Sandbox sandbox;
    for (const char* method : {"megaviews", "pathtraced"}) {
        SCOPED_TRACE(method);
        const std::vector<std::string> how = {
            "--headless",          "--no-cache", "--scene-depth", "6",
            "--view-depth",        "6",          "--vpls",        "256",
            "--resolution",        "64x36",      "--method",      method,
            "--reference-samples", "8"};
        const auto render = [&](std::vector<std::string> what) {
            what.insert(what.end(), how.begin(), how.end());
            return sandbox.megaviews(what);
        };
        const ProcessResult first =
            render({"builtin:cornell", "--time", "3.3", "--lights", "0:0.5,4,0.1:0.2,-1,0.1",
                    "--light-scale", "3", "--camera-position", "1,2,3", "--camera-target",
                    "0,1.5,-1", "--fov", "70", "-o", "a.exr", "--save-scene", "s.glb"});
        MV_SKIP_WITHOUT_GL(first);
        ASSERT_EQ(first.code, 0) << first.err;
        EXPECT_EQ(first.out, "a.exr\ns.glb\n");
        const ProcessResult second = render({"s.glb", "-o", "b.exr"});
        ASSERT_EQ(second.code, 0) << second.err;
        EXPECT_EQ(second.err.find("warning"), std::string::npos) << second.err;
        EXPECT_EQ(readPicture(sandbox.file("a.exr")).values,
                  readPicture(sandbox.file("b.exr")).values);
    }
}

TEST(Headless, NotANumberIsCode1) {
    // Views so strong that their sum is no number.
    const Sandbox sandbox;
    std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
        "property double z\nproperty float red\nproperty float green\nproperty float blue\n"
        "end_header\n";
    const Json info =
        Json::parse(sandbox.megaviews({"--info=json", "builtin:cornell"}).out).at("scene");
    std::string middle;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = info.at("bounds").at("min")[static_cast<std::size_t>(axis)];
        const double high = info.at("bounds").at("max")[static_cast<std::size_t>(axis)];
        middle += std::to_string((low + high) / 2) + " ";
    }
    for (int i = 0; i < 4; ++i) ply += middle + "3e38 3e38 3e38\n";
    sandbox.write("v.ply", ply);
    const ProcessResult r =
        sandbox.megaviews(smallPicture({"--views", "v.ply", "-o", "x.png", "--stats", "s.json"}));
    MV_SKIP_WITHOUT_GL(r);
    EXPECT_EQ(r.code, 1) << r.err;
    EXPECT_NE(r.err.find("NaN or infinite"), std::string::npos) << r.err;
    EXPECT_GT(Json::parse(sandbox.text("s.json")).at("picture").at("badPixels"), 0);
    const ProcessResult saved =
        sandbox.megaviews(smallPicture({"--views", "v.ply", "--actions", "save x.png"}));
    EXPECT_EQ(saved.code, 1) << saved.err;
    EXPECT_NE(saved.err.find("NaN or infinite"), std::string::npos) << saved.err;
}

TEST(Headless, WithoutOpenGlIsCode4) {
    const Sandbox sandbox;
    for (const std::map<std::string, std::string>& environment :
         {std::map<std::string, std::string>{{"MESA_GL_VERSION_OVERRIDE", "3.3"}},
          std::map<std::string, std::string>{{"__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent"}}}) {
        const ProcessResult r = sandbox.megaviews(smallPicture({"-o", "x.png"}), environment);
        EXPECT_EQ(r.code, 4) << r.err;
        EXPECT_NE(r.errLine(), "");
    }
    const ProcessResult window = sandbox.megaviews(smallPicture({"--gl", "window", "-o", "x.png"}));
    EXPECT_EQ(window.code, 4) << window.err;
    EXPECT_EQ(sandbox.megaviews({"--gl", "window"}).code, 4);
}

TEST(Headless, BrokenShaderIsCode4AndNamesTheLine) {
    const Sandbox sandbox;
    const std::filesystem::path shaders = sandbox.file("shaders");
    std::filesystem::copy(std::filesystem::path(MEGAVIEWS_SOURCE_DIR) / "shaders", shaders,
                          std::filesystem::copy_options::recursive);
    sandbox.write("shaders/passes/compose.frag", "this is no shader\n");
    const ProcessResult r = sandbox.megaviews(smallPicture({"-o", "x.png"}),
                                              {{"MEGAVIEWS_SHADER_DIR", shaders.string()}});
    EXPECT_EQ(r.code, 4) << r.err;
    EXPECT_NE(r.err.find("compose.frag"), std::string::npos) << r.err;
}

TEST(Headless, WhatCannotFitIsCode6) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.megaviews(
        smallPicture({"--gpu-memory", "1", "--view-res", "256", "--fusion", "off", "-o", "x.png"}));
    MV_SKIP_WITHOUT_GL(r);
    EXPECT_EQ(r.code, 6) << r.err;
    EXPECT_NE(r.errLine(), "");
    EXPECT_FALSE(std::filesystem::exists(sandbox.file("x.png")));
}

TEST(Headless, OutputThatFailsLateIsCode5) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.megaviews(smallPicture({"--stats", "/dev/full"}));
    MV_SKIP_WITHOUT_GL(r);
    EXPECT_EQ(r.code, 5) << r.err;
    EXPECT_NE(r.err.find("/dev/full"), std::string::npos) << r.err;
}

TEST(Headless, StatisticsGoThroughAPipe) {
    const Sandbox sandbox;
    std::string command =
        std::string(MEGAVIEWS_BINARY_DIR) + "/megaviews --headless --no-config -q";
    for (const std::string& word : smallPicture()) command += " " + word;
    const ProcessResult r = sandbox.run("/bin/sh", {"-c", command + " --stats /dev/stdout | cat"});
    MV_SKIP_WITHOUT_GL(r);
    EXPECT_TRUE(r.out.starts_with("{")) << r.out << r.err;
}

TEST(Headless, APictureThatFailsLateLeavesTheStatisticsOfTheFramesBefore) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
    const Sandbox sandbox;
    std::filesystem::create_symlink("/dev/full", sandbox.file("f.0001.png"));
    const ProcessResult r = sandbox.run(
        "megaviews", smallPicture({"--frames", "3", "-o", "f.png", "--stats", "s.json"}));
    MV_SKIP_WITHOUT_GL(r);
    EXPECT_EQ(r.code, 5) << r.err;
    EXPECT_NE(r.err.find("f.0001.png"), std::string::npos) << r.err;
    const Json s = Json::parse(sandbox.text("s.json"));
    EXPECT_EQ(s.at("frames").at("partial"), true);
    EXPECT_EQ(s.at("frames").at("measured"), 2);
}

TEST(Headless, WithoutADisplayItSaysWhereThePictureIs) {
    const Sandbox sandbox;
    std::vector<std::string> arguments = smallPicture();
    arguments.erase(arguments.begin());  // --headless
    const ProcessResult r = sandbox.megaviews(arguments);
    MV_SKIP_WITHOUT_GL(r);
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(r.out, "megaviews.png\n");
    EXPECT_NE(r.err.find("no display"), std::string::npos) << r.err;
    EXPECT_NE(r.err.find("megaviews.png"), std::string::npos) << r.err;
    EXPECT_EQ(readPicture(sandbox.file("megaviews.png")).width, 96);
    // Edges as in the window; a picture that is asked for is what its settings say.
    EXPECT_EQ(readPicture(sandbox.file("megaviews.png")).texts.at("megaviews.pixelSamples"), "4");
    arguments.insert(arguments.end(), {"--pixel-samples", "1"});
    ASSERT_EQ(sandbox.megaviews(arguments).code, 0);
    EXPECT_EQ(readPicture(sandbox.file("megaviews.png")).texts.at("megaviews.pixelSamples"), "1");
}

TEST(Headless, LogsGoWhereTheyAreSent) {
    const Sandbox sandbox;
    const ProcessResult r =
        sandbox.megaviews(smallPicture({"-q", "-o", "x.png", "--log-file", "l"}));
    MV_SKIP_WITHOUT_GL(r);
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(r.err.find("info"), std::string::npos) << r.err;
    EXPECT_NE(sandbox.text("l").find("frame 0"), std::string::npos);
    EXPECT_EQ(r.err.find('\033'), std::string::npos);  // NO_COLOR
}

TEST(Headless, TheCacheIsUsedAndNeverDecides) {
    const Sandbox sandbox;
    std::vector<std::string> arguments = smallPicture({"-o", "a.png"});
    std::erase(arguments, "--no-cache");
    const ProcessResult r = sandbox.megaviews(arguments);
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(sandbox.file("cache/megaviews"))) {
        if (entry.is_regular_file()) files.push_back(entry.path());
    }
    ASSERT_FALSE(files.empty());
    arguments.back() = "b.png";
    ASSERT_EQ(sandbox.megaviews(arguments).code, 0);
    EXPECT_EQ(sandbox.text("a.png"), sandbox.text("b.png"));
    // A broken cache is a warning and a new tree.
    for (const auto& file : files) std::filesystem::resize_file(file, 100);
    arguments.back() = "c.png";
    ASSERT_EQ(sandbox.megaviews(arguments).code, 0);
    EXPECT_EQ(sandbox.text("a.png"), sandbox.text("c.png"));
}

// A driver at work is not waited for, and what it works at is not read.
TEST(Headless, InterruptKeepsWhatIsFinished) {
    for (const char* samples : {"8", "1024"}) {
        const Sandbox sandbox;
        const pid_t pid = sandbox.start(
            "megaviews", smallPicture({"--frames", "100000", "--resolution", "320x180",
                                       "--gather-samples", samples, "-o", "f.png", "--stats",
                                       "s.json", "--save-views", "v.ply", "--save-maps", "m.npy",
                                       "--save-scene", "g.glb", "--save-state", "t.json"}));
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (!std::filesystem::exists(sandbox.file("f.0000.png")) && kill(pid, 0) == 0 &&
               std::chrono::steady_clock::now() < deadline) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            if (!sandbox.text("stderr").empty() &&
                sandbox.text("stderr").find("megaviews: ") != std::string::npos) {
                break;  // it failed
            }
        }
        kill(pid, SIGINT);
        const ProcessResult r = sandbox.wait(pid);
        MV_SKIP_WITHOUT_GL(r);
        EXPECT_EQ(r.code, 130) << r.err;
        const Json s = Json::parse(sandbox.text("s.json"));
        EXPECT_EQ(s.at("frames").at("partial"), true);
        EXPECT_GE(s.at("frames").at("measured"), 1);
        EXPECT_EQ(readPicture(sandbox.file("f.0000.png")).width, 320);
        for (const char* file :
             {"v.ply", "m.npy", "m.centres.npy", "m.views.npy", "g.glb", "t.json"}) {
            EXPECT_FALSE(sandbox.text(file).empty()) << file;
        }
    }
}

// Other than a window, whose panels say it.
TEST(Headless, SaysWhatThereIsNotToLookAt) {
    const Sandbox sandbox;
    const ProcessResult r =
        sandbox.megaviews(smallPicture({"--pick-a", "999999", "--step", "32", "--pair-scene",
                                        "9999999", "--pair-view", "0", "-o", "x.png"}));
    MV_SKIP_WITHOUT_GL(r);
    EXPECT_EQ(r.code, 0) << r.err;
    for (const char* said :
         {"--pick-a 999999: no view in this slot has a map\n", "--step 32: the last step is ",
          "--pair-scene 9999999 --pair-view 0: "}) {
        EXPECT_NE(r.err.find(said), std::string::npos) << said << r.err;
    }
    const ProcessResult half =
        sandbox.megaviews(smallPicture({"--pair-scene", "0", "-o", "half.png"}));
    EXPECT_NE(half.err.find("--pair-scene: without --pair-view\n"), std::string::npos) << half.err;
}

TEST(Headless, InsistsOnADevice) {
    const Sandbox sandbox;
    const ProcessResult r =
        sandbox.megaviews(smallPicture({"-o", "x.png", "--gl-device", "nobody's"}));
    EXPECT_EQ(r.code, 4) << r.err;
    EXPECT_EQ(sandbox.run("megaviews-bench", {"selftest", "--gl-device", "nobody's"}).code, 4);
}

TEST(Bench, SelfTestPasses) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.run("megaviews-bench", {"selftest"});
    MV_SKIP_WITHOUT_GL(r);
    EXPECT_EQ(r.code, 0) << r.out << r.err;
    EXPECT_EQ(r.out.find("FAIL"), std::string::npos) << r.out;
    EXPECT_NE(r.out.find("5 of 5 cases passed"), std::string::npos) << r.out;
}

}  // namespace
}  // namespace mv::test
