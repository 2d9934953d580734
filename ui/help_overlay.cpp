// Help: keys, mouse and settings in one list that can be searched, made from their tables. A click
// on an action performs it. The list of commands is the same for hands that stay on the keyboard.

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "megaviews/core/text.h"
#include "megaviews/settings/actions.h"
#include "ui/panels.h"
#include "ui/setting_widget.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

// Every word that was typed stands somewhere in the text.
bool matches(const std::string& search, std::initializer_list<std::string_view> texts) {
    std::string all;
    for (const std::string_view text : texts) all += lowered(text) + " ";
    std::size_t begin = 0;
    while (begin < search.size()) {
        const std::size_t end = std::min(search.find(' ', begin), search.size());
        if (end > begin && all.find(search.substr(begin, end - begin)) == std::string::npos) {
            return false;
        }
        begin = end + 1;
    }
    return true;
}

void heading(std::string_view title) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::PushStyleColor(ImGuiCol_Text, palette::kAccent);
    ImGui::TextUnformatted(title.data(), title.data() + title.size());
    ImGui::PopStyleColor();
}

// A key as a small cap; several keys, separated by a space, as several.
void cap(Context& c, std::string_view key, bool several = true) {
    if (key.empty()) return;
    std::size_t begin = 0;
    bool first = true;
    while (begin < key.size()) {
        const std::size_t end = several ? std::min(key.find(' ', begin), key.size()) : key.size();
        const std::string one(key.substr(begin, end - begin));
        begin = end + 1;
        if (one.empty()) continue;
        if (!first) ImGui::SameLine(0, c.px(4));
        first = false;
        const ImVec2 at = ImGui::GetCursorScreenPos(), size = ImGui::CalcTextSize(one.c_str());
        ImGui::GetWindowDrawList()->AddRectFilled(
            at, {at.x + size.x + c.px(10), at.y + size.y + c.px(1)}, palette::kFrame, c.px(3));
        ImGui::GetWindowDrawList()->AddText({at.x + c.px(5), at.y}, palette::kText, one.c_str());
        ImGui::Dummy({size.x + c.px(10), size.y + c.px(1)});
    }
}

void describe(std::string_view name, std::string_view help) {
    ImGui::PushStyleColor(ImGuiCol_Text, palette::kText);
    ImGui::TextUnformatted(name.data(), name.data() + name.size());
    ImGui::PopStyleColor();
    ImGui::TableNextColumn();
    wrappedText(help, palette::kDim);
}

int controls(Context& c, const std::string& search) {
    int shown = 0;
    for (const ControlInfo& control : controlsTable()) {
        if (!matches(search, {control.control, control.help})) continue;
        if (shown++ == 0) heading("Mouse and held keys");
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        cap(c, control.control, false);
        ImGui::TableNextColumn();
        ImGui::TableNextColumn();
        wrappedText(control.help, palette::kDim);
    }
    return shown;
}

int actions(Context& c, const std::string& search) {
    int shown = 0;
    std::string_view menu;
    for (const ActionInfo& action : actionsTable()) {
        if (!matches(search, {action.name, action.key, action.menu, action.help})) continue;
        ++shown;
        if (action.menu != menu) heading(menu = action.menu);
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        const std::string id = "##" + idOf(action);
        if (ImGui::Selectable(id.c_str(), false, ImGuiSelectableFlags_SpanAllColumns)) {
            c.act(action.action);
        }
        c.named("help:" + idOf(action));
        ImGui::SameLine(0, 0);
        cap(c, action.key);
        ImGui::TableNextColumn();
        describe(action.name, action.help);
    }
    return shown;
}

// Settings only answer a search: there they are what most people look for.
int settings(const std::string& search) {
    int shown = 0;
    if (search.empty()) return 0;
    for (const SettingInfo& setting : settingsTable()) {
        if (!matches(search, {setting.key, setting.label, setting.help})) continue;
        if (shown++ == 0) heading("Settings");
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        const std::string group(groupTitle(setting.group));
        ImGui::TextDisabled("%s", group.c_str());
        ImGui::TableNextColumn();
        describe(setting.label, setting.help);
    }
    return shown;
}

}  // namespace

void helpOverlay(Context& c) {
    Model& m = c.model;
    const bool appears = m.help && !c.state.helpWasOpen;
    c.state.helpWasOpen = m.help;
    if (!m.help) return;
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const ImVec2 size(std::min(c.px(700), display.x - c.px(24)),
                      std::min(c.px(560), display.y - c.px(80)));
    ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize(size);
    if (appears) ImGui::SetNextWindowFocus();
    ImGui::Begin("Help", &m.help,
                 ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                     ImGuiWindowFlags_NoSavedSettings);
    const ImVec2 at = ImGui::GetWindowPos();
    c.named("panel:help", {at.x, at.y, size.x, size.y});
    char buffer[128];
    std::snprintf(buffer, sizeof buffer, "%s", c.state.helpSearch.c_str());
    ImGui::SetNextItemWidth(-1);
    if (appears) ImGui::SetKeyboardFocusHere();
    if (ImGui::InputTextWithHint("##search", "search keys, actions and settings", buffer,
                                 sizeof buffer)) {
        c.state.helpSearch = buffer;
    }
    c.named("help.search");
    ImGui::Dummy({0, c.px(2)});
    if (ImGui::BeginTable("list", 3, ImGuiTableFlags_ScrollY, {0, 0})) {
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, c.px(160));
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, c.px(176));
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
        const std::string search = lowered(c.state.helpSearch);
        const int shown = controls(c, search) + actions(c, search) + settings(search);
        if (shown == 0) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::TextDisabled("nothing found");
        }
        ImGui::EndTable();
    }
    if (ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows) &&
        ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
        m.help = false;
    }
    ImGui::End();
}

void commandPalette(Context& c) {
    Model& m = c.model;
    PanelState::Palette& p = c.state.palette;
    constexpr const char* kId = "##commands";
    if (m.palette && !ImGui::IsPopupOpen(kId)) {
        p = {};
        ImGui::OpenPopup(kId);
    }
    const Rect& view = c.layout.picture;
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float width = std::min(c.px(460), display.x - c.px(24)), y = view.y + c.px(40);
    const float farthest = std::max(display.x - width - c.px(12), 0.0f);
    ImGui::SetNextWindowPos(
        {std::clamp(view.x + (view.width - width) / 2, std::min(c.px(12), farthest), farthest), y});
    ImGui::SetNextWindowSize({width, 0});
    if (!ImGui::BeginPopup(kId, ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings)) {
        m.palette = false;  // a click beside it closes it
        return;
    }
    const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    c.named("panel:commands", {at.x, at.y, size.x, size.y});
    ImGui::SetNextItemWidth(-1);
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    // With history arrows do not leave the text; they choose below.
    const bool entered = ImGui::InputTextWithHint(
        "##command", "part of a command's name", p.typed, sizeof p.typed,
        ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackHistory,
        [](ImGuiInputTextCallbackData*) { return 0; });
    c.named("commands.search");
    std::vector<const ActionInfo*> found;
    const std::string search = lowered(p.typed);
    for (const ActionInfo& action : actionsTable()) {
        if (matches(search, {action.name, action.menu, idOf(action)})) found.push_back(&action);
    }
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const int room =
        static_cast<int>((display.y - ImGui::GetCursorScreenPos().y - c.px(16)) / line);
    const int most = std::clamp(room, 1, 12);
    const int last = std::max(static_cast<int>(found.size()) - 1, 0);
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_DownArrow))) ++p.chosen;
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_UpArrow))) --p.chosen;
    p.chosen = std::clamp(p.chosen, 0, last);
    p.first = std::clamp(p.first, std::max(p.chosen - most + 1, 0), p.chosen);
    const ActionInfo* taken = nullptr;
    for (int i = p.first; i < std::min(p.first + most, last + 1) && !found.empty(); ++i) {
        const ActionInfo& action = *found[static_cast<std::size_t>(i)];
        ImGui::PushID(i);
        if (ImGui::Selectable("##entry", i == p.chosen)) taken = &action;
        c.named("command:" + idOf(action));
        tooltip(action.name, action.help);
        ImGui::SameLine(0, 0);
        text(c, action.name);
        if (!action.key.empty()) {
            ImGui::SameLine();
            rightText(c, action.key, palette::kDim);
        }
        ImGui::PopID();
    }
    if (found.empty()) ImGui::TextDisabled("nothing found");
    if (entered && !found.empty()) taken = found[static_cast<std::size_t>(p.chosen)];
    if (taken) c.act(taken->action);
    if (taken || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
        m.palette = false;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

}  // namespace mv::ui
