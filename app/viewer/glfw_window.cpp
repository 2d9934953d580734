#include "app/viewer/glfw_window.h"

#include <GLFW/glfw3.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "app/viewer/key_bindings.h"
#include "megaviews/core/error.h"

namespace mv {
namespace {

GlfwWindow& of(GLFWwindow* window) {
    return *static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window));
}

}  // namespace

GlfwWindow::GlfwWindow(bool vsync) {
    static std::string lastError;
    glfwSetErrorCallback([](int, const char* text) { lastError = text; });
    if (!glfwInit()) throw Error(ExitCode::graphics, "no window system: " + lastError);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    handle = glfwCreateWindow(kInitialWidth, kInitialHeight, "MegaViews", nullptr, nullptr);
    if (!handle) {
        glfwTerminate();
        throw Error(ExitCode::graphics, "no window with OpenGL 4.5: " + lastError);
    }
    glfwMakeContextCurrent(handle);
    glfwSwapInterval(vsync ? 1 : 0);
    glfwSetErrorCallback([](int, const char* text) { spdlog::warn("window system: {}", text); });
    glfwSetWindowUserPointer(handle, this);
}

GlfwWindow::~GlfwWindow() {
    glfwDestroyWindow(handle);
    glfwTerminate();
}

void GlfwWindow::setTitle(const std::string& title) { glfwSetWindowTitle(handle, title.c_str()); }

void GlfwWindow::setVsync(bool on) { glfwSwapInterval(on ? 1 : 0); }

void GlfwWindow::setFullScreen(bool on) {
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
    if (on && mode) {
        glfwGetWindowPos(handle, &x_, &y_);
        glfwGetWindowSize(handle, &width_, &height_);
        glfwSetWindowMonitor(handle, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
    } else {
        glfwSetWindowMonitor(handle, nullptr, x_, y_, width_, height_, GLFW_DONT_CARE);
    }
}

WindowPlace GlfwWindow::place() const {
    WindowPlace place{x_, y_, width_, height_};
    if (!glfwGetWindowMonitor(handle)) {
        glfwGetWindowPos(handle, &place.x, &place.y);
        glfwGetWindowSize(handle, &place.width, &place.height);
    }
    return place;
}

void GlfwWindow::put(const WindowPlace& place) {
    int count = 0;
    GLFWmonitor** monitors = glfwGetMonitors(&count);
    for (int i = 0; i < count; ++i) {
        int x = 0, y = 0, width = 0, height = 0;
        glfwGetMonitorWorkarea(monitors[i], &x, &y, &width, &height);
        if (place.x >= x && place.y >= y && place.x < x + width && place.y < y + height) {
            glfwSetWindowSize(handle, std::min(place.width, width), std::min(place.height, height));
            glfwSetWindowPos(handle, place.x, place.y);
            return;
        }
    }
}

void GlfwWindow::catchMouse(bool on) {
    glfwSetInputMode(handle, GLFW_CURSOR, on ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
}

void GlfwWindow::resize(int width, int height) { glfwSetWindowSize(handle, width, height); }

bool GlfwWindow::poll(int width, int height) {
    glfwPollEvents();
    int nowWidth = 0, nowHeight = 0;
    glfwGetFramebufferSize(handle, &nowWidth, &nowHeight);
    return nowWidth == width && nowHeight == height && !glfwWindowShouldClose(handle);
}

void GlfwWindow::present() { glfwSwapBuffers(handle); }

void GlfwWindow::sendTo(Session& session) {
    queue_ = &session.input();
    session.imgui().setClipboard(
        [this] {
            const char* text = glfwGetClipboardString(handle);
            return std::string(text ? text : "");
        },
        [this](const char* text) { glfwSetClipboardString(handle, text); });
    installCallbacks();
}

void GlfwWindow::installCallbacks() {
    glfwSetCursorPosCallback(handle, [](GLFWwindow* w, double x, double y) {
        // GLFW counts in screen coordinates, which need not be pixels.
        int width = 1, height = 1, pixelWidth = 1, pixelHeight = 1;
        glfwGetWindowSize(w, &width, &height);
        glfwGetFramebufferSize(w, &pixelWidth, &pixelHeight);
        of(w).queue_->push(
            MouseMoved{x * pixelWidth / std::max(width, 1), y * pixelHeight / std::max(height, 1)});
    });
    glfwSetMouseButtonCallback(handle, [](GLFWwindow* w, int button, int event, int) {
        if (button > static_cast<int>(MouseButton::middle)) return;
        of(w).queue_->push(
            MouseButtonChanged{static_cast<MouseButton>(button), event == GLFW_PRESS});
    });
    glfwSetScrollCallback(handle, [](GLFWwindow* w, double x, double y) {
        of(w).queue_->push(Scrolled{x, y});
    });
    glfwSetKeyCallback(handle, [](GLFWwindow* w, int key, int, int event, int modifiers) {
        const bool pressed = event != GLFW_RELEASE;
        of(w).queue_->push(KeyChanged{key, modifiersAfter(key, modifiers, pressed), pressed,
                                      event == GLFW_REPEAT});
    });
    glfwSetCharCallback(handle, [](GLFWwindow* w, unsigned codepoint) {
        of(w).queue_->push(TextTyped{codepoint});
    });
    glfwSetDropCallback(handle, [](GLFWwindow* w, int count, const char** files) {
        of(w).queue_->push(FilesDropped{{files, files + count}});
    });
    glfwSetWindowFocusCallback(handle, [](GLFWwindow* w, int focused) {
        if (!focused) of(w).queue_->push(FocusLost{});
    });
}

}  // namespace mv
