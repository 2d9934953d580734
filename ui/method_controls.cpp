// What lights the picture, and what it is compared with: one column, or two side by side.

#include "ui/format.h"
#include "ui/panels.h"
#include "ui/setting_widget.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

struct Row {
    const char *label, *ofBoth;  // ofBoth: beside two fields
    std::string_view left, right;
    unsigned traits;  // of the methods that read it, any of these; 0: all
};
constexpr Row kRows[] = {
    {"Method", "Method", "method", "compare", 0},
    {"Traversal", "Traversal", "traversal", "compare-traversal", kMethodPairs},
    {"Rules", "Rules", "rules", "compare-rules", kMethodPairs | kMethodMaps},
    {"Map resolution", "Map size", "view-res", "compare-view-res", kMethodMaps}};

// Grey where the method of that side would not look at it.
void fieldOf(Context& c, const Row& row, std::size_t side, float width) {
    const bool read = row.traits == 0 || (infoOf(c.methodOf(side)).traits & row.traits) != 0;
    ImGui::BeginDisabled(!read);
    settingField(c, side == 0 ? row.left : row.right, width);
    ImGui::EndDisabled();
}

void compareSwitch(Context& c) {
    Settings& s = c.settings;
    rowLabel(c, "Compare", s.compare);
    bool on = s.compare;
    if (ImGui::Checkbox("##compare", &on)) c.act(Action::toggleSplit);
    c.named(idOf(infoOf(Action::toggleSplit)));
    actionTooltip(infoOf(Action::toggleSplit));
    if (!s.compare) return;
    ImGui::SameLine();
    actionButton(c, Action::swapSides, "Swap");
}

void difference(Context& c) {
    Settings& s = c.settings;
    settingRow(c, "difference");
    if (s.display.difference != Difference::off) settingRow(c, "difference-range");
}

}  // namespace

void methodControls(Context& c) {
    Settings& s = c.settings;
    if (!s.compare) {
        for (const Row& row : kRows) {
            const SettingInfo& setting = *findSetting(row.left);
            rowLabel(c, row.label, !hasDefault(s, setting, c.model.defaults));
            fieldOf(c, row, 0, rowFieldWidth());
        }
        compareSwitch(c);
        return;
    }
    // A side that takes over the other's method gives its own in exchange.
    const Method left = s.side[0].method, right = s.side[1].method;
    const float whole = ImGui::GetContentRegionAvail().x, gap = c.px(4);
    const float label = whole * 0.24f, each = (whole - label - gap) / 2;
    const float start = ImGui::GetCursorPosX();
    for (std::size_t side = 0; side < 2; ++side) {
        ImGui::SameLine(start + label + static_cast<float>(side) * (each + gap), 0);
        if (side == 0) ImGui::NewLine();
        ImGui::SameLine(start + label + static_cast<float>(side) * (each + gap), 0);
        text(c, side == 0 ? "Left" : "Right", sideColour(side));
    }
    for (const Row& row : kRows) {
        ImGui::AlignTextToFramePadding();
        elidedText(row.ofBoth, label - c.px(4), IM_COL32(184, 190, 200, 255));
        ImGui::SameLine(start + label, 0);
        fieldOf(c, row, 0, each);
        ImGui::SameLine(start + label + each + gap, 0);
        fieldOf(c, row, 1, each);
    }
    const bool alike = s.compare && s.side[0] == s.side[1];
    if (alike && s.side[0].method != left) s.side[1].method = left;
    if (alike && s.side[1].method != right) s.side[0].method = right;
    if (!s.compare) s.display.difference = Difference::off;
    compareSwitch(c);
    if (s.compare) difference(c);
}

}  // namespace mv::ui
