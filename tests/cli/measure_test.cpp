// Pictures measured against references by the program as built.

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/process.h"
#include "megaviews/measure/map_errors.h"
#include "megaviews/measure/metrics.h"
#include "support/write_npy.h"

namespace mv::test {
namespace {

using Json = nlohmann::json;

// "psnr 24.8 dB" -> {"psnr", 24.8}.
std::map<std::string, double> valuesOf(const std::string& text) {
    std::map<std::string, double> out;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string name, value;
        words >> name >> value;
        if (findMetric(name)) out[name] = std::stod(value);
    }
    return out;
}

TEST(Measure, FindsNoErrorInThePictureItself) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.megaviews(smallPicture({"-o", "r.exr", "-o", "r.png"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    const ProcessResult linear = sandbox.megaviews(
        smallPicture({"--reference", "r.exr", "--threshold", "psnr:90", "--threshold", "mse:0"}));
    EXPECT_EQ(linear.code, 0) << linear.err;
    EXPECT_EQ(linear.out,
              "mse 0\nrelmse 0\nmape 0 %\npsnr inf dB\nssim 1\nflip 0\nhdr-flip 0\nleaked 0 %\n"
              "occluded 0 %\n");
    const ProcessResult display = sandbox.megaviews(smallPicture({"--reference", "r.png"}));
    EXPECT_EQ(display.code, 0) << display.err;
    EXPECT_EQ(display.out, "psnr inf dB\nssim 1\nflip 0\n");
}

// A script may keep a picture for the errors panel, also one of another size.
TEST(Measure, IsAgainstTheFileWhateverAScriptKeeps) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.megaviews(smallPicture({"-o", "r.exr"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    const std::string keep = "keep-left-as-reference; wait 4; ";
    for (const std::string& script :
         {"method=none; wait 2; " + keep + "method=megaviews; wait 2",
          "resize 40x40; wait 2; " + keep + "resize " + std::string("96x54") + "; wait 2"}) {
        const ProcessResult m = sandbox.megaviews(
            smallPicture({"--reference", "r.exr", "--metrics", "mse", "--actions", script}));
        EXPECT_EQ(m.code, 0) << m.err;
        EXPECT_EQ(m.out, "mse 0\n");
    }
    const ProcessResult other = sandbox.megaviews(smallPicture(
        {"--reference", "r.exr", "--metrics", "mse", "--actions", keep + "resize 40x40; wait 2"}));
    EXPECT_EQ(other.code, 2);
    EXPECT_NE(other.err.find("the picture 40x40"), std::string::npos) << other.err;
}

TEST(Measure, SaysTheSameOnOutputInStatisticsAndInThePicture) {
    const Sandbox sandbox;
    const ProcessResult r =
        sandbox.megaviews(smallPicture({"-o", "r.exr", "-o", "r.png", "--gather-samples", "64"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    const ProcessResult m = sandbox.megaviews(
        smallPicture({"--gather-samples", "2", "--reference", "r.exr", "--stats", "s.json", "-o",
                      "a.png", "-o", "a.exr", "--diff", "d.png", "--threshold", "psnr:1"}));
    ASSERT_EQ(m.code, 0) << m.err;
    EXPECT_TRUE(m.out.ends_with("d.png\na.png\na.exr\ns.json\n")) << m.out;
    const std::map<std::string, double> printed = valuesOf(m.out);
    ASSERT_EQ(printed.size(), metricsTable().size());

    const Json stats = Json::parse(sandbox.text("s.json")).at("metrics");
    EXPECT_EQ(stats.at("reference"), "r.exr");
    EXPECT_EQ(stats.at("badPixels"), 0);
    EXPECT_EQ(stats.at("thresholds"),
              Json::parse(R"([{"metric": "psnr", "value": 1.0, "met": true}])"));
    for (const auto& [name, value] : printed) {
        EXPECT_NEAR(stats.at("values").at(name).get<double>() / value, 1, 1e-5) << name;
    }
    OIIO::ImageBuf picture(sandbox.file("a.png").string());
    EXPECT_EQ(picture.spec().get_string_attribute("megaviews.reference"), "r.exr");
    EXPECT_EQ(Json::parse(std::string(picture.spec().get_string_attribute("megaviews.metrics"))),
              stats);

    // What OpenImageIO finds between the files. They hold 8 bit of what was measured in float.
    const OIIO::ImageBuf reference(sandbox.file("r.png").string());
    ASSERT_TRUE(picture.read(0, 0, true, OIIO::TypeDesc::FLOAT));
    const auto display = OIIO::ImageBufAlgo::compare(picture, reference, 1, 1);
    EXPECT_NEAR(printed.at("psnr"), -20 * std::log10(display.rms_error), 0.1);
    const auto linear =
        OIIO::ImageBufAlgo::compare(OIIO::ImageBuf(sandbox.file("a.exr").string()),
                                    OIIO::ImageBuf(sandbox.file("r.exr").string()), 1, 1);
    EXPECT_NEAR(printed.at("mse") / (linear.rms_error * linear.rms_error), 1, 1e-5);
}

TEST(Measure, MissedThresholdsAreCode1) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.megaviews(smallPicture({"-o", "r.exr"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    const ProcessResult m = sandbox.megaviews(smallPicture(
        {"--light-scale", "0.5", "--reference", "r.exr", "--metrics", "psnr", "--threshold",
         "psnr:80", "--threshold", "mape:1", "--threshold", "flip:0.99", "-o", "a.png"}));
    EXPECT_EQ(m.code, 1);
    const std::map<std::string, double> printed = valuesOf(m.out);
    EXPECT_EQ(printed.size(), 3u) << m.out;  // what has a threshold is measured too
    EXPECT_GT(printed.at("mape"), 10);
    EXPECT_LT(printed.at("psnr"), 25);
    EXPECT_NE(m.err.find(" dB < 80 dB; mape "), std::string::npos) << m.err;
    EXPECT_NE(m.err.find(" % > 1 %"), std::string::npos) << m.err;
    EXPECT_EQ(m.err.find("flip"), std::string::npos) << m.err;
    EXPECT_TRUE(std::filesystem::exists(sandbox.file("a.png")));
}

TEST(Measure, TakesTheExposureAndToneMapOfTheReference) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.megaviews(
        smallPicture({"-o", "r.exr", "-o", "r.png", "--exposure", "-2", "--tonemap", "none"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    for (const char* reference : {"r.exr", "r.png"}) {
        const ProcessResult m = sandbox.megaviews(
            smallPicture({"--reference", reference, "--threshold", "psnr:100", "-o", "a.png"}));
        EXPECT_EQ(m.code, 0) << m.err;
        const OIIO::ImageBuf picture(sandbox.file("a.png").string());
        EXPECT_EQ(picture.spec().get_string_attribute("megaviews.exposure"), "-2.0");
        EXPECT_EQ(picture.spec().get_string_attribute("megaviews.tonemap"), "none");
        // What was given stays.
        const ProcessResult given = sandbox.megaviews(
            smallPicture({"--reference", reference, "--exposure", "1", "-o", "b.png"}));
        EXPECT_EQ(given.code, 0) << given.err;
        const OIIO::ImageBuf other(sandbox.file("b.png").string());
        EXPECT_EQ(other.spec().get_string_attribute("megaviews.exposure"), "1.0");
    }
}

TEST(Measure, SaysWhereTheReferenceHasOtherPointsOfPixels) {
    const Sandbox sandbox;
    const ProcessResult r =
        sandbox.megaviews(smallPicture({"-o", "r.exr", "--pixel-samples", "4"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    const ProcessResult centres = sandbox.megaviews(smallPicture({"--reference", "r.exr"}));
    EXPECT_EQ(centres.code, 0) << centres.err;
    EXPECT_NE(centres.err.find("has 4 points a pixel, the picture 1"), std::string::npos);
    const ProcessResult same = sandbox.megaviews(
        smallPicture({"--reference", "r.exr", "--pixel-samples", "4", "--threshold", "psnr:120"}));
    EXPECT_EQ(same.code, 0) << same.err;
    EXPECT_EQ(same.err.find("points a pixel"), std::string::npos) << same.err;
}

TEST(Measure, DifferencesAreWrittenAsColoursOrValues) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.megaviews(smallPicture({"-o", "r.exr"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    for (const std::string file : {"d.png", "d.exr"}) {
        const ProcessResult m = sandbox.megaviews(smallPicture(
            {"--light-scale", "0.5", "--reference", "r.exr", "--metrics", "flip", "--diff", file}));
        ASSERT_EQ(m.code, 0) << m.err;
        OIIO::ImageBuf map(sandbox.file(file).string());
        ASSERT_TRUE(map.read(0, 0, true, OIIO::TypeDesc::FLOAT));
        EXPECT_EQ(map.spec().width, 96);
        EXPECT_EQ(map.spec().height, 54);
        if (file == "d.exr") {
            ASSERT_EQ(map.nchannels(), 1);
            const auto statistics = OIIO::ImageBufAlgo::computePixelStats(map);
            EXPECT_NEAR(statistics.avg[0], valuesOf(m.out).at("flip"), 1e-4);
            EXPECT_LE(statistics.max[0], 1);
        } else {
            EXPECT_EQ(map.nchannels(), 3);
        }
    }
}

TEST(Measure, RefusesWhatCannotBeMeasured) {
    const Sandbox sandbox;
    const ProcessResult r = sandbox.megaviews(smallPicture({"-o", "r.exr", "-o", "r.png"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    sandbox.write("text.exr", "no picture");
    std::string broken = sandbox.text("r.png");
    sandbox.write("early.png", broken.substr(0, broken.size() - 40));
    sandbox.write("header.png", broken.substr(0, 20));
    broken[broken.find("IDAT") + 20] ^= 1;
    sandbox.write("bit.png", broken);
    struct Case {
        std::vector<std::string> more;
        int code;
        std::string message;
    };
    const std::vector<Case> cases = {
        {{"--reference", "absent.exr"}, 3, "'absent.exr' cannot be read: there is no such file"},
        {{"--reference", "text.exr"}, 3, "'text.exr' is no picture"},
        {{"--reference", "early.png"}, 3, "'early.png' cannot be read: it ends early"},
        {{"--reference", "header.png"}, 3, "'header.png' cannot be read: it ends early"},
        {{"--reference", "bit.png"}, 3, "'bit.png' cannot be read: its chunk IDAT is damaged"},
        {{"--load-state", "early.png"}, 3, "'early.png' cannot be read: it ends early"},
        {{"--reference", "r.exr", "--resolution", "64x36"},
         2,
         "'r.exr' is 96x54, the picture 64x36; --resolution 96x54 would fit"},
        {{"--reference", "r.png", "--metrics", "psnr,relmse"},
         2,
         "relmse is measured on radiance; 'r.png' holds display values"},
        {{"--reference", "r.exr", "--view", "normals"}, 2, "--view normals shows data"},
        {{"--reference", "r.exr", "--diff", "absent/d.png"}, 5, "no folder 'absent'"},
        {{"--reference", "r.exr", "--diff", "d.png", "-o", "d.png"}, 2, "written twice"},
    };
    for (const Case& c : cases) {
        const ProcessResult refused = sandbox.megaviews(smallPicture(c.more));
        EXPECT_EQ(refused.code, c.code) << c.message;
        EXPECT_NE(refused.err.find(c.message), std::string::npos) << refused.err;
        EXPECT_EQ(refused.err.find("libpng"), std::string::npos) << refused.err;
        EXPECT_EQ(refused.out, "");
    }
}

TEST(Measure, UsageNamesTheFlag) {
    const Sandbox sandbox;
    struct Case {
        std::vector<std::string> arguments;
        std::string message;
    };
    const std::vector<Case> cases = {
        {{"--reference", "", "--metrics", "psnr"}, "--reference: its value is empty"},
        {{"--method", "none", "--map-references", "9"}, "method none has no maps"},
        {{"--metrics", "psnr"}, "--metrics requires --reference"},
        {{"--threshold", "psnr:3"}, "--threshold requires --reference"},
        {{"--diff", "d.png"}, "--diff requires --reference"},
        {{"--reference", "r.exr", "--metrics", "psnr,relms"}, "did you mean relmse?"},
        {{"--reference", "r.exr", "--metrics", ""}, "--metrics: its value is empty"},
        {{"--reference", "r.exr", "--threshold", "psnr"}, "'psnr' is not METRIC:VALUE"},
        {{"--reference", "r.exr", "--threshold", "psnr:high"}, "--threshold: 'high'"},
        {{"--reference", "r.exr", "--threshold", "psn:3"}, "did you mean psnr?"},
        {{"--reference", "r.exr", "--diff", "d.jpg"}, "must end in .png or .exr"},
    };
    for (const Case& c : cases) {
        const ProcessResult refused = sandbox.megaviews(c.arguments);
        EXPECT_EQ(refused.code, 2) << c.message;
        EXPECT_NE(refused.err.find(c.message), std::string::npos) << refused.err;
    }
    std::string names;
    for (const MetricInfo& info : metricsTable()) names.append(info.name).append("\n");
    EXPECT_EQ(sandbox.megaviews({"--list", "metrics"}).out, names);
}

void writeNpyImage(const Sandbox& sandbox, const std::string& name, int width, int height,
                   float scale) {
    std::vector<float> values;
    for (int i = 0; i < width * height * 3; ++i) {
        values.push_back(scale * (0.1f + static_cast<float>(i % 17) / 17));
    }
    writeNpy<float>(sandbox.file(name),
                    {static_cast<std::uint64_t>(height), static_cast<std::uint64_t>(width), 3},
                    values);
}

// The example of docs/command-line.md prints what stands there.
TEST(Measure, TheDocumentedExampleIsTrue) {
    std::ifstream page(MEGAVIEWS_SOURCE_DIR "/docs/command-line.md");
    std::vector<std::string> commands, expected;
    bool within = false;
    for (std::string line; std::getline(page, line);) {
        if (line.starts_with("$ megaviews ")) {
            commands.push_back(line.substr(2));
            within = true;
        } else if (within && commands.back().ends_with('\\')) {
            commands.back().pop_back();
            commands.back() += line;
        } else if (within && line == "```") {
            break;
        } else if (within) {
            expected.push_back(line);
        }
    }
    ASSERT_EQ(commands.size(), 2u);
    ASSERT_EQ(expected.size(), 3u);
    const Sandbox sandbox;
    const auto run = [&](const std::string& command) {
        return sandbox.run("/bin/sh", {"-c", MEGAVIEWS_BINARY_DIR "/" + command});
    };
    const ProcessResult exact = run(commands[0]);
    MV_SKIP_WITHOUT_GL(exact);
    ASSERT_EQ(exact.code, 0) << exact.err;
    const ProcessResult measured = run(commands[1]);
    EXPECT_EQ(measured.code, 1) << measured.err;
    const auto printed = valuesOf(measured.out);
    const auto documented = valuesOf(expected[0] + "\n" + expected[1] + "\n");
    EXPECT_NEAR(printed.at("psnr"), documented.at("psnr"), 0.2);  // another machine's last bits
    EXPECT_NEAR(printed.at("flip"), documented.at("flip"), 0.002);
    EXPECT_NE(measured.err.find(expected[2].substr(0, expected[2].find(' '))), std::string::npos);
}

TEST(BenchCompare, PrintsTheErrorsOfTwoArrays) {
    const Sandbox sandbox;
    const auto compare = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "compare");
        return sandbox.run("megaviews-bench", arguments);
    };
    writeNpyImage(sandbox, "a.npy", 20, 14, 1.1f);
    writeNpyImage(sandbox, "b.npy", 20, 14, 1);
    writeNpyImage(sandbox, "c.npy", 14, 20, 1);
    const ProcessResult r = compare({"a.npy", "b.npy", "--json", "e.json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const std::map<std::string, double> printed = valuesOf(r.out);
    EXPECT_EQ(printed.size(), metricsTable().size()) << r.out;
    EXPECT_NEAR(printed.at("leaked"), 10, 1e-4);
    EXPECT_EQ(printed.at("occluded"), 0);
    const Json json = Json::parse(sandbox.text("e.json"));
    EXPECT_NEAR(json.at("values").at("leaked"), 10, 1e-4);
    // Brighter as displayed, then beyond white in both.
    const double dark = valuesOf(compare({"a.npy", "b.npy", "--metrics", "psnr"}).out).at("psnr");
    EXPECT_TRUE(std::isfinite(dark));
    EXPECT_EQ(compare({"a.npy", "b.npy", "--metrics", "psnr", "--exposure", "12"}).out,
              "psnr inf dB\n");
    EXPECT_EQ(valuesOf(compare({"a.npy", "b.npy", "--display"}).out).size(), 3u);

    const ProcessResult missed = compare({"a.npy", "b.npy", "--threshold", "leaked:9"});
    EXPECT_EQ(missed.code, 1);
    EXPECT_NE(missed.err.find("leaked 10 % > 9 %"), std::string::npos) << missed.err;
    EXPECT_EQ(compare({"a.npy"}).code, 2);
    EXPECT_EQ(compare({"a.npy", "c.npy"}).code, 2);
    EXPECT_EQ(compare({"a.npy", "b.npy", "--display", "--metrics", "mse"}).code, 2);
    EXPECT_EQ(compare({"a.npy", "absent.npy"}).code, 3);
    EXPECT_EQ(compare({"a.npy", "b.npy", "--json", "absent/e.json"}).code, 5);
    EXPECT_EQ(compare({"--help"}).code, 0);
    writeNpy<float>(sandbox.file("flat.npy"), {20, 14}, std::vector<float>(280, 1.0f));
    const ProcessResult flat = compare({"a.npy", "flat.npy"});
    EXPECT_EQ(flat.code, 3);
    EXPECT_NE(flat.err.find("20x14, not HxWx3"), std::string::npos) << flat.err;
}

// The difference view and the metric are one FLIP.
TEST(Measure, ShowsFlipOfTwoSidesAsAPicture) {
    const Sandbox sandbox;
    const ProcessResult left = sandbox.megaviews(smallPicture({"-o", "left.exr"}));
    MV_SKIP_WITHOUT_GL(left);
    ASSERT_EQ(left.code, 0) << left.err;
    const ProcessResult right = sandbox.megaviews(
        smallPicture({"--method", "none", "--reference", "left.exr", "--diff", "flip.exr"}));
    ASSERT_EQ(right.code, 0) << right.err;
    const ProcessResult both = sandbox.megaviews(smallPicture(
        {"--compare", "none", "--difference", "flip", "-o", "both.exr", "-o", "both.png"}));
    ASSERT_EQ(both.code, 0) << both.err;
    const OIIO::ImageBuf one(sandbox.file("flip.exr").string()),
        two(sandbox.file("both.exr").string());
    ASSERT_EQ(one.spec().width, two.spec().width);
    double most = 0, worst = 0;
    for (int y = 0; y < one.spec().height; ++y) {
        for (int x = 0; x < one.spec().width; ++x) {
            const double a = one.getchannel(x, y, 0, 0), b = two.getchannel(x, y, 0, 0);
            most = std::max(most, a);
            worst = std::max(worst, std::abs(a - b));
        }
    }
    EXPECT_GT(most, 0.05);
    EXPECT_LT(worst, 1e-3);
}

TEST(Measure, ComparesMapsWithExactOnes) {
    const Sandbox sandbox;
    const std::vector<std::string> small = {"--view-res", "8",       "--references",
                                            "refs",       "--stats", "s.json"};
    const auto run = [&](std::vector<std::string> more) {
        more.insert(more.end(), small.begin(), small.end());
        return sandbox.megaviews(smallPicture(more));
    };
    const ProcessResult none = run({});
    MV_SKIP_WITHOUT_GL(none);
    ASSERT_EQ(none.code, 0) << none.err;
    EXPECT_FALSE(Json::parse(sandbox.text("s.json")).at("methods").at(0).contains("mapErrors"));
    const ProcessResult made =
        run({"--map-references", "9", "--compare", "manylods", "--compare-view-res", "16"});
    ASSERT_EQ(made.code, 0) << made.err;
    const Json both = Json::parse(sandbox.text("s.json")).at("methods");
    for (std::size_t i = 0; i < 2; ++i) {
        const Json errors = both.at(i).at("mapErrors");
        EXPECT_EQ(errors.at("views"), 9);
        EXPECT_GT(errors.at("texels"), 9 * 2 * (i ? 256 : 64) / 4);
        for (const MapMetricInfo& info : mapMetricsTable()) {
            EXPECT_TRUE(errors.at(std::string(info.name)).is_number()) << info.name;
        }
    }
    // Found again by a run that does not ask for it, whatever the picture.
    const ProcessResult found = run({"--resolution", "16x9"});
    ASSERT_EQ(found.code, 0) << found.err;
    EXPECT_EQ(Json::parse(sandbox.text("s.json")).at("methods").at(0).at("mapErrors"),
              both.at(0).at("mapErrors"));
    EXPECT_EQ(run({"--map-references", "-1"}).code, 2);
}

// The lines of a log that say how far maps are from exact ones.
std::vector<std::string> mapLines(const std::string& log) {
    std::vector<std::string> out;
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t at = line.find("maps of ");
        if (at != std::string::npos) out.push_back(line.substr(at));
    }
    return out;
}

TEST(Measure, ShowsTheSameMapErrorsInTheWindow) {
    const Sandbox sandbox;
    const std::vector<std::string> asked = {"--view-res",
                                            "8",
                                            "--gather-samples",
                                            "2",
                                            "--scene-depth",
                                            "5",
                                            "--compare",
                                            "manylods",
                                            "--compare-view-res",
                                            "16",
                                            "--accumulate",
                                            "1",
                                            "--headless",
                                            "--view-depth",
                                            "5",
                                            "-v",
                                            "--map-references",
                                            "9"};
    const auto run = [&](const char* size, std::vector<std::string> more) {
        more.insert(more.end(), asked.begin(), asked.end());
        more.insert(more.end(), {"--no-cache", "--resolution", size, "--vpls", "64", "--placement",
                                 "traced", "builtin:cornell"});
        return sandbox.megaviews(more);
    };
    const ProcessResult alone = run("32x24", {});
    MV_SKIP_WITHOUT_GL(alone);
    ASSERT_EQ(alone.code, 0) << alone.err;
    const ProcessResult window = run("1000x600", {"--ui", "-o", "w.png"});
    ASSERT_EQ(window.code, 0) << window.err;
    const auto lines = mapLines(alone.err);
    ASSERT_EQ(lines.size(), 2u) << alone.err;
    EXPECT_NE(lines[0].find("9 views, off2 "), std::string::npos) << lines[0];
    // The window says so whenever maps were made anew: the last count.
    const auto shown = mapLines(window.err);
    ASSERT_GE(shown.size(), lines.size());
    EXPECT_TRUE(std::equal(lines.rbegin(), lines.rend(), shown.rbegin())) << window.err;
    EXPECT_GT(sandbox.text("w.png").size(), 20000u);
}

// What shared maps are up against: the same views' maps by rays.
TEST(Measure, EmbreeMakesTheMapsOfSavedViews) {
    const Sandbox sandbox;
    const ProcessResult saved = sandbox.megaviews(
        smallPicture({"--placement", "traced", "--save-views", "v.ply", "-o", "x.png"}));
    MV_SKIP_WITHOUT_GL(saved);
    ASSERT_EQ(saved.code, 0) << saved.err;
    const ProcessResult r = sandbox.run("megaviews-embree-maps", {"builtin:cornell", "v.ply", "8"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Json measured = Json::parse(r.out);
    EXPECT_GT(measured["views"], 128);
    EXPECT_LE(measured["views"], 256);
    EXPECT_GT(measured["seconds"], 0);
    for (const std::vector<std::string>& wrong :
         {std::vector<std::string>{}, {"builtin:cornell", "v.ply", "9"}}) {
        EXPECT_EQ(sandbox.run("megaviews-embree-maps", wrong).code, 2);
    }
    EXPECT_EQ(sandbox.run("megaviews-embree-maps", {"builtin:cornell", "none.ply"}).code, 3);
}

}  // namespace
}  // namespace mv::test
