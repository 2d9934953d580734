// The views: how many there are, where paths ended, how many a leaf holds; two of them picked,
// their maps, and what they share [Kol19 fig. 1c].

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "megaviews/core/colour.h"
#include "ui/format.h"
#include "ui/panels.h"
#include "ui/setting_widget.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

std::string vectorText(const Float3& v, int decimals) {
    std::string out;
    for (const float x : v) {
        out += (out.empty() ? "" : ", ") + fixedText(static_cast<double>(x), decimals);
    }
    return out;
}

void counts(Context& c) {
    const FrameStatistics& s = c.statistics;
    if (!beginValues("counts", 1, 0.5f)) return;
    valueRow(c, "alive, asked for",
             {withThousands(s.viewsAlive) + ", " + withThousands(s.viewsRequested)});
    valueRow(c, "nodes, leaves", {withThousands(s.viewNodes) + ", " + withThousands(s.viewLeaves)});
    endValues();
}

void histogram(Context& c, const char* title, const char* id, const char* what, const char* one,
               const std::vector<std::uint64_t>& amounts, std::size_t first) {
    if (amounts.size() <= first) return;
    sectionTitle(c, title);
    const std::vector<double> values(amounts.begin() + static_cast<std::ptrdiff_t>(first),
                                     amounts.end());
    const ColumnSeries series[] = {{values, palette::kAccent}};
    const int under = columns(c, id, series, c.px(44));
    if (under >= 0) {
        const auto i = static_cast<std::size_t>(under);
        ImGui::SetTooltip("%s %s: %s %s", one, std::to_string(i + 1).c_str(),
                          withThousands(amounts[i + first]).c_str(), what);
    }
}

void pickRow(Context& c, const char* label, std::string_view key, Picking picking,
             const char* name) {
    std::optional<std::int64_t>& slot =
        picking == Picking::viewA ? c.settings.inspect.pickA : c.settings.inspect.pickB;
    ImGui::AlignTextToFramePadding();
    text(c, label, picking == Picking::viewA ? palette::kViewA : palette::kViewB);
    ImGui::SameLine(c.px(56));
    const float pick = c.px(118), clear = ImGui::GetFrameHeight(), gap = c.px(4);
    settingField(c, key, ImGui::GetContentRegionAvail().x - pick - clear - 2 * gap);
    ImGui::SameLine(0, gap);
    pickButton(c, picking, name, "Pick in scene", "click a view", pick);
    tooltip("Pick in scene",
            "The next click on the picture takes the view there. While this panel is open a click "
            "takes view A and Shift+click view B.");
    ImGui::SameLine(0, gap);
    if (iconButton(c, std::string(name) + ".clear", Icon::close, clear, "None")) slot.reset();
}

// The view that shares most with A is likely the one nearest to it.
void nearestToA(Context& c) {
    const ViewsData& v = c.model.views;
    if (!v.a) return;
    if (!button(c, "views.nearest", "Take the view nearest to A as B",
                ImGui::GetContentRegionAvail().x)) {
        return;
    }
    float nearest = 1e30f;
    for (const ViewRow& row : v.rows) {
        if (row.slot == v.a->view.slot) continue;
        float squared = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const float d = row.position[i] - v.a->view.position[i];
            squared += d * d;
        }
        if (squared < nearest) {
            nearest = squared;
            c.settings.inspect.pickB = row.slot;
        }
    }
}

void list(Context& c) {
    const ViewsData& v = c.model.views;
    if (!v.rows.empty()) c.figure(withThousands(v.total), {"/panel/withMaps"});
    const std::string count = withThousands(std::uint64_t{v.rows.size()});
    rightText(c,
              v.total > v.rows.size() ? "first " + count + " of " + withThousands(v.total)
                                      : count + " views",
              palette::kDim);
    if (!ImGui::BeginTable(
            "views", 5,
            ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersOuter,
            {0, c.px(128)})) {
        return;
    }
    ImGui::TableSetupScrollFreeze(0, 1);
    for (const float weight : {0.9f, 1.05f, 0.8f, 1.1f, 0.95f}) {
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch, weight);
    }
    valueHeads(c, "slot", {"bounce", "leaf", "flux, W", "pick"});
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(v.rows.size()));
    while (clipper.Step()) {
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const ViewRow& row = v.rows[static_cast<std::size_t>(i)];
            const ImU32 colour = row.slot == c.settings.inspect.pickA   ? palette::kViewA
                                 : row.slot == c.settings.inspect.pickB ? palette::kViewB
                                                                        : palette::kText;
            ImGui::PushID(static_cast<int>(row.slot));
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            rightText(c, withThousands(row.slot), colour);
            ImGui::TableNextColumn();
            rightText(c, row.bounce > 0 ? std::to_string(row.bounce) : "-", colour);
            ImGui::TableNextColumn();
            rightText(c, row.leaf >= 0 ? withThousands(row.leaf) : "-", colour);
            ImGui::TableNextColumn();
            rightText(c, numberText(luminanceOf(row.flux)), colour);
            ImGui::TableNextColumn();
            const std::string slot = std::to_string(row.slot);
            ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {c.px(5), 0});
            if (button(c, "views.a:" + slot, "A")) c.settings.inspect.pickA = row.slot;
            ImGui::SameLine(0, c.px(3));
            if (button(c, "views.b:" + slot, "B")) c.settings.inspect.pickB = row.slot;
            ImGui::PopStyleVar();
            ImGui::PopID();
        }
    }
    ImGui::EndTable();
}

// The texel under the pointer, if the last item is the picture of a map: what it says is known a
// frame later.
void texelTooltip(Context& c, const Picture& p, MapPlace place) {
    if (!ImGui::IsItemHovered()) return;
    const ImVec2 low = ImGui::GetItemRectMin(), size = ImGui::GetItemRectSize();
    const ImVec2 mouse = ImGui::GetMousePos();
    const auto along = [](float at, float whole, int count) {
        return std::clamp(static_cast<int>(at / whole * static_cast<float>(count)), 0, count - 1);
    };
    place.x = along(mouse.x - low.x, size.x, p.width);
    place.y = along(mouse.y - low.y, size.y, p.height);
    ViewsData& v = c.model.views;
    v.hovered = place;
    const float w = size.x / static_cast<float>(p.width), h = size.y / static_cast<float>(p.height);
    const ImVec2 texel(low.x + static_cast<float>(place.x) * w,
                       low.y + static_cast<float>(place.y) * h);
    ImGui::GetWindowDrawList()->AddRect(texel, {texel.x + w, texel.y + h}, IM_COL32_WHITE);
    if (!v.texel || v.texel->place != place) return;
    const int face = p.width / 2;
    tooltip(v.texel->face + " face, texel " + std::to_string(place.x % face) + ", " +
                std::to_string(p.height - 1 - place.y),
            "toward " + vectorText(v.texel->direction, 3) + "\n" + v.texel->content);
}

void mapOf(Context& c, bool ofA, float width) {
    const PickedView& picked = ofA ? *c.model.views.a : *c.model.views.b;
    int& chosen = ofA ? c.state.mapOfA : c.state.mapOfB;
    const char* id = ofA ? "##map-a" : "##map-b";
    if (picked.maps.empty()) return;
    chosen = std::clamp(chosen, 0, static_cast<int>(picked.maps.size()) - 1);
    const MapPicture& map = picked.maps[static_cast<std::size_t>(chosen)];
    if (beginCombo(c, id, map.name, width)) {
        for (int i = 0; i < static_cast<int>(picked.maps.size()); ++i) {
            const std::string& name = picked.maps[static_cast<std::size_t>(i)].name;
            if (ImGui::Selectable(name.c_str(), i == chosen)) chosen = i;
        }
        ImGui::EndCombo();
    }
    c.named(id + 2);
    tooltip(map.name, "Which map: the fused one that is gathered from, or an ancestor's own.");
    const Picture& p = map.picture;
    const float aspect =
        p.width > 0 ? static_cast<float>(p.height) / static_cast<float>(p.width) : 0.5f;
    picture(p, {width, std::round(width * aspect)});
    c.named(std::string(id + 2) + ".picture");
    if (p.width > 0 && p.height > 0) {
        texelTooltip(c, p, {ofA, chosen, 0, 0});
    }
}

void pickedViews(Context& c) {
    const ViewsData& v = c.model.views;
    for (const auto& [picked, slot] :
         {std::pair{&v.a, c.settings.inspect.pickA}, std::pair{&v.b, c.settings.inspect.pickB}}) {
        if (*picked || !slot) continue;
        wrappedText("Slot " + withThousands(*slot) + " holds no view that has a map.",
                    palette::kNotice);
    }
    if (!v.a || !v.b) {
        wrappedText(!v.a ? "Click a view in the picture, then Shift+click a second one: what both "
                           "see is rendered once where they are alike."
                         : "Shift+click a second view in the picture, or take the nearest one.",
                    palette::kDim);
    }
    if (!v.a && !v.b) return;
    const bool both = v.a && v.b;
    sectionTitle(c, both ? "Picked views" : "Picked view");
    if (beginValues("picked", both ? 2 : 1, 0.2f)) {
        const auto row = [&](const char* label, auto&& value) {
            std::vector<std::string> values;
            for (const auto* picked : {&v.a, &v.b}) {
                if (*picked) values.push_back(value(**picked));
            }
            valueRow(c, label, values);
        };
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        for (const bool isA : {true, false}) {
            if (!(isA ? v.a : v.b)) continue;
            ImGui::TableNextColumn();
            rightText(c, isA ? "View A" : "View B", isA ? palette::kViewA : palette::kViewB);
        }
        row("slot", [](const PickedView& p) { return withThousands(p.view.slot); });
        row("bounce", [](const PickedView& p) {
            return p.view.bounce > 0 ? std::to_string(p.view.bounce) : std::string("-");
        });
        row("leaf", [](const PickedView& p) {
            return withThousands(p.view.leaf) + ", " + withThousands(p.viewsInLeaf) +
                   (p.viewsInLeaf == 1 ? " view" : " views");
        });
        row("flux",
            [](const PickedView& p) { return numberText(luminanceOf(p.view.flux)) + " W"; });
        const int decimals = c.layout.dock.width < c.px(380) ? 2 : 3;
        row("at", [&](const PickedView& p) { return vectorText(p.view.position, decimals); });
        row("normal", [](const PickedView& p) { return vectorText(p.view.normal, 2); });
        endValues();
    }
    wrappedText("Positions in root edges, flux as luminance.", palette::kDim);
    if (!makesMaps(c.settings.side[0].method)) {
        wrappedText("This method makes no maps.", palette::kDim);
        return;
    }
    if (testsPairs(c.settings.side[0].method)) settingRow(c, "map-colours");
    const std::optional<MapPlace> before = std::exchange(c.model.views.hovered, std::nullopt);
    const float gap = c.px(6), whole = ImGui::GetContentRegionAvail().x;
    const float width = both ? std::floor((whole - gap) / 2) : whole;
    if (v.a) {
        ImGui::BeginGroup();
        mapOf(c, true, width);
        ImGui::EndGroup();
    }
    if (both) ImGui::SameLine(0, gap);
    if (v.b) {
        ImGui::BeginGroup();
        mapOf(c, false, width);
        ImGui::EndGroup();
    }
    c.requests.redraw |= v.hovered && v.hovered != before;
    if (!v.mapLegend.entries.empty() || !v.mapLegend.scale.empty()) {
        ImGui::Dummy({0, c.px(2)});
        legend(c, v.mapLegend, whole);
    }
}

void shared(Context& c) {
    const ViewsData& v = c.model.views;
    if (!v.a || !v.b || v.shared.empty() || !makesMaps(c.settings.side[0].method)) return;
    sectionTitle(c, "What they share");
    std::uint64_t common = 0, pairsA = 0, pairsB = 0, texelsA = 0, texelsB = 0, texelsCommonA = 0,
                  texelsCommonB = 0;
    for (const SharedLevel& level : v.shared) {
        common += level.common ? level.pairsA : 0;
        pairsA += level.pairsA;
        pairsB += level.pairsB;
        texelsA += level.texelsA;
        texelsB += level.texelsB;
        texelsCommonA += level.common ? level.texelsA : 0;
        texelsCommonB += level.common ? level.texelsB : 0;
    }
    if (beginValues("shares", 2, 0.44f)) {
        valueHeads(c, "of each one's", {"A", "B"});
        valueRow(c, "rendered pairs", {shareText(common, pairsA), shareText(common, pairsB)});
        valueRow(c, "texels",
                 {shareText(texelsCommonA, texelsA), shareText(texelsCommonB, texelsB)});
        endValues();
    }
    if (!beginValues("levels", 4, 0.3f)) return;
    valueHeads(c, "view level", {"views", "pairs A", "pairs B", "texels"});
    for (const SharedLevel& level : v.shared) {
        valueRow(c, std::to_string(level.level) + (level.common ? " common" : " own"),
                 {withThousands(level.viewsOfNode), withThousands(level.pairsA),
                  withThousands(level.pairsB), withThousands(level.texelsA)},
                 level.common ? palette::kText : palette::kDim);
    }
    endValues();
}

}  // namespace

void viewsPanel(Context& c) {
    const ViewsData& v = c.model.views;
    counts(c);
    ImGui::Dummy({0, c.px(3)});
    pickRow(c, "View A", "pick-a", Picking::viewA, "views.pick-a");
    pickRow(c, "View B", "pick-b", Picking::viewB, "views.pick-b");
    nearestToA(c);
    if (c.settings.inspect.pickA && c.settings.inspect.pickB) {
        const bool on = c.settings.picture.view == DebugView::shared;
        if (toggleButton(c, "views.show-shared", "Show what they share in the picture", on,
                         ImGui::GetContentRegionAvail().x)) {
            c.settings.picture.view = on ? DebugView::final : DebugView::shared;
        }
    }
    pickedViews(c);
    shared(c);
    sectionTitle(c, "Views that have maps");
    settingRow(c, "show-views");
    list(c);
    histogram(c, "By bounce", "##bounces", "views", "bounce", v.perBounce, 0);
    histogram(c, "Leaves by the views they hold", "##leaves", "leaves", "views", v.leavesByViews,
              1);
}

}  // namespace mv::ui
