// The real window, opened once on a display that only exists in memory.

#include <gtest/gtest.h>

#include <filesystem>

#include "cli/process.h"

namespace mv::test {
namespace {

TEST(Window, OpensRespondsAndCloses) {
    const std::string display = "/usr/bin/xvfb-run";
    if (!std::filesystem::exists(display)) GTEST_SKIP() << "there is no " << display;
    const Sandbox sandbox;
    const std::string program = std::string(MEGAVIEWS_BINARY_DIR) + "/megaviews";
    const ProcessResult r = sandbox.run(
        display,
        {"-a",
         "-s",
         "-screen 0 1280x720x24",
         program,
         "--gl",
         "window",
         "--no-cache",
         "--vpls",
         "64",
         "--scene-depth",
         "5",
         "--view-depth",
         "5",
         "--accumulate",
         "2",
         "--gather-samples",
         "2",
         "--resolution",
         "800x480",
         "--save-state",
         "end.json",
         "--actions",
         "wait 5; profiler; side-by-side; drag 40%,60% 45%,55%; scroll 2; resize 700x420; wait 3; "
         "move 40%,50%; play-or-pause; wait-still; save picture.png; save-window window.png; wait "
         "2; "
         "expect compare=manylods; quit",
         "builtin:cornell"});
    if (r.code == 4) GTEST_SKIP() << r.err;
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_GT(sandbox.text("picture.png").size(), 5000u);
    EXPECT_GT(sandbox.text("window.png").size(), 20000u);
    EXPECT_NE(sandbox.text("end.json").find("\"manylods\""), std::string::npos);
    // What the window remembers lies in the user's state folder, nothing in the working one.
    EXPECT_NE(sandbox.text("state/megaviews/viewer.json").find("builtin:cornell"),
              std::string::npos);
    EXPECT_NE(sandbox.text("state/megaviews/viewer.json").find("profiler"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(sandbox.file("imgui.ini")));
}

TEST(Window, ASignalLeavesItsState) {
    const std::string display = "/usr/bin/xvfb-run";
    if (!std::filesystem::exists(display)) GTEST_SKIP() << "there is no " << display;
    const Sandbox sandbox;
    const std::string program = std::string(MEGAVIEWS_BINARY_DIR) + "/megaviews";
    const ProcessResult r = sandbox.run(
        display, {"-a", "-s", "-screen 0 640x480x24", "/bin/sh", "-c",
                  program + " --gl window --no-cache --no-config --vpls 64 --scene-depth 5 "
                            "--view-depth 5 --accumulate 1 --gather-samples 1 --resolution 320x240 "
                            "--save-state end.json --actions 'wait 5; save first.png' "
                            "builtin:cornell & p=$!; "
                            "while ! test -e first.png && kill -0 $p; do sleep .1; done; "
                            "kill -TERM $p; wait $p; echo $? > code"});
    const std::string code = sandbox.text("code");  // xvfb-run has one of its own
    if (code == "4\n") GTEST_SKIP() << r.err;
    EXPECT_EQ(code, "130\n") << r.err;
    EXPECT_NE(sandbox.text("end.json").find("builtin:cornell"), std::string::npos) << r.err;
}

}  // namespace
}  // namespace mv::test
