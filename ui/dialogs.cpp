// Errors that need an answer, what is known of the scene's file, and broken shaders that stay in
// sight until they are mended.

#include <algorithm>
#include <string>

#include "ui/format.h"
#include "ui/panels.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

// Escape; Enter too, unless it presses a button that arrows went to.
bool dismissedByKey() {
    const auto pressed = [](ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
    return pressed(ImGuiKey_Escape) || (!ImGui::GetIO().NavVisible &&
                                        (pressed(ImGuiKey_Enter) || pressed(ImGuiKey_KeyPadEnter)));
}

// Everything that is known of the file, as text that can be copied.
std::string aboutText(const Model& m) {
    std::string text = m.sceneName + "\n" + m.sceneSummary + "\n";
    const auto list = [&](const char* title, const std::vector<std::string>& entries) {
        if (entries.empty()) return;
        text += std::string("\n") + title + "\n";
        for (const std::string& entry : entries) text += "  " + entry + "\n";
    };
    list("Warnings", m.warnings);
    list("Used by the file and not shown", m.ignored);
    list("Extensions that are read", m.extensions);
    list("Added", m.notes);
    return text;
}

}  // namespace

bool beginDialog(Context& c, const char* title, const char* name, float width, bool* open) {
    if (!ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float wide = std::min(c.px(width), display.x - c.px(24));
    ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({wide, 0}, {wide, display.y - c.px(24)});
    if (!ImGui::BeginPopupModal(title, open,
                                ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_AlwaysAutoResize)) {
        return false;
    }
    const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    c.named("panel:" + std::string(name), {at.x, at.y, size.x, size.y});
    return true;
}

void errorDialog(Context& c) {
    Model& m = c.model;
    if (m.error.empty()) return;
    if (!beginDialog(c, "Something went wrong", "error", 520, nullptr)) return;
    const float inner = ImGui::GetContentRegionAvail().x;
    wrappedText(m.error);
    ImGui::Dummy({inner, c.px(2)});
    if (!m.errorHint.empty()) wrappedText(m.errorHint, palette::kDim);
    ImGui::Dummy({inner, c.px(6)});
    const float wide = c.px(90), gap = ImGui::GetStyle().ItemSpacing.x;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + inner - 2 * wide - gap);
    if (button(c, "error.copy", "Copy", wide)) {
        ImGui::SetClipboardText((m.error + "\n" + m.errorHint).c_str());
    }
    ImGui::SameLine();
    const bool closed = button(c, "error.close", "Close", wide);
    ImGui::SetItemDefaultFocus();
    if (closed || dismissedByKey()) {
        c.requests.errorDismissed = true;
        m.error.clear();
        m.errorHint.clear();
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

void aboutScene(Context& c) {
    Model& m = c.model;
    if (!m.aboutScene || !m.error.empty()) return;
    if (!beginDialog(c, "About the scene", "about-scene", 620, &m.aboutScene)) return;
    const std::string all = aboutText(m);
    wrappedText(all);
    const float wide = c.px(90);
    if (button(c, "about-scene.copy", "Copy", wide)) ImGui::SetClipboardText(all.c_str());
    ImGui::SameLine();
    const bool closed = button(c, "about-scene.close", "Close", wide);
    ImGui::SetItemDefaultFocus();
    if (closed || dismissedByKey()) m.aboutScene = false;
    if (!m.aboutScene) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void shaderErrors(Context& c) {
    const auto& errors = c.model.shaderErrors;
    if (errors.empty()) return;
    const Rect& view = c.layout.picture;
    const float width = std::min(c.px(560), view.width - c.px(24));
    ImGui::SetNextWindowSizeConstraints({width, 0}, {width, view.height * 0.45f});
    beginPlate(c, "shader-errors", view.x + view.width / 2, view.y + c.px(12), {0.5f, 0});
    std::string all;
    text(c, errors.size() == 1 ? "A shader does not compile" : "Shaders do not compile",
         palette::kTrouble);
    const float room = width - 2 * c.px(10);
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + room);
    ImGui::TextDisabled("The last good one goes on. F5 tries again.");
    ImGui::PopTextWrapPos();
    for (const std::string& error : errors) {
        all += error + "\n";
        ImGui::Dummy({0, c.px(2)});
        ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + room);
        ImGui::TextUnformatted(error.c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::Dummy({room, c.px(2)});
    if (button(c, "shader-errors.copy", "Copy")) ImGui::SetClipboardText(all.c_str());
    ImGui::SameLine();
    actionButton(c, Action::reloadShaders, "Reload");
    endPlate(c, "shader-errors");
}

}  // namespace mv::ui
