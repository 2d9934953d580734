// --environment: images that light the scene, and those that cannot.

#include <gtest/gtest.h>

#include "cli/process.h"

namespace mv::test {
namespace {

// A Radiance file of 8 x 4 pixels of radiance 1.
std::string whiteHdr() {
    std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n";
    for (int i = 0; i < 32; ++i) file += "\x80\x80\x80\x81";
    return file;
}

std::vector<std::string> picture(std::vector<std::string> more) {
    std::vector<std::string> line = {"--headless",
                                     "--no-cache",
                                     "--no-config",
                                     "--vpls",
                                     "128",
                                     "--view-depth",
                                     "6",
                                     "--scene-depth",
                                     "6",
                                     "--resolution",
                                     "64x36",
                                     "--exposure",
                                     "0",
                                     "--quiet",
                                     "builtin:cornell"};
    line.insert(line.end(), more.begin(), more.end());
    return line;
}

TEST(EnvironmentFlag, AnImageOfOneIsTheWhiteSky) {
    const Sandbox sandbox;
    sandbox.write("white.hdr", whiteHdr());
    const ProcessResult white =
        sandbox.megaviews(picture({"--environment", "white", "-o", "white.exr"}));
    MV_SKIP_WITHOUT_GL(white);
    ASSERT_EQ(white.code, 0) << white.err;
    const ProcessResult none =
        sandbox.megaviews(picture({"--environment", "none", "-o", "none.exr"}));
    ASSERT_EQ(none.code, 0) << none.err;
    EXPECT_NE(sandbox.text("none.exr"), sandbox.text("white.exr"));
    const ProcessResult image = sandbox.megaviews(
        picture({"--environment", "white.hdr", "-o", "image.exr", "-o", "image.png"}));
    ASSERT_EQ(image.code, 0) << image.err;
    EXPECT_EQ(image.err, "");
    // Cells differ in number, so the light differs by noise alone.
    const ProcessResult error =
        sandbox.megaviews(picture({"--environment", "white", "--reference", "image.exr",
                                   "--metrics", "psnr", "--threshold", "psnr:28"}));
    EXPECT_EQ(error.code, 0) << error.out << error.err;

    // A picture carries where its image lies, from whatever folder it is loaded.
    const ProcessResult same =
        sandbox.megaviews({"--headless", "--no-cache", "--no-config", "--quiet", "--load-state",
                           "image.png", "--reference", "image.exr", "--metrics", "mse"});
    ASSERT_EQ(same.code, 0) << same.err;
    EXPECT_EQ(same.out.substr(0, 6), "mse 0\n") << same.out;
}

TEST(EnvironmentFlag, WhatCannotBeReadIsSaidInASentence) {
    const Sandbox sandbox;
    sandbox.write("text.hdr", "no picture");
    const auto refused = [&](const std::vector<std::string>& flags, int code,
                             const std::string& part) {
        const ProcessResult r = sandbox.megaviews(picture(flags));
        MV_SKIP_WITHOUT_GL(r);
        EXPECT_EQ(r.code, code) << r.err;
        EXPECT_NE(r.err.find(part), std::string::npos) << r.err;
    };
    refused({"--environment", "no.exr", "-o", "a.png"}, 3, "'no.exr' cannot be read");
    refused({"--environment", "no.exr", "--info"}, 3, "'no.exr' cannot be read");
    refused({"--environment", "text.hdr", "-o", "a.png"}, 3, "'text.hdr' is no picture");
    refused({"--environment", "", "-o", "a.png"}, 2, "--environment");
    refused({"--sky-scale", "-1", "-o", "a.png"}, 2, "--sky-scale: '-1' is outside");
    refused({"--environment", "sky.exr", "-o", "sky.exr"}, 2, "sky.exr");
}

TEST(EnvironmentFlag, TheBenchmarkReadsNoImages) {
    const Sandbox sandbox;
    sandbox.write("white.hdr", whiteHdr());
    const ProcessResult r = sandbox.run("megaviews-bench", {"sweep",         "builtin:cornell",
                                                            "--no-cache",    "--no-config",
                                                            "--scene-depth", "5",
                                                            "--view-depth",  "5",
                                                            "--vpls",        "32",
                                                            "--resolution",  "32x18",
                                                            "--environment", "white.hdr",
                                                            "--sweep",       "seed=1",
                                                            "--frames",      "1",
                                                            "--out",         "out"});
    MV_SKIP_WITHOUT_GL(r);
    EXPECT_EQ(r.code, 2) << r.err;
    EXPECT_NE(r.err.find("white.hdr"), std::string::npos) << r.err;
}

}  // namespace
}  // namespace mv::test
