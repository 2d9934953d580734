// Where to begin: built-in scenes, files that were open lately, files that lie near, the tour.

#include <algorithm>
#include <cmath>
#include <string>

#include "ui/format.h"
#include "ui/panels.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

void open(Context& c, const std::string& file) {
    if (file != c.model.sceneName) c.requests.openFile = file;
    c.model.start = false;
}

// As many beside each other as have room for a picture.
void tiles(Context& c, float width) {
    const auto count = static_cast<int>(c.model.startTiles.size());
    if (count == 0) return;
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const int across = std::clamp(static_cast<int>((width + gap) / (c.px(110) + gap)), 1, count);
    const float wide = std::floor((width + gap) / static_cast<float>(across) - gap);
    const float tall = std::floor(wide * 9 / 16), line = ImGui::GetTextLineHeightWithSpacing();
    for (int i = 0; i < count; ++i) {
        const StartTile& tile = c.model.startTiles[static_cast<std::size_t>(i)];
        if (i % across > 0) ImGui::SameLine();
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::PushID(tile.scene.c_str());
        const bool chosen = ImGui::InvisibleButton("##tile", {wide, tall + line});
        c.named("start:" + tile.scene);
        const bool under = ImGui::IsItemHovered() || ImGui::IsItemFocused();
        ImGui::PopID();
        ImDrawList* draw = ImGui::GetWindowDrawList();
        const ImVec2 end(at.x + wide, at.y + tall);
        draw->AddRectFilled(at, end, palette::kFrame, c.px(3));
        if (tile.picture.texture) {
            draw->AddImageRounded(tile.picture.texture, at, end, {0, 0}, {1, 1}, IM_COL32_WHITE,
                                  c.px(3));
        }
        if (under) draw->AddRect(at, end, palette::kAccent, c.px(3), 0, c.px(2));
        const std::string name = tile.scene.substr(tile.scene.find(':') + 1);
        draw->AddText({at.x + c.px(2), end.y + c.px(3)}, under ? palette::kAccent : palette::kText,
                      name.c_str());
        if (chosen) open(c, tile.scene);
    }
}

void files(Context& c, const char* title, const char* name, const std::vector<std::string>& all,
           float width) {
    if (all.empty()) return;
    sectionTitle(c, title);
    for (std::size_t i = 0; i < all.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        ImGui::PushID(name);
        const std::string shown = escapedFormat(elidedFront(all[i], width - c.px(8)));
        if (ImGui::Selectable((shown + "##file").c_str())) open(c, all[i]);
        c.named(std::string("start:") + name + std::to_string(i));
        tooltip(all[i]);
        ImGui::PopID();
        ImGui::PopID();
    }
}

}  // namespace

void startPage(Context& c) {
    Model& m = c.model;
    if (!m.start || !m.error.empty() || m.browse != Browse::none) return;
    if (!beginDialog(c, "MegaViews", "start", 760, &m.start)) return;
    const float inner = ImGui::GetContentRegionAvail().x;
    wrappedText(
        "Lights a scene indirectly from thousands of views, each with a depth map of its own. "
        "Choose a scene, or drop a glTF file on the window.",
        palette::kDim);
    ImGui::Dummy({inner, c.px(2)});
    tiles(c, inner);
    std::vector<std::string> recent;
    for (const RecentFile& file : m.recent) {
        if (file.exists && !file.path.starts_with("builtin:")) recent.push_back(file.path);
    }
    recent.resize(std::min<std::size_t>(recent.size(), 6));
    files(c, "Open lately", "recent-", recent, inner);
    files(c, "Found near", "found-", m.startFound, inner);
    ImGui::Dummy({inner, c.px(4)});
    if (button(c, "start.open", "Open a file...")) {
        m.start = false;
        c.act(Action::open);
    }
    ImGui::SameLine();
    if (button(c, "start.tour", "Take the tour")) {
        m.start = false;
        c.act(Action::tour);
    }
    tooltip("The tour", "Five steps through the method, in this window.");
    ImGui::SameLine();
    const bool closed = button(c, "start.close", "Go on");
    tooltip("Go on", "With the scene that is there.");
    ImGui::SetItemDefaultFocus();
    if (closed || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) m.start = false;
    if (!m.start) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace mv::ui
