#pragma once
// The window system's side of the viewer: GLFW with a window and its OpenGL 4.5 context, and Dear
// ImGui on top of both.

struct GLFWwindow;

namespace mv {

inline constexpr int kInitialWidth = 1280, kInitialHeight = 720;

// GLFW itself, its window and context, current on this thread. Throws Error(ExitCode::graphics).
class GlfwWindow {
  public:
    explicit GlfwWindow(bool vsync);
    ~GlfwWindow();
    GlfwWindow(const GlfwWindow&) = delete;
    GlfwWindow& operator=(const GlfwWindow&) = delete;
    GLFWwindow* handle = nullptr;
};

// Installs ImGui's callbacks; others are installed afterwards and pass on what they get.
class ImGuiLayer {
  public:
    explicit ImGuiLayer(GLFWwindow* window);
    ~ImGuiLayer();
    ImGuiLayer(const ImGuiLayer&) = delete;
    ImGuiLayer& operator=(const ImGuiLayer&) = delete;
    void beginFrame();
    void endFrame();  // draws into the current framebuffer
};

}  // namespace mv
