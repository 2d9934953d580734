// The panel at the right: what is changed most often always in sight, every other setting of the
// table in groups below.

#include <algorithm>
#include <string>

#include "ui/format.h"
#include "ui/panels.h"
#include "ui/setting_widget.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

// Shown above the groups, or set by something better than a field.
constexpr std::string_view kAbove[] = {"method",
                                       "compare",
                                       "traversal",
                                       "rules",
                                       "view-res",
                                       "compare-rules",
                                       "compare-traversal",
                                       "compare-view-res",
                                       "difference",
                                       "difference-range",
                                       "vpls",
                                       "bounces",
                                       "gather-samples",
                                       "accumulate",
                                       "camera",
                                       "environment",
                                       "view",
                                       "exposure",
                                       "tonemap",
                                       "filter"};

struct Preset {
    Action action;
    std::string_view title;
};
constexpr Preset kPresets[] = {{Action::resetSettings, "defaults"},
                               {Action::presetFast, "fast"},
                               {Action::presetBalanced, "balanced"},
                               {Action::presetQuality, "quality"},
                               {Action::presetBench, "bench"},
                               {Action::presetPaperMegaviews, "paper-megaviews"},
                               {Action::presetPaperManylods, "paper-manylods"}};

void presets(Context& c) {
    rowLabel(c, "Preset");
    const char* resetLabel = "Reset all";
    const float reset = ImGui::CalcTextSize(resetLabel).x + 2 * ImGui::GetStyle().FramePadding.x;
    const float gap = c.px(4);
    const bool roomy = c.layout.controls.width >= c.px(300);
    const float width = rowFieldWidth() - (roomy ? reset + gap : 0);
    const std::string& now = c.model.preset;
    if (beginCombo(c, "##preset", now.empty() ? "own values" : now, width)) {
        for (const Preset& preset : kPresets) {
            const std::string title(preset.title);
            if (ImGui::Selectable(title.c_str(), title == now)) c.act(preset.action);
            c.named(idOf(infoOf(preset.action)));
            tooltip(infoOf(preset.action).help);
        }
        ImGui::EndCombo();
    }
    c.named("preset");
    tooltip("Preset", "Values for several settings at once; camera and scene stay.");
    if (!roomy) return;  // the Edit menu has it too
    ImGui::SameLine(0, gap);
    actionButton(c, Action::resetSettings, resetLabel);
}

void groups(Context& c) {
    static constexpr SettingGroup kGroups[] = {SettingGroup::scene,   SettingGroup::method,
                                               SettingGroup::views,   SettingGroup::gather,
                                               SettingGroup::picture, SettingGroup::instruments};
    for (const SettingGroup group : kGroups) {
        const std::string title(groupTitle(group));
        const bool open = groupHeader(c, title);
        c.named("group:" + title);
        if (!open) continue;
        ImGui::PushID(title.c_str());
        for (const SettingInfo& setting : settingsTable()) {
            const bool above =
                std::find(std::begin(kAbove), std::end(kAbove), setting.key) != std::end(kAbove);
            if (setting.group == group && !above) settingRow(c, setting);
        }
        if (button(c, "reset-group:" + title, "Reset this group")) resetGroup(c, group);
        ImGui::PopID();
        ImGui::Dummy({0, c.px(4)});
    }
}

}  // namespace

void controlsPanel(Context& c) {
    beginFixed(c, "controls", c.layout.controls, ImGuiWindowFlags_AlwaysVerticalScrollbar);
    presets(c);
    sectionTitle(c, "Scene");
    transport(c);
    cameraControls(c);
    environmentControls(c);
    sectionTitle(c, "Method", !c.settings.compare);
    methodControls(c);
    sectionTitle(c, "Light");
    settingRow(c, "vpls", "VPLs");
    settingRow(c, "bounces");
    settingRow(c, "gather-samples");
    settingRow(c, "accumulate");
    settingRow(c, "filter");
    sectionTitle(c, "Picture");
    settingRow(c, "view");
    settingRow(c, "exposure");
    settingRow(c, "tonemap");
    ImGui::Dummy({0, c.px(4)});
    lightControls(c);
    groups(c);
    endFixed();
}

}  // namespace mv::ui
