#pragma once
// The whole viewer without a display: a session that draws into a framebuffer, driven by scripts.

#include <epoxy/gl.h>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "app/common/script.h"
#include "app/viewer/script_runner.h"
#include "app/viewer/session.h"
#include "renderer/gl/context.h"

namespace mv {

class Screen : public Host {
  public:
    void resize(int width, int height) override {
        target = {};
        color = gl::Texture("screen", GL_TEXTURE_2D, GL_RGBA8, width, height);
        target = gl::Framebuffer("screen", {&color});
    }
    void setTitle(const std::string& text) override { title = text; }
    void setVsync(bool on) override { vsync = on; }
    void setFullScreen(bool on) override { fullScreen = on; }
    void catchMouse(bool on) override { mouseCaught = on; }
    gl::Texture color;
    gl::Framebuffer target;
    std::string title;
    bool vsync = true, fullScreen = false, mouseCaught = false;
};

class Viewer {
  public:
    // Small and quick, so that what a test asks for is all it pays for.
    static Settings smallSettings() {
        Settings s;
        s.scene.octreeDepth = 5;
        s.views.octreeDepth = 5;
        s.views.vpls = 64;
        s.side[0].maps.resolution = s.side[1].maps.resolution = 8;
        s.gather.samples = 2;
        s.gather.candidates = 1;
        s.gather.undecided = Undecided::off;
        s.gather.nearField = false;
        s.gather.filter = false;
        s.picture.accumulate = 2;
        return s;
    }

    explicit Viewer(int width = 640, int height = 400, const Settings& settings = smallSettings(),
                    const std::string& scene = "builtin:cornell", float scale = 1,
                    const std::string& userStateFile = {}, const std::string& referenceFile = {}) {
        screen.resize(width, height);
        options.headless = options.ui = true;
        options.useCache = false;
        options.scene = scene;
        options.measure.referenceFile = referenceFile;
        options.uiScale = static_cast<double>(scale);
        options.given = {"scene-depth", "view-depth", "vpls",
                         "view-res",    "accumulate", "gather-samples"};
        session = std::make_unique<Session>(options, settings, screen, 1, userStateFile);
        waitForScene();
    }

    void frame() {
        session->frame(1.0 / 30, screen.color.width(), screen.color.height(), screen.target.id());
    }
    void frames(int count) {
        for (int i = 0; i < count; ++i) frame();
    }
    void waitForScene() {
        frame();
        while (session->loading()) frame();
        frames(2);
    }
    void run(const std::string& script) {
        ScriptRunner runner(script::parse(script, "test"), *session, screen);
        while (!runner.done()) {
            runner.step(screen.color.width(), screen.color.height());
            frame();
        }
        frame();
    }
    const Settings& settings() const { return session->settings(); }
    const ui::Model& model() const { return session->model(); }
    std::vector<std::uint8_t> pixels() const { return screen.color.readBytes(4); }
    // Of the picture's area only: the left half, where no controls are.
    std::uint64_t pictureHash() const {
        const auto bytes = pixels();
        std::uint64_t hash = 1469598103934665603u;
        const auto w = static_cast<std::size_t>(screen.color.width());
        const auto h = static_cast<std::size_t>(screen.color.height());
        for (std::size_t y = h / 10; y < h * 9 / 10; ++y) {
            for (std::size_t x = w / 20; x < w / 3; ++x) {
                for (std::size_t c = 0; c < 3; ++c) {
                    hash = (hash ^ bytes[4 * (y * w + x) + c]) * 1099511628211u;
                }
            }
        }
        return hash;
    }

    RunOptions options;
    Screen screen;
    std::unique_ptr<Session> session;
};

class ViewerTest : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        try {
            context_ = std::make_unique<gl::HeadlessContext>();
        } catch (const std::exception& error) {
            reason_ = error.what();
        }
    }
    static void TearDownTestSuite() { context_.reset(); }
    void SetUp() override {
        if (!context_) GTEST_SKIP() << reason_;
        errorsBefore_ = gl::reportedErrors();
    }
    void TearDown() override {
        if (!context_) return;
        EXPECT_EQ(gl::reportedErrors(), errorsBefore_) << "OpenGL errors";
    }

  private:
    static inline std::unique_ptr<gl::HeadlessContext> context_;
    static inline std::string reason_;
    std::uint64_t errorsBefore_ = 0;
};

}  // namespace mv
