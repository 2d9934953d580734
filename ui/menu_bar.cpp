// The menus, made from the list of actions in its order.

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "megaviews/settings/actions.h"
#include "ui/panels.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

constexpr std::size_t kBookmarks = 9;

int bookmarkOf(Action action, Action first) {
    const int i = static_cast<int>(action) - static_cast<int>(first);
    return i >= 0 && i < static_cast<int>(kBookmarks) ? i : -1;
}

bool isOn(const Context& c, Action action) {
    const Model& m = c.model;
    switch (action) {
        case Action::playPause:
            return m.playing && m.animationS > 0;
        case Action::pauseRendering:
            return m.renderingPaused;
        case Action::toggleSplit:
            return c.settings.compare;
        case Action::hideUi:
            return m.hidden;
        case Action::fullScreen:
            return m.fullScreen;
        case Action::vsync:
            return m.vsync;
        case Action::help:
            return m.help;
        default:
            break;
    }
    if (m.instrument && action == actionOf(*m.instrument)) return true;
    const int stored = bookmarkOf(action, Action::storeBookmark1);
    return stored >= 0 && m.bookmarks[static_cast<std::size_t>(stored)];
}

bool isPossible(const Context& c, Action action) {
    if (action == Action::undo) return c.model.canUndo;
    if (action == Action::redo) return c.model.canRedo;
    if (action == Action::swapSides || action == Action::flipSides) return c.settings.compare;
    const int recalled = bookmarkOf(action, Action::recallBookmark1);
    return recalled < 0 || c.model.bookmarks[static_cast<std::size_t>(recalled)];
}

void openRecent(Context& c) {
    const bool any = !c.model.recent.empty();
    const bool open = ImGui::BeginMenu("Open Recent", any);
    c.named("menu:Open Recent");
    if (!open) return;
    const RecentFile* hovered = nullptr;
    for (std::size_t i = 0; i < c.model.recent.size(); ++i) {
        const RecentFile& file = c.model.recent[i];
        ImGui::PushID(static_cast<int>(i));
        const std::string shown = elidedFront(file.path, c.px(420));
        if (ImGui::MenuItem(shown.c_str(), nullptr, false, file.exists)) {
            c.requests.openFile = file.path;
        }
        c.named("recent:" + std::to_string(i));
        const bool says = !file.exists || shown != file.path;
        if (says && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) hovered = &file;
        ImGui::PopID();
    }
    ImGui::Separator();
    if (ImGui::MenuItem("Clear list")) c.requests.clearRecent = true;
    if (hovered) {
        tooltipBelowMenu(hovered->path, hovered->exists ? "" : "This file is not there any more.");
    }
    ImGui::EndMenu();
}

void builtinScenes(Context& c) {
    const bool open = ImGui::BeginMenu("Built-in Scenes", !c.model.builtinScenes.empty());
    c.named("menu:Scenes");
    if (!open) return;
    for (const std::string& scene : c.model.builtinScenes) {
        if (ImGui::MenuItem(scene.c_str(), nullptr, scene == c.model.sceneName)) {
            c.requests.openFile = scene;
        }
        c.named("open:" + scene);
    }
    ImGui::EndMenu();
}

void entry(Context& c, const ActionInfo& action) {
    const std::string name(action.name), key(action.key);
    const std::string label = action.action == Action::open || action.action == Action::loadState ||
                                      action.action == Action::saveState ||
                                      action.action == Action::saveScene ||
                                      action.action == Action::loadReference
                                  ? name + "..."
                                  : name;
    const std::string shortcut = key.empty() ? key : "    " + key;  // apart from the longest name
    if (ImGui::MenuItem(label.c_str(), shortcut.c_str(), isOn(c, action.action),
                        isPossible(c, action.action))) {
        c.act(action.action);
    }
    c.named(idOf(action));
    tooltip(action.help);
}

// A line before what begins another kind of entry.
bool beginsPart(Action action) {
    for (const Action a :
         {Action::loadState, Action::screenshotPng, Action::reloadShaders, Action::quit,
          Action::resetSettings, Action::presetFast, Action::pauseRendering, Action::toggleSplit,
          Action::recallBookmark1, Action::nextDebugView, Action::hideUi, Action::stepTraversal,
          Action::nextCamera}) {
        if (a == action) return true;
    }
    return false;
}

}  // namespace

void toggleMenuBar() {
    ImGuiContext& g = *ImGui::GetCurrentContext();
    ImGuiWindow* bar = ImGui::FindWindowByName("##MainMenuBar");
    if (!bar || !bar->WasActive || g.OpenPopupStack.Size > 0) return;
    if (g.NavWindow == bar) {
        ImGui::SetWindowFocus(nullptr);
        return;
    }
    ImGui::FocusWindow(bar);
    g.NavLayer = ImGuiNavLayer_Menu;
    ImGui::NavInitWindow(bar, true);
    g.NavDisableHighlight = false;
    g.NavDisableMouseHover = g.NavMousePosDirty = true;
}

void menuBar(Context& c) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        {c.px(kFramePaddingX), std::round(c.px(kFramePaddingY + 2))});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    const bool open = ImGui::BeginMainMenuBar();
    ImGui::PopStyleVar(2);
    if (!open) return;
    const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    c.named("panel:menu", {at.x, at.y, size.x, size.y});

    std::vector<std::string> menus;
    for (const ActionInfo& action : actionsTable()) {
        const std::string menu(action.menu);
        if (!menu.empty() && std::find(menus.begin(), menus.end(), menu) == menus.end()) {
            menus.push_back(menu);
        }
    }
    for (const std::string& menu : menus) {
        const bool shown = ImGui::BeginMenu(menu.c_str());
        c.named("menu:" + menu);
        if (!shown) continue;
        bool first = true;
        for (const ActionInfo& action : actionsTable()) {
            if (action.menu != menu) continue;
            if (!first && beginsPart(action.action)) ImGui::Separator();
            first = false;
            entry(c, action);
            if (action.action == Action::open) {
                openRecent(c);
                builtinScenes(c);
            }
        }
        ImGui::EndMenu();
    }
    ImGui::EndMainMenuBar();
}

}  // namespace mv::ui
