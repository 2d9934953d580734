// Handles on the lights in the picture, while the lights' section is open: one moves a light, one
// at the end of a line turns it.

#include <string>

#include "ui/panels.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

constexpr ImU32 kLightColour = IM_COL32(255, 214, 102, 255);
constexpr ImU32 kLightShade = IM_COL32(0, 0, 0, 170);

// A thin window of its own, so that dragging it does not turn the camera.
void handle(Context& c, std::size_t light, bool tip, ImVec2 at, const char* help) {
    const float size = c.px(22);
    const std::string name = "light." + std::to_string(light) + (tip ? ".tip-handle" : ".handle");
    ImGui::SetNextWindowPos({at.x - size / 2, at.y - size / 2});
    ImGui::SetNextWindowSize({size, size});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    ImGui::PushStyleColor(ImGuiCol_WindowBg, 0u);
    ImGui::Begin(("##" + name).c_str(), nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav);
    ImGui::InvisibleButton("drag", {size, size});
    c.named(name);
    const bool active = ImGui::IsItemActive();
    if (!active) tooltip(tip ? "Drag to turn the light" : "Drag to move the light", help);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImU32 colour = active || ImGui::IsItemHovered() ? palette::kAccent : kLightColour;
    draw->AddCircleFilled(at, c.px(tip ? 6 : 8), kLightShade);
    if (tip) {
        draw->AddCircleFilled(at, c.px(4), colour);
    } else {
        draw->AddCircle(at, c.px(6), colour, 0, c.px(2));
    }
    if (active && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1)) {
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        c.requests.lightDrag = LightDrag{light, tip, mouse.x, mouse.y};
    }
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(3);
}

}  // namespace

void lightHandles(Context& c) {
    if (!c.model.lightsOpen) return;
    ImDrawList* lines = ImGui::GetBackgroundDrawList();
    for (std::size_t i = 0; i < c.model.lights.size(); ++i) {
        const LightRow& light = c.model.lights[i];
        if (light.place && light.tip) {
            const ImVec2 a((*light.place)[0], (*light.place)[1]),
                b((*light.tip)[0], (*light.tip)[1]);
            lines->AddLine(a, b, kLightShade, c.px(4));
            lines->AddLine(a, b, kLightColour, c.px(2));
        }
        if (light.place && light.hasPosition) {
            handle(c, i, false, {(*light.place)[0], (*light.place)[1]},
                   "It stays at its distance from the camera.");
        }
        if (light.tip && light.hasDirection) {
            handle(c, i, true, {(*light.tip)[0], (*light.tip)[1]}, "The line is where it shines.");
        }
    }
}

}  // namespace mv::ui
