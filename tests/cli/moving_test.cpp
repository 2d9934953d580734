// A scene that moves, without a window: a frame is the picture of its time.

#include <gtest/gtest.h>

#include <algorithm>

#include "cli/process.h"

namespace mv::test {
namespace {

std::vector<std::string> door(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = smallPicture(more);
    std::ranges::replace(arguments, std::string("builtin:cornell"), std::string("builtin:door"));
    return arguments;
}

TEST(MovingScene, AFrameHasTheBytesOfItsTime) {
    const Sandbox sandbox;
    const ProcessResult frames = sandbox.megaviews(
        door({"--time", "3", "--frames", "4", "--frame-rate", "0.5", "-o", "f{frame}.exr"}));
    MV_SKIP_WITHOUT_GL(frames);
    ASSERT_EQ(frames.code, 0) << frames.err;
    for (int i = 0; i < 4; ++i) {
        const std::string time = std::to_string(3 + 2 * i);  // shut at 9
        const std::string name = "t" + time + ".exr";
        ASSERT_EQ(sandbox.megaviews(door({"--time", time, "-o", name})).code, 0);
        EXPECT_EQ(pixelsOf(sandbox.file(name)),
                  pixelsOf(sandbox.file("f" + std::to_string(i) + ".exr")))
            << time;
    }
    EXPECT_NE(pixelsOf(sandbox.file("t3.exr")), pixelsOf(sandbox.file("t9.exr")));
    // No animation: nothing moves.
    for (const char* time : {"0", "9"}) {
        ASSERT_EQ(sandbox
                      .megaviews(door({"--time", time, "--animation", "none", "-o",
                                       std::string("n") + time + ".exr"}))
                      .code,
                  0);
    }
    EXPECT_EQ(pixelsOf(sandbox.file("n0.exr")), pixelsOf(sandbox.file("n9.exr")));
}

TEST(MovingScene, ItsLastFrameIsLitAsRaysLightThatPose) {
    const Sandbox sandbox;
    // Without near light, whose few rays are noise.
    const ProcessResult exact =
        sandbox.megaviews(door({"--time", "9", "--method", "exact", "--view", "indirect",
                                "--near-field", "off", "-o", "exact.exr"}));
    MV_SKIP_WITHOUT_GL(exact);
    ASSERT_EQ(exact.code, 0) << exact.err;
    const auto render = [&](const std::string& frames) {
        return sandbox.megaviews(
            door({"--time", "3", "--frames", frames, "--frame-rate", "0.5", "--view", "indirect",
                  "--gather-samples", "0", "--near-field", "off", "--reference", "exact.exr",
                  "--metrics", "relmse", "--threshold", "relmse:0.05"}));
    };
    const ProcessResult shut = render("4"), open = render("1");
    EXPECT_EQ(shut.code, 0) << shut.out << shut.err;
    EXPECT_NE(open.code, 0) << open.out << "the door stands open: another light";
}

TEST(MovingScene, APictureIsItsOwnState) {
    const Sandbox sandbox;
    const ProcessResult made = sandbox.megaviews(door({"--time", "7.5", "-o", "a.exr"}));
    MV_SKIP_WITHOUT_GL(made);
    ASSERT_EQ(made.code, 0) << made.err;
    const ProcessResult again =
        sandbox.megaviews({"--headless", "--no-cache", "--load-state", "a.exr", "-o", "b.exr"});
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(pixelsOf(sandbox.file("a.exr")), pixelsOf(sandbox.file("b.exr")));
}

}  // namespace
}  // namespace mv::test
