// app/bench/plot.py, run as a user would, on a sweep made up here.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "app/temp_folder.h"

namespace mv {
namespace {

using Json = nlohmann::ordered_json;

class Plot : public testing::Test {
  protected:
    test::TempFolder folder;

    void SetUp() override {
        if (python().empty()) GTEST_SKIP() << "no python3 with matplotlib";
    }
    // With the fonts that matplotlib lists at its first start, which may take long.
    static std::string withConfiguration() {
        static const test::TempFolder fonts;
        return "MPLCONFIGDIR='" + fonts.file("") + "' ";
    }
    // Debian's own python3 has Debian's matplotlib.
    static std::string python() {
        static const std::string found = [] {
            for (const char* name : {"/usr/bin/python3", "python3"}) {
                const std::string program = name;
                const std::string start =
                    withConfiguration() + program + " -c 'import matplotlib.pyplot' 2>/dev/null";
                if (std::system(start.c_str()) == 0) {
                    return program;
                }
            }
            return std::string();
        }();
        return found;
    }
    std::string text(const std::string& name) const {
        std::ifstream stream(folder.file(name));
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    int run(const std::string& arguments) const {
        const std::string command = "cd '" + folder.file("") + "' && " + withConfiguration() +
                                    python() + " " MEGAVIEWS_SOURCE_DIR "/app/bench/plot.py " +
                                    arguments + " >out.txt 2>err.txt";
        return WEXITSTATUS(std::system(command.c_str()));
    }
    void write(const Json& sweep, const std::string& name = "s.json") const {
        std::ofstream(folder.file(name)) << sweep.dump();
    }
};

Json summary(double ms) { return {{"median", ms}, {"min", ms}, {"max", ms}, {"sd", 0}}; }

Json pointOf(const std::string& method, double views, double exponent) {
    const double ms = std::pow(views, exponent);
    return {{"values", {{"vpls", views}, {"method", method}}},
            {"refusal", nullptr},
            {"views", {{"requested", views}}},
            {"ms", {{"maps", summary(ms)}, {"indirect", summary(2 * ms)}}},
            {"viewsPerRenderedNode", 2.0},
            {"memoryBytes", {{"queue", 1e6}, {"maps", 1e6}}},
            {"stages", {{"traverse", summary(ms)}, {"gather", summary(ms)}}},
            {"errors", {{"exact", {{"relmse", 1 / views}, {"psnr", 30}}}}},
            {"settings", {{"method", method}}}};
}

Json sweepOf(std::initializer_list<Json> points) {
    return {{"schema", 1},
            {"kind", "megaviews sweep"},
            {"command", "megaviews-bench sweep --made-up"},
            {"gl", {{"renderer", "nothing"}}},
            {"clock", "none"},
            {"scene", {{"name", "builtin:none"}}},
            {"search", nullptr},
            {"points", points}};
}

TEST_F(Plot, DrawsEveryPictureWithItsCommand) {
    write(sweepOf({pointOf("megaviews", 1024, 0.5), pointOf("megaviews", 4096, 0.5),
                   pointOf("megaviews", 16384, 0.5), pointOf("raster", 256, 1),
                   pointOf("raster", 1024, 1)}));
    ASSERT_EQ(run("s.json --out pictures --format svg"), 0) << text("err.txt");
    for (const char* name : {"time", "sharing", "memory", "error", "stages"}) {
        EXPECT_TRUE(std::filesystem::exists(folder.file("pictures/" + std::string(name) + ".svg")))
            << name;
    }
    EXPECT_EQ(text("err.txt"), "");
    // As text, the labels can be read again.
    ASSERT_EQ(run("s.json --pictures time --format svg --text"), 0) << text("err.txt");
    const std::string svg = text("time.svg");
    EXPECT_NE(svg.find("megaviews-bench sweep --made-up"), std::string::npos);
    EXPECT_NE(svg.find("0.50"), std::string::npos);
    EXPECT_NE(svg.find("1.00"), std::string::npos);
    EXPECT_NE(svg.find("extrapolated"), std::string::npos);  // raster beyond 1K
    ASSERT_EQ(run("s.json --pictures time --where method=megaviews --format svg --text"), 0);
    EXPECT_EQ(text("time.svg").find("raster"), std::string::npos);
    ASSERT_EQ(run("s.json --pictures error --format svg --text --metric psnr"), 0);
    EXPECT_NE(text("error.svg").find("Pareto front"), std::string::npos);
    EXPECT_NE(text("error.svg").find("higher is better"), std::string::npos);
}

TEST_F(Plot, DrawsAgainstAnotherSettingThanViews) {
    Json points[4];
    for (int i = 0; i < 4; ++i) {  // time as R^1.25 at 1K views, ten times that at 4K
        const double res = i % 2 == 0 ? 16 : 64;
        points[i] = pointOf("megaviews", i < 2 ? 1024 : 4096, 0);
        points[i]["values"]["view-res"] = res;
        points[i]["ms"]["maps"] = summary((i < 2 ? 1 : 10) * std::pow(res, 1.25 + i / 2));
    }
    write(sweepOf({points[0], points[1], points[2], points[3]}));
    ASSERT_EQ(run("s.json --x view-res --pictures time,stages --format svg --text"), 0)
        << text("err.txt");
    EXPECT_EQ(text("err.txt"), "");
    EXPECT_NE(text("time.svg").find("vpls 1K"), std::string::npos);  // the first, and said
    EXPECT_NE(text("time.svg").find("1.25"), std::string::npos);
    EXPECT_NE(text("stages.svg").find(">64<"), std::string::npos);
    ASSERT_EQ(run("s.json --x view-res --where vpls=4K --pictures time --format svg --text"), 0);
    EXPECT_NE(text("time.svg").find("2.25"), std::string::npos);
    EXPECT_EQ(run("s.json --x pair-size"), 2);
    EXPECT_NE(text("err.txt").find("'pair-size' was not swept; vpls, method, view-res were"),
              std::string::npos)
        << text("err.txt");
    write(sweepOf({points[0], points[2]}));
    ASSERT_EQ(run("s.json --x view-res --pictures time"), 3);
    EXPECT_NE(text("err.txt").find("needs two values of view-res"), std::string::npos);
}

TEST_F(Plot, DrawsTheNumbersThatAreThere) {
    const std::string command = "cd '" + folder.file("") + "' && MPLCONFIGDIR=. " + python() +
                                " " MEGAVIEWS_SOURCE_DIR "/tests/bench/plot_check.py " +
                                MEGAVIEWS_SOURCE_DIR "/app/bench/plot.py >out.txt 2>err.txt";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 0) << text("err.txt");
    EXPECT_EQ(text("out.txt"), "as it should be\n") << text("err.txt");
}

TEST_F(Plot, SaysWhatItCannotDraw) {
    Json refused = pointOf("megaviews", 4096, 1);
    refused["refusal"] = "too large";
    Json bare = pointOf("none", 1024, 1);
    bare["errors"]["exact"] = nullptr;
    write(sweepOf({bare, refused}));
    ASSERT_EQ(run("s.json"), 0) << text("err.txt");
    EXPECT_NE(text("err.txt").find("time: needs two counts of views"), std::string::npos);
    EXPECT_NE(text("err.txt").find("no point has errors.exact.relmse"), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(folder.file("stages.png")));
    EXPECT_FALSE(std::filesystem::exists(folder.file("error.png")));
    EXPECT_EQ(run("s.json --pictures error"), 3);  // which was asked for
}

TEST_F(Plot, ExitCodes) {
    EXPECT_EQ(run("absent.json"), 3);
    EXPECT_NE(text("err.txt").find("'absent.json' cannot be read"), std::string::npos);
    std::ofstream(folder.file("bad.json")) << "{";
    EXPECT_EQ(run("bad.json"), 3);
    write({{"kind", "something else"}}, "other.json");
    EXPECT_EQ(run("other.json"), 3);
    Json newer = sweepOf({pointOf("none", 64, 1)});
    newer["schema"] = 2;
    write(newer);
    EXPECT_EQ(run("s.json"), 3);
    EXPECT_NE(text("err.txt").find("schema 2"), std::string::npos);
    write(sweepOf({}));
    EXPECT_EQ(run("s.json"), 3);
    write(sweepOf({pointOf("none", 64, 1)}));
    EXPECT_EQ(run("s.json --pictures none"), 2);
    EXPECT_EQ(run("s.json --metric beauty"), 2);
    EXPECT_NE(text("err.txt").find("'beauty' was not measured; psnr, relmse were"),
              std::string::npos)
        << text("err.txt");
    EXPECT_EQ(run("s.json --where bounces=2"), 2);
    EXPECT_NE(text("err.txt").find("'bounces' was not swept"), std::string::npos);
    // Whatever the pictures do with the key.
    for (const char* pictures : {"time", "error", "stages"}) {
        for (const char* absent : {"method=raster", "vpls=65"}) {
            EXPECT_EQ(run("s.json --pictures " + std::string(pictures) + " --where " + absent), 2);
            EXPECT_NE(text("err.txt").find("was not measured"), std::string::npos);
        }
    }
    for (const Json& broken : {Json(7), Json{{"refusal", nullptr}}, Json::object(),
                               Json{{"refusal", nullptr}, {"values", 3}, {"settings", 4}}}) {
        Json sweep = sweepOf({pointOf("none", 64, 1)});
        sweep["points"].push_back(broken);
        write(sweep);
        EXPECT_EQ(run("s.json"), 3) << broken;
        EXPECT_EQ(text("err.txt").find("Traceback"), std::string::npos) << text("err.txt");
    }
    write(sweepOf({pointOf("none", 64, 1)}));
    EXPECT_EQ(run("s.json --where method"), 2);
    EXPECT_EQ(run("s.json --out /proc/nowhere"), 5);
}

}  // namespace
}  // namespace mv
