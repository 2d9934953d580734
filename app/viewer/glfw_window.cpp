#include "app/viewer/glfw_window.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_opengl3.h>
#include <spdlog/spdlog.h>

#include <string>

#include "megaviews/settings/error.h"

namespace mv {

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
}

GlfwWindow::~GlfwWindow() {
    glfwDestroyWindow(handle);
    glfwTerminate();
}

ImGuiLayer::ImGuiLayer(GLFWwindow* window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // the layout is fixed: nothing to litter
    ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    ImGui_ImplOpenGL3_Init("#version 450 core");
}

ImGuiLayer::~ImGuiLayer() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void ImGuiLayer::beginFrame() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void ImGuiLayer::endFrame() {
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace mv
