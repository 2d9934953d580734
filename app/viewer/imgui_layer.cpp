#include "app/viewer/imgui_layer.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_impl_opengl3.h>
#include <imgui_internal.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "app/viewer/system_fonts.h"
#include "megaviews/core/overloaded.h"

namespace mv {
namespace {

constexpr std::pair<ImGuiKey, int> kImGuiKeys[] = {
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

}  // namespace

ImGuiLayer::ImGuiLayer() {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // the layout is our own
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    for (const auto& [key, code] : kImGuiKeys) io.KeyMap[key] = code;
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
    scale_ = scale;
    const bool drawn = ImGui::GetIO().Fonts->TexID != nullptr;  // else the first frame makes it
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ui::applyStyle(scale, glyphs_);
    if (drawn) ImGui_ImplOpenGL3_CreateFontsTexture();
}

void ImGuiLayer::addGlyphs(const std::set<char32_t>& characters) {
    std::set<char32_t> missing;
    for (const char32_t c : characters) {
        if (glyphs_.characters.insert(c).second) missing.insert(c);
    }
    if (missing.empty()) return;
    setScale(scale_);
    // Leaves those that neither the built-in font has nor one that was found earlier.
    std::erase_if(missing, [](char32_t c) {
        return ImGui::GetIO().Fonts->Fonts[0]->FindGlyphNoFallback(static_cast<ImWchar>(c));
    });
    if (missing.empty()) return;
    ++fontSearches_;
    std::vector<ui::FontFile> found = systemFonts(missing);
    if (found.empty()) return;
    std::move(found.begin(), found.end(), std::back_inserter(glyphs_.fonts));
    setScale(scale_);
}

// F10, or Alt with nothing else between its press and its release.
void ImGuiLayer::noteMenuKey(const InputEvent& event) {
    const auto* key = std::get_if<KeyChanged>(&event);
    const bool alt = key && (key->key == GLFW_KEY_LEFT_ALT || key->key == GLFW_KEY_RIGHT_ALT);
    if (alt && key->pressed) {
        altAlone_ = (key->modifiers & ~GLFW_MOD_ALT) == 0;
    } else if (alt) {
        menuKey_ |= std::exchange(altAlone_, false);
    } else if (!std::holds_alternative<MouseMoved>(event)) {
        altAlone_ = false;
        menuKey_ |= key && key->key == GLFW_KEY_F10 && key->pressed && key->modifiers == 0;
    }
}

void ImGuiLayer::handle(const InputEvent& event) {
    ImGuiIO& io = ImGui::GetIO();
    noteMenuKey(event);
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
    if (ImGui::GetCurrentContext()->WithinFrameScope) ImGui::EndFrame();  // an error left it open
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    if (std::exchange(menuKey_, false)) ui::toggleMenuBar();
}

void ImGuiLayer::endFrame(unsigned framebuffer) {
    // Escape, with nothing left to leave in a panel, gives the keyboard back to the picture.
    if (ImGui::IsKeyPressed(GLFW_KEY_ESCAPE) && !popupOpen() && !ImGui::IsAnyItemActive() &&
        ImGui::GetCurrentContext()->NavId == 0) {
        ImGui::SetWindowFocus(nullptr);
    }
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
