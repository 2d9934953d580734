// The dock at the left, there only while an instrument is open: a row of tabs and the instrument.

#include <array>
#include <cmath>

#include "megaviews/core/text.h"
#include "ui/panels.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

struct Tab {
    Instrument instrument;
    std::string_view name;
    Action action;
    void (*draw)(Context&);
};
constexpr std::array<Tab, 7> kTabs = {{
    {Instrument::profiler, "Profiler", Action::showProfiler, profilerPanel},
    {Instrument::traversal, "Traversal", Action::showTraversal, traversalPanel},
    {Instrument::memory, "Memory", Action::showMemory, memoryPanel},
    {Instrument::views, "Views", Action::showViews, viewsPanel},
    {Instrument::pixel, "Pixel", Action::showPixel, pixelPanel},
    {Instrument::steps, "Steps", Action::showSteps, stepsPanel},
    {Instrument::errors, "Errors", Action::showErrors, errorsPanel},
}};

const Tab& tabOf(Instrument instrument) { return kTabs[static_cast<std::size_t>(instrument)]; }

// Tabs share the width by the length of their names; the chosen one is underlined.
void tabs(Context& c) {
    Model& m = c.model;
    const float close = ImGui::GetFrameHeight();
    const float room = ImGui::GetContentRegionAvail().x - close - c.px(2);
    float names = 0;
    for (const Tab& tab : kTabs) names += ImGui::CalcTextSize(tab.name.data()).x;
    const float least = c.px(10) * static_cast<float>(kTabs.size());
    const bool twoRows = names + least > room;
    const std::size_t inFirst = twoRows ? (kTabs.size() + 1) / 2 : kTabs.size();
    const float slack =
        std::floor((twoRows ? room - names * 0.62f : room - names) / static_cast<float>(inFirst));
    const auto closeButton = [&] {
        ImGui::SameLine(0, c.px(2));
        ImGui::PushStyleColor(ImGuiCol_Button, 0u);
        if (iconButton(c, "dock.close", Icon::close, close, "Close")) m.instrument.reset();
        ImGui::PopStyleColor();
    };
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, std::round(c.px(kFramePaddingY))});
    for (std::size_t i = 0; i < kTabs.size(); ++i) {
        const Tab& tab = kTabs[i];
        const float width = std::floor(ImGui::CalcTextSize(tab.name.data()).x + slack);
        const bool chosen = m.instrument == tab.instrument;
        ImGui::PushStyleColor(ImGuiCol_Button, 0u);
        ImGui::PushStyleColor(ImGuiCol_ButtonHovered, palette::kFrame);
        ImGui::PushStyleColor(ImGuiCol_Text, chosen ? palette::kText : palette::kDim);
        if (button(c, "tab:" + lowered(tab.name), tab.name.data(), width)) {
            m.instrument = tab.instrument;
        }
        ImGui::PopStyleColor(3);
        actionTooltip(infoOf(tab.action));
        const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
        ImGui::GetWindowDrawList()->AddRectFilled({low.x, high.y}, {high.x, high.y + c.px(2)},
                                                  chosen ? palette::kAccent : palette::kLine);
        if (i + 1 == inFirst) closeButton();
        if (i + 1 != inFirst && i + 1 < kTabs.size()) ImGui::SameLine(0, 0);
    }
    ImGui::PopStyleVar();
    ImGui::Dummy({0, c.px(4)});
}

}  // namespace

Action actionOf(Instrument instrument) { return tabOf(instrument).action; }

void dock(Context& c) {
    beginFixed(c, "dock", c.layout.dock,
               ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    const Tab& tab = tabOf(*c.model.instrument);
    tabs(c);
    if (c.model.instrument) {
        const float line = c.layout.controlsShown ? 0 : ImGui::GetFrameHeightWithSpacing();
        ImGui::BeginChild(tab.name.data(), {0, -line}, false, ImGuiWindowFlags_NavFlattened);
        tab.draw(c);
        ImGui::EndChild();
        // The window is too narrow for both.
        if (!c.layout.controlsShown && button(c, "dock.controls", "Back to the controls")) {
            c.model.instrument.reset();
        }
    }
    endFixed();
}

}  // namespace mv::ui
