#include "app/viewer/window.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>

#include <chrono>
#include <cstdlib>

#include "app/viewer/glfw_window.h"
#include "app/viewer/session.h"
#include "megaviews/settings/error.h"
#include "renderer/gl/context.h"

namespace mv {

bool displayAvailable() {
    return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

int runWindow(const RunOptions& options, const Settings& settings) {
    GlfwWindow window(options.vsync);
    gl::initialise("window");
    float monitorScale = 1, unused = 1;
    glfwGetWindowContentScale(window.handle, &monitorScale, &unused);
    Session session(options, settings, window, static_cast<double>(monitorScale));
    window.sendTo(session);

    auto last = std::chrono::steady_clock::now();
    while (!glfwWindowShouldClose(window.handle) && !session.closed()) {
        // While nothing changes, sleep until something happens.
        if (session.resting()) {
            glfwWaitEventsTimeout(0.1);
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
        session.frame(seconds, width, height, 0);
        glfwSwapBuffers(window.handle);
    }
    return static_cast<int>(ExitCode::ok);
}

}  // namespace mv
