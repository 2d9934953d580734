// One pixel: what it shows, and for a picked one which views light it, how much, and which of them
// are in shadow.

#include <algorithm>
#include <string>
#include <vector>

#include "megaviews/core/colour.h"
#include "ui/format.h"
#include "ui/panels.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

void components(Context& c, const char* label, const Float3& v) {
    std::vector<std::string> values;
    for (const float x : v) values.push_back(numberText(static_cast<double>(x)));
    valueRow(c, label, values);
}

void place(Context& c, const PixelValues& p) {
    const float size = ImGui::GetTextLineHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRectFilled(
        at, {at.x + 2 * size, at.y + size}, IM_COL32(p.display[0], p.display[1], p.display[2], 255),
        c.px(2));
    ImGui::Dummy({2 * size, size});
    ImGui::SameLine();
    text(c, "x " + withThousands(static_cast<std::int64_t>(p.x)) + ", y " +
                withThousands(static_cast<std::int64_t>(p.y)));
}

std::string depthText(const PixelValues& p) {
    return p.surface ? "depth " + numberText(p.depth) + " world units" : "background";
}

void table(Context& c, const char* id, const PixelValues& p) {
    if (!beginValues(id, 3, 0.3f)) return;
    valueHeads(c, "W/(m\xc2\xb2 sr)", {"red", "green", "blue"});
    if (p.sides) {
        const auto& [left, right] = *p.sides;
        components(c, "left", left);
        components(c, "right", right);
        components(c, "right - left", {right[0] - left[0], right[1] - left[1], right[2] - left[2]});
    } else {
        components(c, "radiance", p.radiance);
    }
    if (p.surface) {
        components(c, "direct", p.direct);
        components(c, "indirect", p.indirect);
        components(c, "albedo 0..1", p.albedo);
        valueHeads(c, "", {"x", "y", "z"});
        components(c, "normal", p.normal);
        std::vector<std::string> position;
        for (const double x : p.position) position.push_back(numberText(x));
        valueRow(c, "position", position);
    }
    endValues();
}

// The displayed picture around a pixel, enlarged square by square.
void magnifier(Context& c, const PixelValues& p, float side) {
    const Picture& m = c.model.pixel.magnified;
    if (!m.texture || m.width <= 0 || m.height <= 0) return;
    const float one = c.state.magnification * c.scale, span = side / one;
    const float w = static_cast<float>(m.width), h = static_cast<float>(m.height);
    const float x = static_cast<float>(p.x) + 0.5f, y = static_cast<float>(p.y) + 0.5f;
    float v0 = (y - span / 2) / h, v1 = (y + span / 2) / h;
    if (m.bottomUp) {
        v0 = 1 - v0;
        v1 = 1 - v1;
    }
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Image(m.texture, {side, side}, {(x - span / 2) / w, v0}, {(x + span / 2) / w, v1});
    c.named("pixel.magnifier");
    const ImVec2 middle(at.x + side / 2, at.y + side / 2);
    ImGui::GetWindowDrawList()->AddRect({middle.x - one / 2, middle.y - one / 2},
                                        {middle.x + one / 2, middle.y + one / 2}, IM_COL32_WHITE);
    ImGui::SameLine();
}

// The pixel under the pointer beside its surroundings; all of its numbers while none is picked.
void underPointer(Context& c, const PixelValues& p) {
    sectionTitle(c, "Under the pointer");
    magnifier(c, p, c.px(84));
    ImGui::BeginGroup();
    place(c, p);
    text(c, shortText(static_cast<double>(p.radiance[0])) + ", " +
                shortText(static_cast<double>(p.radiance[1])) + ", " +
                shortText(static_cast<double>(p.radiance[2])));
    tooltip("Linear radiance", "Before exposure: red, green, blue.");
    text(c, depthText(p), palette::kDim);
    if (c.model.pixel.magnified.texture) {
        ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
        ImGui::SliderFloat("##magnification", &c.state.magnification, 2, 16, "%.0f x",
                           ImGuiSliderFlags_AlwaysClamp);
        c.named("pixel.magnification");
        tooltip("Magnifier", "Window pixels for each pixel of the picture.");
    }
    ImGui::EndGroup();
    if (!c.model.pixel.picked) table(c, "hover", p);
}

void picked(Context& c, const PixelValues& p) {
    sectionTitle(c, "Picked pixel");
    place(c, p);
    ImGui::SameLine();
    rightText(c, depthText(p), palette::kDim);
    table(c, "picked", p);
}

void totals(Context& c, const std::vector<GatheredView>& all) {
    Float3 visible{};
    std::uint64_t lit = 0;
    for (const GatheredView& g : all) {
        if (!g.visible) continue;
        ++lit;
        for (std::size_t i = 0; i < 3; ++i) visible[i] += g.contribution[i];
    }
    if (!beginValues("totals", 1, 0.4f)) return;
    valueRow(c, "sampled", {withThousands(std::uint64_t{all.size()}) + " views"});
    valueRow(c, "visible, in shadow",
             {withThousands(lit) + ", " + withThousands(std::uint64_t{all.size()} - lit)});
    valueRow(c, "sum of the visible",
             {numberText(static_cast<double>(visible[0])) + ", " +
              numberText(static_cast<double>(visible[1])) + ", " +
              numberText(static_cast<double>(visible[2]))});
    endValues();
}

// top: the largest contribution, whose bar is as wide as its column.
void gatheredRow(Context& c, const GatheredView& g, int row, double top) {
    const ImU32 colour = g.visible ? palette::kText : palette::kDim;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const std::string slot = withThousands(g.slot);
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    if (ImGui::Selectable((slot + "##" + std::to_string(row)).c_str(),
                          g.slot == c.settings.inspect.pickA,
                          ImGuiSelectableFlags_SpanAllColumns)) {
        c.settings.inspect.pickA = g.slot;
    }
    ImGui::PopStyleColor();
    c.named("gathered:" + std::to_string(g.slot));
    tooltip("View " + slot, "A click makes it the picked view.");
    ImGui::TableNextColumn();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const double value = luminanceOf(g.contribution);
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::GetWindowDrawList()->AddRectFilled(
        {at.x, at.y + ImGui::GetTextLineHeight() - c.px(2)},
        {at.x + width * static_cast<float>(std::clamp(value / top, 0.0, 1.0)),
         at.y + ImGui::GetTextLineHeight()},
        g.visible ? palette::kAccent : palette::kFaint);
    rightText(c, numberText(value), colour);
    ImGui::TableNextColumn();
    rightText(c, numberText(g.distance), colour);
    ImGui::TableNextColumn();
    rightText(c, g.visible ? "visible" : "in shadow", colour);
}

void gathered(Context& c) {
    const std::vector<GatheredView>& all = c.model.pixel.gathered;
    sectionTitle(c, "Gathered views");
    if (all.empty()) {
        wrappedText("No view was gathered here.", palette::kDim);
        return;
    }
    std::vector<const GatheredView*> sorted;
    for (const GatheredView& g : all) sorted.push_back(&g);
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const GatheredView* a, const GatheredView* b) {
                         return luminanceOf(a->contribution) > luminanceOf(b->contribution);
                     });
    totals(c, all);
    wrappedText("Contributions in W/(m\xc2\xb2 sr), distances in world units.", palette::kDim);
    const double top = std::max(luminanceOf(sorted.front()->contribution), 1e-30);
    const float height = std::max(ImGui::GetContentRegionAvail().y - c.px(2), c.px(120));
    if (!ImGui::BeginTable(
            "gathered", 4,
            ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersOuter,
            {0, height})) {
        return;
    }
    ImGui::TableSetupScrollFreeze(0, 1);
    for (const float weight : {0.75f, 1.25f, 0.95f, 1.15f}) {
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch, weight);
    }
    valueHeads(c, "slot", {"contribution", "distance", "shadow"});
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(sorted.size()));
    while (clipper.Step()) {
        for (int row = clipper.DisplayStart; row < clipper.DisplayEnd; ++row) {
            gatheredRow(c, *sorted[static_cast<std::size_t>(row)], row, top);
        }
    }
    ImGui::EndTable();
}

}  // namespace

void pixelPanel(Context& c) {
    const PixelData& p = c.model.pixel;
    pickButton(c, Picking::pixel, "pixel.pick", "Pick a pixel", "click a pixel of the picture",
               ImGui::GetContentRegionAvail().x);
    if (p.hover) {
        underPointer(c, *p.hover);
    } else if (!p.picked) {
        wrappedText("Move over the picture to read a pixel; click to list what lights it.",
                    palette::kDim);
    }
    if (p.picked) {
        picked(c, *p.picked);
        gathered(c);
    }
}

}  // namespace mv::ui
