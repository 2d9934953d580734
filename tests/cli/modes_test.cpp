// Every flag that asks for a result, with every way to run without a window.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/process.h"

namespace mv::test {
namespace {

using Json = nlohmann::json;
using Arguments = std::vector<std::string>;

Arguments joined(Arguments a, const Arguments& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

struct Mode {
    const char* name;
    Arguments flags;
};
const Mode kModes[] = {
    {"plain", {}},
    {"script", {"--actions", "seed=3; drag 40%,50% 45%,55%; wait 2"}},
    {"window", {"--ui", "--resolution", "640x400", "--accumulate", "2"}},
    {"window and script",
     {"--ui", "--resolution", "640x400", "--accumulate", "2", "--actions",
      "errors; wait-still; next-difference"}},
};

class Modes : public testing::TestWithParam<Mode> {
  protected:
    // Small, in the mode, and whatever else.
    ProcessResult run(const Arguments& more) const {
        return sandbox.megaviews(joined(smallPicture(GetParam().flags), more));
    }
    // A reference of the size that the mode's picture has.
    void makeReference() const {
        const Json stats = Json::parse(sandbox.text("first.json"));
        const Json size = stats.at("settings").at("resolution");
        const std::string text =
            std::to_string(size.at(0).get<int>()) + "x" + std::to_string(size.at(1).get<int>());
        ASSERT_EQ(sandbox.megaviews(smallPicture({"--resolution", text, "-o", "ref.exr"})).code, 0);
    }
    const Sandbox sandbox;
};

TEST_P(Modes, EveryResultIsWritten) {
    const ProcessResult first = run({"--stats", "first.json"});
    MV_SKIP_WITHOUT_GL(first);
    ASSERT_EQ(first.code, 0) << first.err;
    EXPECT_EQ(first.out, "first.json\n");
    if (std::string(GetParam().name) == "window and script") return;  // shows a difference
    makeReference();

    const ProcessResult r =
        run({"--stats",      "s.json",  "--frames",     "2",     "--warmup",    "1",
             "--reference",  "ref.exr", "--metrics",    "psnr",  "--threshold", "psnr:1",
             "--diff",       "d.png",   "--save-views", "v.ply", "--save-maps", "m.npy",
             "--save-state", "t.json",  "--save-scene", "g.glb", "-o",          "o.png"});
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_TRUE(r.out.starts_with("o.0000.png\npsnr ")) << r.out;
    EXPECT_TRUE(
        r.out.ends_with("\nd.png\no.0001.png\nt.json\nv.ply\nm.npy\nm.centres.npy\nm.views.npy\n"
                        "g.glb\ns.json\n"))
        << r.out;
    for (const char* file :
         {"o.0000.png", "o.0001.png", "d.png", "v.ply", "m.npy", "g.glb", "t.json"}) {
        EXPECT_FALSE(sandbox.text(file).empty()) << file;
    }
    const Json stats = Json::parse(sandbox.text("s.json"));
    EXPECT_EQ(stats.at("frames"), Json({{"warmup", 1}, {"measured", 2}, {"partial", false}}));
    EXPECT_TRUE(stats.at("metrics").at("values").contains("psnr"));
    EXPECT_FALSE(stats.at("methods")[0].at("pairsPerLevel").empty());

    // A threshold that is missed is code 1, and what was asked for is written all the same.
    const ProcessResult missed = run({"--reference", "ref.exr", "--threshold", "psnr:1000", "-o",
                                      "late.png", "--metrics", "psnr"});
    EXPECT_EQ(missed.code, std::string(GetParam().name) == "plain" ? 0 : 1) << missed.err;
    EXPECT_FALSE(sandbox.text("late.png").empty());
}

INSTANTIATE_TEST_SUITE_P(Headless, Modes, testing::ValuesIn(kModes));

TEST(Script, GivesThePictureThatItsSettingsGive) {
    const Sandbox sandbox;
    const ProcessResult flags =
        sandbox.megaviews(smallPicture({"--exposure", "1", "--seed", "3", "-o", "a.exr"}));
    MV_SKIP_WITHOUT_GL(flags);
    ASSERT_EQ(flags.code, 0) << flags.err;
    // Whatever was drawn before: the file says nothing of larger buffers and other predictions.
    const ProcessResult script = sandbox.megaviews(smallPicture(
        {"--actions", "vpls=4K; wait-still; vpls=256; exposure=1; seed=3", "-o", "b.exr"}));
    EXPECT_EQ(script.code, 0) << script.err;
    EXPECT_TRUE(sandbox.text("a.exr") == sandbox.text("b.exr"));
}

TEST(Script, FailsWithTheDocumentedCodes) {
    const Sandbox sandbox;
    const struct {
        Arguments arguments;
        int code;
        const char* message;
    } cases[] = {
        {{"--actions", "expect vpls=1", "--stats", "s.json"}, 1, "vpls is"},
        {{"--actions", "vpls=8; compare=megaviews", "-o", "a.png"},
         2,
         "--actions: command 2: compare: both sides would be the same 'megaviews'"},
        {{"--ui", "-o", "a.exr"}, 2, "the window is written as .png"},
        {{"--actions", "click @nothing", "-o", "a.png"}, 2, "there is no 'nothing' in sight"},
        {{"--actions", "method=none", "--save-maps", "m.npy"}, 2, "method none has no maps"},
        {{"--actions", "camera=nobody; wait 2", "-o", "a.png"}, 2, "nobody"},
        {{"--actions", "open absent.glb; wait-loading", "-o", "a.png"}, 3, "absent.glb"},
        {{"--actions", "wait", "--reference", "absent.exr"}, 3, "absent.exr"},
        {{"--actions", "wait", "--camera", "nobody"}, 2, "nobody"},
        {{"--actions", "wait", "--stats", "no/such.json"}, 5, "no/such.json"},
        {{"--actions", "save-window no/such.png"}, 5, "no/such.png"},
    };
    for (const auto& c : cases) {
        const ProcessResult r = sandbox.megaviews(smallPicture(c.arguments));
        MV_SKIP_WITHOUT_GL(r);
        EXPECT_EQ(r.code, c.code) << c.message << "\n" << r.err;
        EXPECT_NE(r.err.find(c.message), std::string::npos) << r.err;
        EXPECT_FALSE(std::filesystem::exists(sandbox.file("a.png"))) << c.message;
    }
}

TEST(Script, AMeasuredSizeIsThatOfThePictureInTheEnd) {
    const Sandbox sandbox;
    const ProcessResult r =
        sandbox.megaviews(smallPicture({"--resolution", "64x36", "-o", "small.exr"}));
    MV_SKIP_WITHOUT_GL(r);
    const auto measure = [&](const char* script) {
        return sandbox.megaviews(
            smallPicture({"--actions", script, "--reference", "small.exr", "--metrics", "psnr"}));
    };
    EXPECT_EQ(measure("wait").code, 2);
    const ProcessResult fits = measure("resize 64x36; wait 2");
    EXPECT_EQ(fits.code, 0) << fits.err;
    EXPECT_TRUE(fits.out.starts_with("psnr ")) << fits.out;
}

}  // namespace
}  // namespace mv::test
