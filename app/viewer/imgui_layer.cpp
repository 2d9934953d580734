#include "app/viewer/imgui_layer.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_impl_opengl3.h>

#include <algorithm>

#include "ui/interface.h"

namespace mv {
namespace {

constexpr std::pair<ImGuiKey, int> kKeys[] = {
    {ImGuiKey_Tab, GLFW_KEY_TAB},
    {ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
    {ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
    {ImGuiKey_UpArrow, GLFW_KEY_UP},
    {ImGuiKey_DownArrow, GLFW_KEY_DOWN},
    {ImGuiKey_PageUp, GLFW_KEY_PAGE_UP},
    {ImGuiKey_PageDown, GLFW_KEY_PAGE_DOWN},
    {ImGuiKey_Home, GLFW_KEY_HOME},
    {ImGuiKey_End, GLFW_KEY_END},
    {ImGuiKey_Insert, GLFW_KEY_INSERT},
    {ImGuiKey_Delete, GLFW_KEY_DELETE},
    {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
    {ImGuiKey_Space, GLFW_KEY_SPACE},
    {ImGuiKey_Enter, GLFW_KEY_ENTER},
    {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
    {ImGuiKey_KeyPadEnter, GLFW_KEY_KP_ENTER},
    {ImGuiKey_A, GLFW_KEY_A},
    {ImGuiKey_C, GLFW_KEY_C},
    {ImGuiKey_V, GLFW_KEY_V},
    {ImGuiKey_X, GLFW_KEY_X},
    {ImGuiKey_Y, GLFW_KEY_Y},
    {ImGuiKey_Z, GLFW_KEY_Z},
};

template <class... Ts>
struct Overloaded : Ts... {
    using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

}  // namespace

ImGuiLayer::ImGuiLayer() {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // the layout is our own
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    for (const auto& [key, code] : kKeys) io.KeyMap[key] = code;
    io.ClipboardUserData = this;
    io.GetClipboardTextFn = [](void* user) {
        auto& layer = *static_cast<ImGuiLayer*>(user);
        if (layer.readClipboard_) layer.clipboard_ = layer.readClipboard_();
        return layer.clipboard_.c_str();
    };
    io.SetClipboardTextFn = [](void* user, const char* text) {
        auto& layer = *static_cast<ImGuiLayer*>(user);
        layer.clipboard_ = text;
        if (layer.writeClipboard_) layer.writeClipboard_(text);
    };
    ImGui_ImplOpenGL3_Init("#version 450 core");
}

ImGuiLayer::~ImGuiLayer() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
}

void ImGuiLayer::setClipboard(std::function<std::string()> read,
                              std::function<void(const char*)> write) {
    readClipboard_ = std::move(read);
    writeClipboard_ = std::move(write);
}

void ImGuiLayer::copy(const std::string& text) { ImGui::SetClipboardText(text.c_str()); }

void ImGuiLayer::setScale(float scale) {
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ui::applyStyle(scale);
}

void ImGuiLayer::handle(const InputEvent& event) {
    ImGuiIO& io = ImGui::GetIO();
    std::visit(Overloaded{[&](const MouseMoved& e) {
                              io.MousePos = {static_cast<float>(e.x), static_cast<float>(e.y)};
                          },
                          [&](const MouseButtonChanged& e) {
                              io.MouseDown[static_cast<int>(e.button)] = e.pressed;
                          },
                          [&](const Scrolled& e) {
                              io.MouseWheelH += static_cast<float>(e.x);
                              io.MouseWheel += static_cast<float>(e.y);
                          },
                          [&](const KeyChanged& e) {
                              if (e.key >= 0 && e.key < IM_ARRAYSIZE(io.KeysDown)) {
                                  io.KeysDown[e.key] = e.pressed;
                              }
                              io.KeyCtrl = (e.modifiers & GLFW_MOD_CONTROL) != 0;
                              io.KeyShift = (e.modifiers & GLFW_MOD_SHIFT) != 0;
                              io.KeyAlt = (e.modifiers & GLFW_MOD_ALT) != 0;
                              io.KeySuper = (e.modifiers & GLFW_MOD_SUPER) != 0;
                          },
                          [&](const TextTyped& e) { io.AddInputCharacter(e.codepoint); },
                          [](const FilesDropped&) {},
                          [&](const FocusLost&) {
                              // Releases may never come: nothing stays held.
                              io.ClearInputCharacters();
                              std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
                              std::fill(std::begin(io.MouseDown), std::end(io.MouseDown), false);
                              io.KeyCtrl = io.KeyShift = io.KeyAlt = io.KeySuper = false;
                          }},
               event);
}

void ImGuiLayer::beginFrame(int width, int height, double dt) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
    io.DeltaTime = std::max(static_cast<float>(dt), 1e-4f);
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
}

void ImGuiLayer::endFrame(unsigned framebuffer) {
    ImGui::Render();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glUseProgram(0);  // the backend puts the last program back, which may be gone by then
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool ImGuiLayer::editing() const { return ImGui::IsAnyItemActive(); }

bool ImGuiLayer::takesMouse() const { return ImGui::GetIO().WantCaptureMouse; }

bool ImGuiLayer::takesKeyboard() const {
    const ImGuiIO& io = ImGui::GetIO();
    return io.WantTextInput || (io.WantCaptureKeyboard && io.NavVisible) || popupOpen();
}

bool ImGuiLayer::popupOpen() const {
    return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
}

}  // namespace mv
