#include "ui/context.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

#include "ui/style.h"

namespace mv::ui {
namespace {

constexpr float kControlsWidth = 340, kDockWidth = 400;  // at scale 1
constexpr float kLeastControls = 284, kLeastDock = 330, kLeastPicture = 240, kLeastAlone = 160;

float between(float value, float low, float high) { return std::clamp(value, low, high); }

// Whether an item of this window is in sight, or scrolling the window and those around it brings it
// there.
bool isReachable(const ImGuiWindow* window, ImRect item) {
    constexpr float kSlack = 1.01f;  // window positions are whole pixels
    for (; window; window = window->ParentWindow) {
        const bool scrolls = !(window->Flags & ImGuiWindowFlags_NoScrollWithMouse);
        const bool inBar = window->DC.NavLayerCurrent == ImGuiNavLayer_Menu;
        const ImRect inner = inBar ? window->Rect() : window->InnerRect;
        const ImVec2 low(inner.Min.x, inner.Min.y - (scrolls ? window->Scroll.y : 0));
        const ImVec2 high(inner.Max.x,
                          inner.Max.y + (scrolls ? window->ScrollMax.y - window->Scroll.y : 0));
        if (item.Min.x < low.x - kSlack || item.Max.x > high.x + kSlack ||
            item.Min.y < low.y - kSlack || item.Max.y > high.y + kSlack) {
            return false;
        }
        item = window->Rect();
        if (!(window->Flags & ImGuiWindowFlags_ChildWindow) ||
            (window->Flags & ImGuiWindowFlags_Popup)) {
            break;
        }
    }
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    return item.Min.x >= -kSlack && item.Min.y >= -kSlack && item.Max.x <= display.x + kSlack &&
           item.Max.y <= display.y + kSlack;
}

}  // namespace

Layout layoutOf(float width, float height, float scale, const Model& model) {
    Layout layout;
    layout.picture = {0, 0, std::max(width, 1.0f), std::max(height, 1.0f)};
    if (model.hidden) {
        layout.controlsShown = false;
        return layout;
    }
    const float bar = std::round(kFontSize * scale) + 2 * std::round((kFramePaddingY + 2) * scale);
    const float across = width / scale;  // in pixels at scale 1
    const bool docked = model.instrument.has_value();
    float controls = between((docked ? 0.3f : 0.4f) * across, kLeastControls, kControlsWidth);
    float dock = docked ? between(0.32f * across, kLeastDock, kDockWidth) : 0;
    if (docked && across - controls - dock < kLeastPicture) {
        layout.controlsShown = false;
        controls = 0;
        dock = std::min(kDockWidth, 0.6f * across);
    } else if (!docked && across - controls < kLeastAlone) {  // the status bar says so
        layout.controlsShown = false;
        controls = 0;
    }
    controls = std::round(controls * scale);
    dock = std::round(dock * scale);
    layout.menu = {0, 0, width, bar};
    layout.status = {0, height - bar, width, bar};
    const float inner = std::max(height - 2 * bar, 1.0f);
    layout.controls = {width - controls, bar, controls, inner};
    layout.dock = {0, bar, dock, inner};
    layout.picture = {dock, bar, std::max(width - controls - dock, 1.0f), inner};
    return layout;
}

void Context::named(std::string_view name) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    named(name, {low.x, low.y, high.x - low.x, high.y - low.y});
    if (!isReachable(ImGui::GetCurrentWindow(), {low, high})) {
        state.drawn.outOfReach.emplace_back(name);
    }
}

void Context::named(std::string_view name, const Rect& rect) {
    state.drawn.items.push_back({std::string(name), rect.x, rect.y, rect.width, rect.height});
}

void Context::figure(std::string_view text, std::vector<std::string> places) {
    state.drawn.figures.push_back({std::string(text), std::move(places)});
}

void Context::checkFits(std::string_view text, float width) {
    const float needed = ImGui::CalcTextSize(text.data(), text.data() + text.size()).x;
    if (needed > width + 0.5f) state.drawn.clipped.emplace_back(text);
}

}  // namespace mv::ui
