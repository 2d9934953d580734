#include "app/viewer/window.h"

#include <GLFW/glfw3.h>

#include <chrono>
#include <cstdlib>

#include <spdlog/spdlog.h>

#include "app/common/terminal.h"
#include "app/viewer/glfw_window.h"
#include "app/viewer/script_runner.h"
#include "app/viewer/session.h"
#include "megaviews/core/error.h"
#include "renderer/gl/context.h"

namespace mv {

bool displayAvailable() {
    return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

namespace {

// Draws frames until the window is closed, a script quits or a signal comes.
void runFrames(GlfwWindow& window, Session& session, ScriptRunner& script) {
    auto last = std::chrono::steady_clock::now();
    while (!glfwWindowShouldClose(window.handle) && !session.closed() && !interrupted()) {
        // While nothing changes, sleep until something happens.
        if (session.resting() && script.done()) {
            glfwWaitEventsTimeout(0.1);
        } else if (session.waiting() && script.done()) {
            glfwWaitEventsTimeout(0.03);
        } else {
            glfwPollEvents();
        }
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last).count();
        last = now;
        int width = 0, height = 0;
        glfwGetFramebufferSize(window.handle, &width, &height);
        if (width == 0 || height == 0) {  // minimised
            glfwWaitEventsTimeout(0.1);
            continue;
        }
        if (!session.loading() || script.started()) script.step(width, height);
        session.frame(seconds, width, height, 0);
        window.present();
    }
}

}  // namespace

int runWindow(const RunOptions& options, const Settings& settings) {
    noteInterrupts();
    GlfwWindow window(options.vsync);
    gl::initialise("window", options.glWish);
    float monitorScale = 1, unused = 1;
    glfwGetWindowContentScale(window.handle, &monitorScale, &unused);
    const std::string stateFile = userStateFile();
    if (const auto place = loadUserState(stateFile).window) window.put(*place);
    Session session(options, settings, window, static_cast<double>(monitorScale), stateFile);
    window.sendTo(session);
    if (!options.sceneGiven && options.actions.empty()) session.perform(Action::startPage);
    ScriptRunner script(options.actions, session, window);
    // What stays however the program ends.
    const auto leave = [&] {
        updateUserState(stateFile, [&](UserState& state) {
            state.window = window.place();
            state.panel = session.openPanel();
        });
        if (!options.saveStateFile.empty()) session.saveState(options.saveStateFile);
    };
    try {
        runFrames(window, session, script);
    } catch (...) {
        try {
            leave();
        } catch (const std::exception& error) {  // of two the first counts
            spdlog::debug("{}", error.what());
        }
        throw;
    }
    leave();
    if (interrupted()) throw Cancelled();
    return static_cast<int>(ExitCode::ok);
}

}  // namespace mv
