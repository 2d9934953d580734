#include "ui/interface.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "megaviews/settings/actions.h"
#include "megaviews/settings/settings_table.h"
#include "ui/setting_widget.h"
#include "ui/statistics_panel.h"

namespace mv::ui {
namespace {

constexpr float kPanelWidth = 340;  // at scale 1, window pixels
constexpr float kStatusHeight = 26;
constexpr float kMenuHeight = 24;
constexpr ImU32 kSplitColour = IM_COL32(255, 255, 255, 200);
constexpr ImU32 kNoticeColour = IM_COL32(255, 214, 102, 255);

void menuBar(Requests& requests, float width) {
    // Menus and their entries come from the list of actions, in its order.
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({width, 0});
    if (!ImGui::BeginMainMenuBar()) return;
    std::vector<std::string> menus;
    for (const ActionInfo& action : actionsTable()) {
        const std::string menu(action.menu);
        if (!menu.empty() && std::find(menus.begin(), menus.end(), menu) == menus.end()) {
            menus.push_back(menu);
        }
    }
    for (const std::string& menu : menus) {
        if (!ImGui::BeginMenu(menu.c_str())) continue;
        for (const ActionInfo& action : actionsTable()) {
            if (action.menu != menu) continue;
            const std::string name(action.name), key(action.key);
            if (ImGui::MenuItem(name.c_str(), key.c_str())) {
                requests.actions.push_back(action.action);
            }
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(action.help).c_str());
        }
        ImGui::EndMenu();
    }
    ImGui::EndMainMenuBar();
}

void transport(Model& model, Requests& requests) {
    const float width = ImGui::CalcItemWidth();
    if (ImGui::Button(model.playing ? "Pause" : "Play", {ImGui::GetFontSize() * 4, 0})) {
        requests.actions.push_back(Action::playPause);
    }
    ImGui::SameLine();
    ImGui::SetNextItemWidth(width - ImGui::GetFontSize() * 4 - ImGui::GetStyle().ItemSpacing.x);
    if (model.animationS <= 0) {
        ImGui::TextDisabled("nothing moves in this scene");
        return;
    }
    float time = static_cast<float>(model.timeS);
    if (ImGui::SliderFloat("time", &time, 0, static_cast<float>(model.animationS), "%.2f s",
                           ImGuiSliderFlags_AlwaysClamp)) {
        model.timeS = static_cast<double>(time);
        requests.timeChanged = true;
    }
}

void cameraChoice(Settings& settings, const Model& model) {
    const char* shown = settings.camera.empty() ? "free or default" : settings.camera.c_str();
    if (!ImGui::BeginCombo("camera", shown)) return;
    for (const std::string& name : model.cameras) {
        if (ImGui::Selectable(name.c_str(), name == settings.camera)) settings.camera = name;
    }
    ImGui::EndCombo();
}

void mainControls(Settings& settings, Model& model, Requests& requests) {
    ImGui::PushItemWidth(ImGui::GetFontSize() * 11);
    transport(model, requests);
    for (const char* key : {"method", "compare", "traversal", "rules"})
        settingWidget(settings, key);
    for (const char* key : {"vpls", "particles", "bounces", "gather-samples"}) {
        settingWidget(settings, key);
    }
    if (model.cameras.size() > 1) cameraChoice(settings, model);
    ImGui::Spacing();

    // Every other setting, grouped as in the table.
    static constexpr SettingGroup kGroups[] = {SettingGroup::method, SettingGroup::views,
                                               SettingGroup::gather, SettingGroup::picture,
                                               SettingGroup::scene};
    static constexpr std::string_view kShownAbove[] = {
        "method",     "compare",         "traversal",      "rules",     "vpls",
        "particles",  "bounces",         "gather-samples", "camera",    "time",
        "resolution", "camera-position", "camera-target",  "camera-up", "animation",
        "gpu-memory", "queue-memory"};
    for (const SettingGroup group : kGroups) {
        const std::string title(groupTitle(group));
        if (!ImGui::CollapsingHeader(title.c_str())) continue;
        for (const SettingInfo& setting : settingsTable()) {
            const bool above = std::find(std::begin(kShownAbove), std::end(kShownAbove),
                                         setting.key) != std::end(kShownAbove);
            if (setting.group == group && !above) settingWidget(settings, setting);
        }
    }
    ImGui::PopItemWidth();
}

double methodMs(const MethodStatistics& method) {
    double sum = 0;
    for (const StageTime& stage : method.stages) sum += stage.ms;
    return sum;
}

// Labels on each side of the split and the split itself, which the mouse can drag.
void splitOverlay(Settings& settings, const FrameStatistics& statistics, const Viewport& view) {
    if (!settings.compare || statistics.methods.size() < 2) return;
    ImDrawList* draw = ImGui::GetBackgroundDrawList();
    const float left = static_cast<float>(view.x), top = static_cast<float>(view.y);
    const float width = static_cast<float>(view.width), height = static_cast<float>(view.height);
    const float x = left + width * static_cast<float>(settings.split);
    draw->AddLine({x, top}, {x, top + height}, kSplitColour, 2);

    const Method methods[2] = {settings.method, *settings.compare};
    for (std::size_t side = 0; side < 2; ++side) {
        const MethodStatistics& m = statistics.methods[side];
        char text[160];
        std::snprintf(text, sizeof text, "%s\n%.1f ms\n%s pairs\n%s", methodTitle(methods[side]),
                      methodMs(m), withThousands(m.pairs.processed).c_str(),
                      bytesText(m.queueBytes + m.mapBytes).c_str());
        const ImVec2 size = ImGui::CalcTextSize(text);
        const ImVec2 at =
            side == 0 ? ImVec2(left + 12, top + 12) : ImVec2(left + width - size.x - 12, top + 12);
        draw->AddRectFilled({at.x - 6, at.y - 4}, {at.x + size.x + 6, at.y + size.y + 4},
                            IM_COL32(0, 0, 0, 140), 4);
        draw->AddText(at, IM_COL32_WHITE, text);
    }

    // The handle is a thin window of its own, so that dragging it does not turn the camera.
    const float handle = ImGui::GetFontSize();
    ImGui::SetNextWindowPos({x - handle / 2, top + height / 2 - 1.5f * handle});
    ImGui::SetNextWindowSize({handle, 3 * handle});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::Begin("##split", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::Button("||", {handle, 3 * handle});
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("drag to move the split");
    if (ImGui::IsItemActive() && width > 0) {
        settings.split = std::clamp(
            (static_cast<double>(ImGui::GetIO().MousePos.x) - static_cast<double>(left)) /
                static_cast<double>(width),
            0.0, 1.0);
    }
    ImGui::End();
    ImGui::PopStyleVar(2);
}

void statusBar(const Model& model, int windowWidth, int windowHeight, float scale) {
    const float height = kStatusHeight * scale;
    ImGui::SetNextWindowPos({0, static_cast<float>(windowHeight) - height});
    ImGui::SetNextWindowSize({static_cast<float>(windowWidth), height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8 * scale, 5 * scale});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::Begin("##status", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoInputs |
                     ImGuiWindowFlags_NoNav);
    ImGui::Text("%s  |  %s  |  %5.1f frames/s", model.sceneName.c_str(), model.sceneSummary.c_str(),
                model.framesPerSecond);
    for (const std::string& notice : model.notices) {
        ImGui::SameLine();
        ImGui::PushStyleColor(ImGuiCol_Text, kNoticeColour);
        ImGui::Text("|  %s", notice.c_str());
        ImGui::PopStyleColor();
    }
    ImGui::End();
    ImGui::PopStyleVar(3);
}

void loadingOverlay(const Model& model, const Viewport& view) {
    if (model.loadingStage.empty()) return;
    const float width = ImGui::GetFontSize() * 26;
    ImGui::SetNextWindowPos({static_cast<float>(view.x) + static_cast<float>(view.width) / 2,
                             static_cast<float>(view.y) + static_cast<float>(view.height) / 2},
                            ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({width, 0});
    ImGui::Begin("Loading", nullptr,
                 ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings);
    ImGui::TextUnformatted(model.loadingStage.c_str());
    ImGui::ProgressBar(model.loadingFraction, {-1, 0});
    ImGui::End();
}

void errorDialog(const Model& model, Requests& requests) {
    if (model.error.empty()) return;
    ImGui::OpenPopup("Something went wrong");
    const ImVec2 center(ImGui::GetIO().DisplaySize.x / 2, ImGui::GetIO().DisplaySize.y / 2);
    ImGui::SetNextWindowPos(center, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({ImGui::GetFontSize() * 34, 0});
    if (ImGui::BeginPopupModal("Something went wrong", nullptr,
                               ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoSavedSettings)) {
        ImGui::TextWrapped("%s", model.error.c_str());
        ImGui::Spacing();
        if (ImGui::Button("Copy")) ImGui::SetClipboardText(model.error.c_str());
        ImGui::SameLine();
        if (ImGui::Button("Close") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
            requests.errorDismissed = true;
            ImGui::CloseCurrentPopup();
        }
        ImGui::EndPopup();
    }
}

void helpOverlay(Model& model) {
    if (!model.help) return;
    ImGui::SetNextWindowSize({ImGui::GetFontSize() * 36, ImGui::GetFontSize() * 30},
                             ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Keys and mouse", &model.help, ImGuiWindowFlags_NoSavedSettings)) {
        if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_RowBg)) {
            ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed,
                                    ImGui::GetFontSize() * 10);
            const auto line = [](std::string_view key, std::string_view help) {
                ImGui::TableNextRow();
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(key.data(), key.data() + key.size());
                ImGui::TableNextColumn();
                ImGui::TextWrapped("%.*s", static_cast<int>(help.size()), help.data());
            };
            for (const ControlInfo& control : controlsTable()) line(control.control, control.help);
            for (const ActionInfo& action : actionsTable()) line(action.key, action.help);
            ImGui::EndTable();
        }
    }
    ImGui::End();
}

}  // namespace

void applyStyle(float scale) {
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowRounding = 4;
    style.FrameRounding = 3;
    style.GrabRounding = 3;
    style.WindowBorderSize = 0;
    style.FramePadding = {6, 3};
    style.ItemSpacing = {8, 4};
    style.Colors[ImGuiCol_WindowBg] = {0.11f, 0.12f, 0.14f, 0.97f};
    style.Colors[ImGuiCol_Header] = {0.20f, 0.25f, 0.33f, 1};
    style.Colors[ImGuiCol_FrameBg] = {0.18f, 0.20f, 0.24f, 1};
    style.Colors[ImGuiCol_TableRowBgAlt] = {1, 1, 1, 0.03f};
    style.ScaleAllSizes(scale);
    ImGui::GetStyle() = style;
    ImGui::GetIO().FontGlobalScale = scale;
}

Viewport pictureViewport(int windowWidth, int windowHeight, float scale, const Model& model) {
    if (model.hidden) return {0, 0, std::max(windowWidth, 1), std::max(windowHeight, 1)};
    const int top = static_cast<int>(std::lround(kMenuHeight * scale));
    const int panel = static_cast<int>(std::lround(kPanelWidth * scale));
    const int status = static_cast<int>(std::lround(kStatusHeight * scale));
    return {0, top, std::max(windowWidth - panel, 1), std::max(windowHeight - top - status, 1)};
}

struct Interface::State {
    std::vector<ItemRect> items;
};

Interface::Interface() : state_(std::make_unique<State>()) {}
Interface::~Interface() = default;
void Interface::addFrame(const FrameStatistics&) {}
void Interface::forgetFrames() {}
const std::vector<ItemRect>& Interface::itemRects() const { return state_->items; }
std::optional<ItemRect> Interface::findItem(std::string_view) const { return std::nullopt; }

Requests Interface::draw(Settings& settings, Model& model, const FrameStatistics& statistics,
                         int windowWidth, int windowHeight, float scale) {
    Requests requests;
    const Viewport view = pictureViewport(windowWidth, windowHeight, scale, model);
    if (!model.hidden) {
        menuBar(requests, static_cast<float>(windowWidth));
        const float panel = kPanelWidth * scale;
        const float top = kMenuHeight * scale, status = kStatusHeight * scale;
        ImGui::SetNextWindowPos({static_cast<float>(windowWidth) - panel, top});
        ImGui::SetNextWindowSize({panel, static_cast<float>(windowHeight) - top - status});
        ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
        ImGui::Begin("Settings", nullptr,
                     ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                         ImGuiWindowFlags_NoSavedSettings);
        mainControls(settings, model, requests);
        statisticsPanel(settings, statistics);
        ImGui::End();
        ImGui::PopStyleVar();
        statusBar(model, windowWidth, windowHeight, scale);
    }
    splitOverlay(settings, statistics, view);
    loadingOverlay(model, view);
    helpOverlay(model);
    errorDialog(model, requests);
    return requests;
}

}  // namespace mv::ui
