#include "app/viewer/headless_ui.h"

#include <chrono>
#include <cstdio>
#include <thread>

#include "app/common/output_names.h"
#include "app/common/terminal.h"
#include "app/viewer/graphics_context.h"
#include "app/viewer/script_runner.h"
#include "app/viewer/session.h"
#include "megaviews/core/error.h"

namespace mv {
namespace {

// A framebuffer in the window's place.
class Offscreen : public Host {
  public:
    Offscreen(int width, int height) { resize(width, height); }
    void resize(int width, int height) override {
        target_ = {};
        color_ = gl::Texture("window", GL_TEXTURE_2D, GL_RGBA8, width, height);
        target_ = gl::Framebuffer("window", {&color_});
    }
    int width() const { return color_.width(); }
    int height() const { return color_.height(); }
    unsigned framebuffer() const { return target_.id(); }

  private:
    gl::Texture color_;
    gl::Framebuffer target_;
};

// A click needs a few frames until all that it opens stands where it will stay.
constexpr int kSettlingFrames = 3;

}  // namespace

int runHeadlessUi(const RunOptions& options, const Settings& settings) {
    for (const std::string& file : options.outputs) {
        if (options.ui && extensionOf(file) != ".png") {
            throw Error(ExitCode::usage, "--ui: the window is written as .png, not '" + file + "'");
        }
    }
    checkWritable(outputFiles(options));
    checkWritable(script::outputFiles(options.actions));
    noteInterrupts();

    const GraphicsContext context(options.gl, options.glWish);
    Offscreen window(settings.picture.width, settings.picture.height);
    Session session(options, settings, window, 1, {});
    ScriptRunner script(options.actions, session, window);
    if (!options.ui) session.perform(Action::hideUi);
    const double seconds = 1 / options.frameRate;
    const auto frame = [&] {
        if (interrupted()) throw Cancelled();
        session.frame(seconds, window.width(), window.height(), window.framebuffer());
        if (session.loading() || session.waiting())
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
    };
    while (session.loading()) frame();
    if (!session.model().error.empty() && !session.still()) {
        throw Error(ExitCode::input, session.model().error);
    }
    while (!script.done() && !session.closed()) {
        script.step(window.width(), window.height());
        frame();
    }
    while (!session.closed() && !session.still() &&
           !(session.model().playing && session.model().animationS > 0)) {
        frame();
    }
    if (!options.saveStateFile.empty()) {
        session.saveState(options.saveStateFile);
        std::printf("%s\n", options.saveStateFile.c_str());
    }
    for (const std::string& file : options.outputs) {
        if (!options.ui) {
            session.savePicture(file);
            std::printf("%s\n", file.c_str());
            continue;
        }
        for (int i = 0; i < kSettlingFrames; ++i) frame();
        session.saveWindowAfterFrame(outputName(file, 0, 1));
        frame();
        std::printf("%s\n", file.c_str());
    }
    return static_cast<int>(ExitCode::ok);
}

}  // namespace mv
