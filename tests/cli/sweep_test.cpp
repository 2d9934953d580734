#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/process.h"
#include "megaviews/core/hash.h"
#include "support/write_npy.h"

namespace mv::test {
namespace {

using Json = nlohmann::json;

// Well under a second a point.
std::vector<std::string> smallSweep(std::vector<std::string> more) {
    std::vector<std::string> arguments = {"sweep",
                                          "builtin:cornell",
                                          "--no-cache",
                                          "--no-config",
                                          "--scene-depth",
                                          "5",
                                          "--view-depth",
                                          "5",
                                          "--resolution",
                                          "32x18",
                                          "--gather-samples",
                                          "8"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

std::string fileText(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Sweep, RefusesImagesBeforeItLoads) {
    const Sandbox sandbox;
    for (const std::vector<std::string>& asked :
         {std::vector<std::string>{"--environment", "sky.exr"},
          {"--sweep", "environment=none,sky.exr"}}) {
        const ProcessResult r = sandbox.run("megaviews-bench", smallSweep(asked));
        EXPECT_EQ(r.code, 2);
        EXPECT_NE(r.err.find("sky.exr"), std::string::npos) << r.err;
    }
}

TEST(Sweep, MeasuresEveryPoint) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.run(
        "megaviews-bench",
        smallSweep({"--sweep", "vpls=256,64", "--sweep", "method=megaviews,manylods,none",
                    "--frames", "2", "--out", "b.json"}));  // either file names both
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    const Json b = Json::parse(sandbox.text("b.json"));
    EXPECT_EQ(b.at("partial"), false);
    EXPECT_TRUE(b.at("command").get<std::string>().starts_with("megaviews-bench sweep builtin:"));
    ASSERT_EQ(b.at("points").size(), 6u);
    for (const Json& point : b.at("points")) {
        const std::string method = point.at("values").at("method");
        EXPECT_EQ(point.at("settings").at("method"), method);
        EXPECT_EQ(point.at("settings").at("vpls"), point.at("values").at("vpls"));
        EXPECT_EQ(point.at("views").at("requested"), point.at("values").at("vpls"));
        EXPECT_EQ(point.at("ms").at("maps").at("median") > 0, method != "none");
        EXPECT_GE(point.at("ms").at("frame").at("max"), point.at("ms").at("frame").at("min"));
        EXPECT_TRUE(point.at("errors").at("exact").is_null());
        EXPECT_TRUE(point.at("errors").at("maps").is_null());
        if (method == "none") continue;
        EXPECT_GT(point.at("pairs").at("processed"), 0);
        EXPECT_GT(point.at("speedup").at("median"), 0);
        if (method == "manylods") {
            EXPECT_EQ(point.at("speedup").at("median"), 1.0);
        }
    }
    // Maps take what this point needs, not what a larger one before it needed.
    EXPECT_LT(b.at("points")[4].at("memoryBytes").at("maps"),
              b.at("points")[1].at("memoryBytes").at("maps"));
    const std::string csv = sandbox.text("b.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
    EXPECT_NE(r.out.find("\n256 "), std::string::npos) << r.out;
}

TEST(Sweep, TimesAddUp) {
    const Sandbox sandbox;
    // One frame is measured: every summary is one number, and ratios are of these numbers.
    const ProcessResult r = sandbox.run(
        "megaviews-bench", smallSweep({"--vpls", "64", "--sweep", "method=megaviews,manylods",
                                       "--frames", "1", "--warmup", "2", "--out", "it's"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    const Json b = Json::parse(sandbox.text("it's.json"));
    EXPECT_NE(b.at("command").get<std::string>().find(" --out 'it'\\''s'"), std::string::npos)
        << b.at("command");
    const auto median = [](const Json& point, const char* pointer) {
        const Json& summary = point.at(Json::json_pointer(pointer));
        EXPECT_EQ(summary.at("min"), summary.at("max")) << pointer;
        return summary.at("median").get<double>();
    };
    const Json& lods = b.at("points")[1];
    for (const Json& point : b.at("points")) {
        const double maps = median(point, "/ms/maps"), gather = median(point, "/ms/gather");
        EXPECT_NEAR(maps, median(point, "/stages/traverse"), 1e-9);
        EXPECT_NEAR(gather,
                    median(point, "/stages/gather cull") + median(point, "/stages/gather") +
                        median(point, "/stages/near field") + median(point, "/stages/filter"),
                    1e-9);
        EXPECT_NEAR(median(point, "/ms/indirect"), maps + gather, 1e-9);
        EXPECT_GT(median(point, "/ms/frame"), maps + gather);
        EXPECT_NEAR(median(point, "/speedup") * maps, median(lods, "/ms/maps"), 1e-9);
    }
}

TEST(Sweep, RendersEachPointAtItsOwnTime) {
    const Sandbox sandbox;
    // A floor, and a wall that rises out of sight.
    std::ofstream(sandbox.file("a.gltf")) << R"({"asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 50}]}},
        "buffers": [{"byteLength": 92, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAAAAABAAIAAAACAAMAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAABAQAAAgD8="}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48,
            "byteLength": 12}, {"buffer": 0, "byteOffset": 60, "byteLength": 8}, {"buffer": 0,
            "byteOffset": 68, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
            "min": [0, 0, 0], "max": [1, 1, 0]}, {"bufferView": 1, "componentType": 5123,
            "count": 6, "type": "SCALAR"}, {"bufferView": 2, "componentType": 5126, "count": 2,
            "type": "SCALAR", "min": [0], "max": [1]}, {"bufferView": 3, "componentType": 5126,
            "count": 2, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "nodes": [{"mesh": 0, "rotation": [-0.70710678, 0, 0, 0.70710678], "scale": [2, 2, 2]},
            {"mesh": 0, "translation": [0, 0, 1]}, {"translation": [1, 1, 0],
            "extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "animations": [{"samplers": [{"input": 2, "output": 3}], "channels": [{"sampler": 0,
            "target": {"node": 1, "path": "translation"}}]}],
        "scenes": [{"nodes": [0, 1, 2]}], "scene": 0})";
    const auto sweep = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments =
            smallSweep({"--vpls", "64", "--frames", "1", "--warmup", "0", "--out", "b"});
        arguments[1] = "a.gltf";
        arguments.insert(arguments.end(), more.begin(), more.end());
        return sandbox.run("megaviews-bench", arguments);
    };
    const auto pairs = [&](std::size_t i) {
        const Json b = Json::parse(sandbox.text("b.json"));
        return b.at("points").at(i).at("pairs").at("processed").get<int>();
    };
    const ProcessResult r = sweep({"--sweep", "time=0,0.5"});
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    const int early = pairs(0), late = pairs(1);
    EXPECT_NE(early, late);
    for (const auto& [time, expected] : {std::pair{"0", early}, {"0.5", late}}) {
        ASSERT_EQ(sweep({"--time", time, "--sweep", "method=megaviews"}).code, 0);
        EXPECT_EQ(pairs(0), expected) << time;
    }
}

TEST(Sweep, PlacesViewsAndChangesTheOctree) {
    const Sandbox sandbox;
    const ProcessResult r =
        sandbox.run("megaviews-bench",
                    smallSweep({"--sweep", "scene-depth=4,6,4K", "--frames", "1", "--out", "b"}));
    EXPECT_EQ(r.code, r.code == 4 ? 4 : 2) << r.err;  // 4K levels
    const ProcessResult s = sandbox.run(
        "megaviews-bench", smallSweep({"--sweep", "scene-depth=6,4", "--sweep",
                                       "distribution=single,bounces,particles,random", "--vpls",
                                       "128", "--frames", "1", "--warmup", "0", "--out", "b"}));
    MV_SKIP_WITHOUT_GL(s);
    ASSERT_EQ(s.code, 0) << s.err;
    const Json b = Json::parse(sandbox.text("b.json"));
    ASSERT_EQ(b.at("points").size(), 8u);
    for (std::size_t i = 0; i < 4; ++i) {
        const Json &deep = b.at("points")[i], &flat = b.at("points")[i + 4];
        EXPECT_EQ(deep.at("views").at("requested"), 128) << i;
        EXPECT_GT(deep.at("views").at("alive"), 0) << i;
        EXPECT_GT(deep.at("pairs").at("processed"), flat.at("pairs").at("processed")) << i;
        EXPECT_GT(deep.at("memoryBytes").at("sceneHierarchy"),
                  flat.at("memoryBytes").at("sceneHierarchy"));
    }
    EXPECT_EQ(b.at("points")[0].at("settings").at("bounces"), 1);
    EXPECT_EQ(b.at("points")[3].at("views").at("alive"), 128);
}

TEST(Sweep, ShowsRefusalsAsRows) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.run(
        "megaviews-bench",
        smallSweep({"--sweep", "view-res=8,256", "--vpls", "1K", "--gpu-memory", "2", "--fusion",
                    "off", "--frames", "1", "--warmup", "0", "--out", "b"}));
    MV_SKIP_WITHOUT_GL(r);
    EXPECT_EQ(r.code, 6) << r.err;
    const Json b = Json::parse(sandbox.text("b.json"));
    ASSERT_EQ(b.at("points").size(), 2u);
    EXPECT_TRUE(b.at("points")[0].at("refusal").is_null());
    const std::string refusal = b.at("points")[1].at("refusal");
    EXPECT_NE(r.out.find("256       " + refusal), std::string::npos) << r.out;
    EXPECT_FALSE(b.at("points")[1].contains("ms"));
    // Without --resolution the picture is small.
    const ProcessResult d = sandbox.run(
        "megaviews-bench", {"sweep", "builtin:cornell", "--no-cache", "--no-config",
                            "--scene-depth", "5", "--sweep", "view-res=256", "--vpls", "1K",
                            "--gpu-memory", "2", "--fusion", "off", "--frames", "1", "--out", "d"});
    EXPECT_EQ(d.code, 6) << d.err;
    EXPECT_EQ(Json::parse(sandbox.text("d.json")).at("settings").at("resolution"),
              (Json::array({640, 360})));
}

TEST(Sweep, ErrorsComeFromReferencesThatTheViewerMade) {
    const Sandbox sandbox;
    const std::vector<std::string> settings = {"builtin:cornell",
                                               "--no-cache",
                                               "--no-config",
                                               "--scene-depth",
                                               "5",
                                               "--view-depth",
                                               "5",
                                               "--resolution",
                                               "32x18",
                                               "--vpls",
                                               "64",
                                               "--references",
                                               "refs",
                                               "--reference-samples",
                                               "4"};
    for (const char* method : {"exact", "pathtraced"}) {
        std::vector<std::string> arguments = settings;
        arguments.insert(arguments.end(), {"--headless", "--method", method, "-o", "r.png"});
        const ProcessResult made = sandbox.megaviews(arguments);
        MV_SKIP_WITHOUT_GL(made);
        ASSERT_EQ(made.code, 0) << made.err;
    }
    std::vector<std::string> arguments = settings;
    arguments.insert(arguments.begin(), "sweep");
    arguments.insert(arguments.end(), {"--frames", "1", "--warmup", "0"});
    std::vector<std::string> grid = arguments;
    grid.insert(grid.end(), {"--sweep", "method=megaviews,none,exact", "--sweep", "seed=0,1",
                             "--gather-samples", "0", "--filter", "off", "--out", "b"});
    const ProcessResult r = sandbox.run("megaviews-bench", grid);
    EXPECT_EQ(r.code, 6) << r.err;  // exact with seed 1 was never made
    EXPECT_NE(r.err.find("errors against it are n/a"), std::string::npos) << r.err;
    const Json b = Json::parse(sandbox.text("b.json"));
    ASSERT_EQ(b.at("points").size(), 6u);
    const auto error = [&](std::size_t point, const char* against, const char* metric) {
        return b.at("points")[point].at("errors").at(against).at(metric).get<double>();
    };
    EXPECT_GT(error(0, "exact", "relmse"), 0);
    EXPECT_LT(error(0, "exact", "relmse"), error(2, "exact", "relmse"));  // shadows help
    EXPECT_GT(error(0, "exact", "psnr"), error(2, "exact", "psnr"));
    EXPECT_GT(error(0, "pathtraced", "relmse"), 0);
    EXPECT_TRUE(b.at("points")[1].at("errors").at("exact").is_null());
    EXPECT_EQ(error(4, "exact", "relmse"), 0);  // against itself
    EXPECT_TRUE(b.at("points")[4].at("ms").at("indirect").is_null());
    EXPECT_TRUE(b.at("points")[5].at("refusal").is_string());

    // Particles are no paths: nothing but an exact reference says what they should light.
    std::vector<std::string> particles = arguments;
    particles.insert(particles.end(), {"--sweep", "particles=0,64", "--out", "p"});
    const ProcessResult placed = sandbox.run("megaviews-bench", particles);
    ASSERT_EQ(placed.code, 0) << placed.err;
    const Json p = Json::parse(sandbox.text("p.json"));
    EXPECT_FALSE(p.at("points")[0].at("errors").at("pathtraced").is_null());
    EXPECT_TRUE(p.at("points")[1].at("errors").at("pathtraced").is_null());

    // The error asked for is the one that is reached for.
    for (const std::string asked : {"relmse", "pathtraced.psnr"}) {
        const std::size_t dot = asked.find('.');
        const std::string against = dot == std::string::npos ? "exact" : asked.substr(0, dot);
        const std::string metric = asked.substr(dot == std::string::npos ? 0 : dot + 1);
        std::vector<std::string> search = arguments;
        search.insert(search.end(), {"--sweep", "method=megaviews", "--equal-error", asked + ":0.5",
                                     "--vary", "gather-samples=2,4", "--out", "s"});
        const ProcessResult found = sandbox.run("megaviews-bench", search);
        ASSERT_EQ(found.code, 0) << found.err;
        const Json point = Json::parse(sandbox.text("s.json")).at("points")[0];
        for (const Json& tried : point.at("search").at("tried")) {
            if (tried.at("value") != point.at("search").at("value")) continue;
            EXPECT_EQ(tried.at("error"), point.at("errors").at(against).at(metric)) << asked;
        }
    }

    // Equal error: the fewest samples that reach it; and one that nothing reaches.
    for (const char* limit : {"psnr:25", "psnr:200"}) {
        std::vector<std::string> search = arguments;
        search.insert(search.end(),
                      {"--sweep", "method=megaviews", "--filter", "off", "--equal-error", limit,
                       "--vary", "gather-samples=1..64:x2", "--out", "s"});
        const ProcessResult found = sandbox.run("megaviews-bench", search);
        ASSERT_EQ(found.code, 0) << found.err;
        const Json s = Json::parse(sandbox.text("s.json"));
        const Json& point = s.at("points")[0];
        const bool met = point.at("search").at("met");
        EXPECT_EQ(met, point.at("errors").at("exact").at("psnr") >= std::stod(limit + 5));
        EXPECT_EQ(met, std::string(limit) == "psnr:25");
        EXPECT_EQ(point.at("search").at("value"), point.at("settings").at("gather-samples"));
        EXPECT_EQ(found.out.find("not met: 64") != std::string::npos, !met) << found.out;
        for (const Json& tried : point.at("search").at("tried")) {
            if (tried.at("value") < point.at("search").at("value")) {
                EXPECT_LT(tried.at("error"), std::stod(limit + 5));
            }
        }
    }

    // What is half made is no reference.
    for (const auto& entry : std::filesystem::directory_iterator(sandbox.file("refs"))) {
        const std::string file = entry.path().string();
        if (!entry.path().filename().string().starts_with("exact-") || !file.ends_with(".npy")) {
            continue;
        }
        NpyArray<float> half = readNpy<float>(file);
        ASSERT_EQ(half.shape, (std::vector<std::uint64_t>{18, 32, 3}));
        half.elements.resize(9 * 32 * 3);
        const std::string partial = file.substr(0, file.size() - 4) + ".partial.npy";
        writeNpy<float>(partial, {9, 32, 3}, half.elements);
        std::ofstream(partial + ".xxh")
            << Hash().add(std::as_bytes(std::span(half.elements))).hex() << "\n";
        std::filesystem::remove(file);
    }
    std::vector<std::string> again = arguments;
    again.insert(again.end(), {"--sweep", "method=megaviews", "--out", "h"});
    const ProcessResult h = sandbox.run("megaviews-bench", again);
    ASSERT_EQ(h.code, 0) << h.err;
    EXPECT_NE(h.err.find(".npy is not complete: errors against it are n/a"), std::string::npos)
        << h.err;
    const Json unfinished = Json::parse(sandbox.text("h.json")).at("points")[0].at("errors");
    EXPECT_TRUE(unfinished.at("exact").is_null());
    EXPECT_FALSE(unfinished.at("pathtraced").is_null());
}

TEST(Sweep, EqualTimeTakesTheLastThatFits) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.run(
        "megaviews-bench", smallSweep({"--sweep", "method=megaviews,none", "--equal-time", "1e6",
                                       "--vary", "gather-samples=1,2,4", "--frames", "1",
                                       "--warmup", "0", "--vpls", "64", "--out", "b"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    const Json b = Json::parse(sandbox.text("b.json"));
    for (const Json& point : b.at("points")) {
        EXPECT_EQ(point.at("search").at("met"), true);
        EXPECT_EQ(point.at("search").at("value"), 4);
        EXPECT_FALSE(point.at("values").contains("gather-samples"));
    }
}

TEST(Sweep, InterruptedItKeepsWhatItHasAndResumes) {
    const Sandbox sandbox;
    const std::vector<std::string> arguments =
        smallSweep({"--sweep", "seed=1..400:+1", "--vpls", "64", "--frames", "1", "--warmup", "0",
                    "--out", "b"});
    const pid_t pid = sandbox.start("megaviews-bench", arguments);
    const auto file = sandbox.file("b.json");
    for (int i = 0; i < 3000 && !std::filesystem::exists(file); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        if (kill(pid, 0) != 0) break;
    }
    kill(pid, SIGTERM);
    const ProcessResult r = sandbox.wait(pid);
    MV_SKIP_WITHOUT_GL(r);
    EXPECT_EQ(r.code, 130) << r.err;
    const Json b = Json::parse(fileText(file));
    EXPECT_EQ(b.at("partial"), true);
    const std::size_t kept = b.at("points").size();
    ASSERT_GE(kept, 1u);
    ASSERT_LT(kept, 400u);
    EXPECT_NE(r.err.find(std::to_string(kept) + " of 400 points are in b.json"), std::string::npos)
        << r.err;

    // A smaller grid of the same seeds: those that are there are not measured again.
    std::vector<std::string> again = arguments;
    *std::find(again.begin(), again.end(), "seed=1..400:+1") =
        "seed=1.." + std::to_string(kept + 2) + ":+1";
    again.emplace_back("--resume");
    const ProcessResult s = sandbox.run("megaviews-bench", again);
    ASSERT_EQ(s.code, 0) << s.err;
    const Json whole = Json::parse(fileText(file));
    EXPECT_EQ(whole.at("partial"), false);
    ASSERT_EQ(whole.at("points").size(), kept + 2);
    for (std::size_t i = 0; i < kept; ++i) {
        EXPECT_EQ(whole.at("points")[i].at("ms"), b.at("points")[i].at("ms"));
    }
    // Of a grid that lacks some of them none is thrown away.
    std::vector<std::string> others = again;
    *std::find(others.begin(), others.end(), "seed=1.." + std::to_string(kept + 2) + ":+1") =
        "seed=2..4:+1";
    const ProcessResult lost = sandbox.run("megaviews-bench", others);
    EXPECT_EQ(lost.code, 2);
    EXPECT_NE(lost.err.find("points that this sweep has not"), std::string::npos) << lost.err;
    EXPECT_EQ(Json::parse(fileText(file)).at("points").size(), kept + 2);
    again.emplace_back("--frames=2");
    EXPECT_EQ(sandbox.run("megaviews-bench", again).code, 2);
}

}  // namespace
}  // namespace mv::test
