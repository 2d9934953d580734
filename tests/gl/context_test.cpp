// The context, buffers, textures and framebuffers, each read back.

#include "renderer/gl/context.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numeric>
#include <set>
#include <string>

#include "gl_fixture.h"
#include "megaviews/core/error.h"
#include "renderer/gl/buffer.h"
#include "renderer/gl/texture.h"
#include "renderer/gl/workarounds.h"
#include "support/large_pages.h"

namespace mv::gl {
namespace {

TEST(HeadlessContext, ComesUpWithoutADisplay) {
    const char* display = std::getenv("DISPLAY");
    const std::string saved = display ? display : "";
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    try {
        HeadlessContext context;
        EXPECT_FALSE(limits().renderer.empty());
        EXPECT_EQ(limits().platform.substr(0, 3), "EGL");
        EXPECT_GE(limits().maxStorageBlockBytes, 128 << 20);
        EXPECT_GE(limits().maxWorkGroupsX, 65535);
        EXPECT_TRUE(limits().workGroupSize == 8 || limits().workGroupSize == 64);
    } catch (const Error& e) {
        EXPECT_EQ(e.code, ExitCode::graphics);
        // Whatever fails is named, platform by platform.
        for (const char* platform : {"EGL device", "EGL surfaceless", "EGL default display"}) {
            EXPECT_NE(std::string(e.what()).find(platform), std::string::npos) << e.what();
        }
        if (display) setenv("DISPLAY", saved.c_str(), 1);
        GTEST_SKIP() << e.what();
    }
    if (display) setenv("DISPLAY", saved.c_str(), 1);
}

TEST(HeadlessContext, IsWhatIsWishedForOrNothing) {
    std::string renderer;
    bool software = false;
    try {
        const HeadlessContext any;
        renderer = limits().renderer;
        software = limits().software;
        EXPECT_THROW(initialise("here", {.device = "nobody's"}), Error);
    } catch (const Error& e) {
        GTEST_SKIP() << e.what();
    }
    {
        const HeadlessContext same({.device = renderer.substr(0, 6)});
        EXPECT_EQ(limits().renderer, renderer);
    }
    try {
        const HeadlessContext none({.device = "nobody's"});
        FAIL() << "found " << limits().renderer;
    } catch (const Error& e) {
        EXPECT_EQ(e.code, ExitCode::graphics);
        EXPECT_NE(std::string(e.what()).find(renderer), std::string::npos) << e.what();
    }
    const ContextWish hardware{"", true};
    if (software) {
        EXPECT_THROW(HeadlessContext{hardware}, Error);
    }
}

TEST(Workarounds, AreOnInSoftwareUnlessSwitched) {
    try {
        const HeadlessContext context;
        EXPECT_EQ(workaroundsOn().size(), limits().software ? workarounds().size() : 0);
    } catch (const Error& e) {
        GTEST_SKIP() << e.what();
    }
    setenv("MEGAVIEWS_GL_WORKAROUNDS", "small-groups=off,wall-clock=on", 1);
    {
        const HeadlessContext context;
        EXPECT_FALSE(isOn(Workaround::smallGroups));
        EXPECT_EQ(limits().workGroupSize, 64);
        EXPECT_TRUE(isOn(Workaround::wallClock));
    }
    for (const char* wrong : {"small-groups", "small-groups=maybe", "no-such=on", "=on"}) {
        setenv("MEGAVIEWS_GL_WORKAROUNDS", wrong, 1);
        try {
            const HeadlessContext context;
            ADD_FAILURE() << wrong;
        } catch (const Error& e) {
            EXPECT_EQ(e.code, ExitCode::usage) << e.what();
        }
    }
    unsetenv("MEGAVIEWS_GL_WORKAROUNDS");
    std::set<std::string_view> names;
    for (const WorkaroundInfo& info : workarounds()) {
        EXPECT_TRUE(names.insert(info.name).second) << info.name;
        EXPECT_TRUE(info.what.ends_with(".") && info.why.ends_with(".")) << info.name;
    }
}

#ifndef MEGAVIEWS_SANITIZED
// What the driver would take so, the program's own function gives it.
TEST(Workarounds, LargeBlocksForTheDriverLieInLargePages) {
    if (!std::filesystem::exists("/sys/kernel/mm/transparent_hugepage")) GTEST_SKIP();
    for (const bool on : {false, true}) {
        setenv("MEGAVIEWS_GL_WORKAROUNDS", on ? "large-pages=on" : "large-pages=off", 1);
        const HeadlessContext context;
        void* block = nullptr;
        ASSERT_EQ(posix_memalign(&block, 64, 32u << 20), 0);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % 64, 0u);
        EXPECT_EQ(mv::testing::largePagesAskedFor(static_cast<char*>(block) + (16u << 20)), on);
        std::free(block);
    }
    unsetenv("MEGAVIEWS_GL_WORKAROUNDS");
}
#endif

// In a process of its own, whose EGL finds no driver.
TEST(HeadlessContextDeathTest, WithoutADriverEveryPlatformTriedIsNamed) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto tryWithoutDriver = [] {
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json", 1);
        try {
            const HeadlessContext context;
        } catch (const Error& e) {
            std::fputs(e.what(), stderr);
            _exit(static_cast<int>(e.code));
        }
        _exit(0);
    };
    EXPECT_EXIT(tryWithoutDriver(), ::testing::ExitedWithCode(4),
                "EGL device.*EGL surfaceless.*EGL default display");
}

TEST(HeadlessContext, CanBeMadeAgainAfterTheFirstIsGone) {
    for (int i = 0; i < 3; ++i) {
        std::unique_ptr<HeadlessContext> context;
        try {
            context = std::make_unique<HeadlessContext>();
        } catch (const Error& e) {
            GTEST_SKIP() << e.what();
        }
        const Buffer b = Buffer::of("again", std::vector<int>{i, i + 1});
        EXPECT_EQ(b.read<int>(0, 2), (std::vector<int>{i, i + 1}));
    }
}

using BufferTest = GlTest;

TEST_F(BufferTest, RoundTripAtAwkwardSizes) {
    for (std::uint32_t n : {0u, 1u, 3u, 63u, 64u, 65u, 100003u}) {
        std::vector<std::uint32_t> values(n);
        std::iota(values.begin(), values.end(), n * 7u);
        const Buffer b = Buffer::of("round trip", values);
        EXPECT_EQ(b.bytes(), n * 4u);
        EXPECT_EQ(b.read<std::uint32_t>(0, n), values) << n;
        if (n > 2) {
            EXPECT_EQ(b.read<std::uint32_t>(2, 1)[0], n * 7u + 2u);
        }
        b.bindStorage(0);  // an empty buffer can be bound as well
    }
    expectNoGlErrors();
}

TEST_F(BufferTest, WriteAndFillTouchOnlyTheirRange) {
    Buffer b("fill", 16 * 4);
    b.fill(7u);
    b.fill(3, 5, 0xFFFFFFFFu);
    const std::vector<std::uint32_t> two = {1, 2};
    b.write<std::uint32_t>(14, two);
    std::vector<std::uint32_t> expected(16, 7u);
    for (std::size_t i = 3; i < 8; ++i) expected[i] = 0xFFFFFFFFu;
    expected[14] = 1;
    expected[15] = 2;
    EXPECT_EQ(b.read<std::uint32_t>(0, 16), expected);
    b.fill(0, 0, 9u);  // nothing
    EXPECT_EQ(b.read<std::uint32_t>(0, 16), expected);
    expectNoGlErrors();
}

TEST_F(BufferTest, EnsureKeepsWhatIsLargeEnoughAndGrowsWhatIsNot) {
    Buffer b;
    b.ensure("grow", 64);
    const GLuint first = b.id();
    b.ensure("grow", 32);
    EXPECT_EQ(b.id(), first);
    EXPECT_EQ(b.bytes(), 64u);
    b.ensure("grow", 65);
    EXPECT_GE(b.bytes(), 65u);
    Buffer moved = std::move(b);
    EXPECT_FALSE(b);
    EXPECT_TRUE(moved);
    b = std::move(moved);
    EXPECT_TRUE(b);
}

TEST_F(BufferTest, ABlockAboveTheLimitIsRefused) {
    const auto limit = static_cast<std::uint64_t>(limits().maxStorageBlockBytes);
    if (limit > (256u << 20)) GTEST_SKIP() << "the limit is " << limit << " bytes, too many to try";
    const Buffer b("large", limit + 16);
    b.bindStorage(0, 16, limit);
    try {
        b.bindStorage(0);
        FAIL() << "bound a block of " << b.bytes() << " bytes";
    } catch (const Error& e) {
        EXPECT_EQ(e.code, ExitCode::impossible);
    }
}

TEST_F(BufferTest, MoreThanThereIsIsAnErrorThatNamesTheBuffer) {
    try {
        const Buffer b("nobody has this", std::uint64_t(1) << 50);
        FAIL() << "allocated a pebibyte";
    } catch (const Error& e) {
        EXPECT_EQ(e.code, ExitCode::impossible);
        EXPECT_NE(std::string(e.what()).find("nobody has this"), std::string::npos) << e.what();
    }
    expectNoGlErrors();
}

TEST_F(BufferTest, AMistakeInACallIsReported) {
    glNamedBufferSubData(0xFFFFFFu, 0, 4, nullptr);
    glFinish();
    EXPECT_EQ(reportedErrors(), 1u);
    EXPECT_THROW(throwReportedError(), Error);
    EXPECT_NO_THROW(throwReportedError());
    // The message names the pass.
    const std::string outer = namePass("gather");
    glNamedBufferSubData(0xFFFFFFu, 0, 4, nullptr);
    glFinish();
    EXPECT_EQ(namePass(outer), "gather");
    try {
        throwReportedError();
        ADD_FAILURE();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("\"gather\""), std::string::npos) << e.what();
    }
}

using TextureTest = GlTest;

TEST_F(TextureTest, FloatsAndBytesRoundTrip) {
    Texture floats("floats", GL_TEXTURE_2D, GL_RGBA32F, 3, 5);
    std::vector<float> values(3 * 5 * 4);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i) - 7.25f;
    floats.writeFloats(4, values);
    EXPECT_EQ(floats.readFloats(4), values);
    EXPECT_EQ(floats.bytes(), 3u * 5u * 16u);

    Texture bytes("bytes", GL_TEXTURE_2D_ARRAY, GL_RGBA8, 3, 1, 2);
    const std::vector<std::uint8_t> first = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 255};
    const std::vector<std::uint8_t> second(12, 9);
    bytes.writeBytes(4, first, 0, 0);
    bytes.writeBytes(4, second, 0, 1);
    std::vector<std::uint8_t> both = first;
    both.insert(both.end(), second.begin(), second.end());
    EXPECT_EQ(bytes.readBytes(4), both);
    expectNoGlErrors();
}

TEST_F(TextureTest, EnsureReplacesOnlyWhatDiffers) {
    Texture t;
    t.ensure("t", GL_TEXTURE_2D, GL_R32F, 4, 4);
    const GLuint id = t.id();
    t.ensure("t", GL_TEXTURE_2D, GL_R32F, 4, 4);
    EXPECT_EQ(t.id(), id);
    t.ensure("t", GL_TEXTURE_2D, GL_R32F, 4, 5);
    EXPECT_EQ(t.height(), 5);
    EXPECT_EQ(t.readFloats(1).size(), 20u);
    Texture cube("cube", GL_TEXTURE_CUBE_MAP, GL_DEPTH_COMPONENT32F, 4, 4);
    EXPECT_EQ(cube.bytes(), 6u * 4u * 4u * 4u);
    expectNoGlErrors();
}

TEST_F(TextureTest, FramebufferClearsItsAttachment) {
    const Texture color("color", GL_TEXTURE_2D, GL_RGBA32F, 7, 3);
    const Framebuffer framebuffer("framebuffer", {&color});
    framebuffer.bind();
    GLint viewport[4];
    glGetIntegerv(GL_VIEWPORT, viewport);
    EXPECT_EQ(viewport[2], 7);
    EXPECT_EQ(viewport[3], 3);
    const float value[4] = {1, 2, 3, 4};
    glClearNamedFramebufferfv(framebuffer.id(), GL_COLOR, 0, value);
    const std::vector<float> texels = color.readFloats(4);
    for (std::size_t i = 0; i < texels.size(); ++i) EXPECT_EQ(texels[i], value[i % 4]) << i;

    expectNoGlErrors();
}

TEST_F(TextureTest, AnImpossibleSizeNamesTheLimit) {
    try {
        const Texture t("huge", GL_TEXTURE_2D, GL_R8, limits().maxTextureSize + 1, 1);
        FAIL() << "made a texture above the limit";
    } catch (const Error& e) {
        EXPECT_EQ(e.code, ExitCode::impossible);
        EXPECT_NE(std::string(e.what()).find("huge"), std::string::npos) << e.what();
    }
}

}  // namespace
}  // namespace mv::gl
