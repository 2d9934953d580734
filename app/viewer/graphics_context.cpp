#include "app/viewer/graphics_context.h"

#include <GLFW/glfw3.h>

#include <string>

#include "app/viewer/window.h"
#include "megaviews/core/error.h"

namespace mv {

class GraphicsContext::HiddenWindow {
  public:
    explicit HiddenWindow(const gl::ContextWish& wish) {
        static std::string lastError;
        lastError = "no reason given";
        glfwSetErrorCallback([](int, const char* text) { lastError = text; });
        if (!glfwInit()) throw Error(ExitCode::graphics, "hidden window: " + lastError);
        glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        window_ = glfwCreateWindow(16, 16, "megaviews", nullptr, nullptr);
        if (!window_) {
            glfwTerminate();
            throw Error(ExitCode::graphics, "hidden window: " + lastError);
        }
        glfwMakeContextCurrent(window_);
        try {
            gl::initialise("hidden window", wish);
        } catch (...) {
            destroy();
            throw;
        }
    }
    ~HiddenWindow() { destroy(); }
    HiddenWindow(const HiddenWindow&) = delete;
    HiddenWindow& operator=(const HiddenWindow&) = delete;

  private:
    void destroy() {
        glfwDestroyWindow(window_);
        glfwTerminate();
    }
    GLFWwindow* window_ = nullptr;
};

GraphicsContext::GraphicsContext(GlPlatform platform, const gl::ContextWish& wish) {
    if (platform == GlPlatform::window) {
        window_ = std::make_unique<HiddenWindow>(wish);
        return;
    }
    try {
        egl_ = std::make_unique<gl::HeadlessContext>(wish);
    } catch (const Error& eglError) {
        if (platform == GlPlatform::egl || !displayAvailable()) throw;
        try {
            window_ = std::make_unique<HiddenWindow>(wish);
        } catch (const Error& windowError) {
            throw Error(ExitCode::graphics,
                        std::string(eglError.what()) + "; " + windowError.what());
        }
    }
}

GraphicsContext::~GraphicsContext() = default;

}  // namespace mv
