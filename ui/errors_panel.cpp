// How far one picture is from another, and the sides' depth maps from exact ones, in numbers: the
// metrics of megaviews/measure.

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "ui/format.h"
#include "ui/panels.h"
#include "ui/setting_widget.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

std::string valueText(const ErrorValue& value) {
    if (!value.value) return "...";
    if (std::isnan(*value.value)) return "-";
    if (std::isinf(*value.value)) return "equal";
    return numberText(*value.value) + (value.unit.empty() ? "" : " " + value.unit);
}

// Behind the last item, quiet: up where more is better.
void arrow(Context& c, bool up) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const float x = high.x + c.px(9), r = c.px(3.5f), side = up ? -1.0f : 1.0f;
    const float y = (low.y + high.y) / 2;
    ImGui::GetWindowDrawList()->AddTriangleFilled({x - r, y - side * r * 0.7f},
                                                  {x + r, y - side * r * 0.7f},
                                                  {x, y + side * r * 0.9f}, palette::kDim);
}

// The same values of one table or of several, a column each.
// place: where saved numbers have the first column's table.
void values(Context& c, const char* id, std::span<const ErrorTable* const> columns,
            std::size_t place) {
    const std::vector<ErrorValue>& first = columns.front()->values;
    if (!beginValues(id, static_cast<int>(columns.size()), 0.5f)) return;
    if (columns.size() == 2) valueHeads(c, "", {"Left", "Right"});
    for (std::size_t i = 0; i < first.size(); ++i) {
        std::vector<std::string> texts;
        for (const ErrorTable* column : columns) texts.push_back(valueText(column->values[i]));
        const ErrorValue& value = first[i];
        const ImU32 colour = value.value ? palette::kText : palette::kDim;
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        text(c, value.label, colour);
        c.named("errors:" + value.label);
        arrow(c, value.higherIsBetter);
        tooltip(value.label,
                value.help + (value.higherIsBetter ? " Higher is better." : " Lower is better."));
        for (std::size_t column = 0; column < texts.size(); ++column) {
            ImGui::TableNextColumn();
            rightText(c, texts[column], colour);
            c.figure(texts[column],
                     {"/errors/" + std::to_string(place + column) + "/values/" + value.label});
        }
    }
    endValues();
}

void leftOut(std::uint64_t count, const char* what) {
    if (count == 0) return;
    wrappedText(withThousands(count) + " " + what + " are NaN or infinite and left out.",
                palette::kTrouble);
}

void table(Context& c, const ErrorTable& errors, std::size_t index) {
    sectionTitle(c, errors.of.c_str());
    wrappedText("against " + errors.against, palette::kDim);
    if (!errors.reason.empty()) {
        wrappedText(errors.reason, palette::kNotice);
        return;
    }
    const ErrorTable* only = &errors;
    values(c, ("errors" + std::to_string(index)).c_str(), {&only, 1}, index);
    leftOut(errors.badPixels, "pixels");
}

void pictureErrors(Context& c) {
    const ErrorsData& data = c.model.errors;
    if (data.tables.empty()) {
        wrappedText(
            "Shows how far the right side is from the left, or either from a reference. Compare "
            "two methods, load a reference, or keep the left picture as one.",
            palette::kDim);
        actionButton(c, Action::toggleSplit, "Compare");
        return;
    }
    wrappedText(
        data.waits ? "Measured once the picture is complete." : "Of the picture as it stands.",
        palette::kDim);
    for (std::size_t i = 0; i < data.tables.size(); ++i) table(c, data.tables[i], i);
}

std::string viewsText(int count) {
    if (count == 0) return "none";
    return withThousands(std::int64_t{count}) + (count == 1 ? " view" : " views");
}

void mapChoice(Context& c) {
    ErrorsData& data = c.model.errors;
    rowLabel(c, "Exact maps of");
    if (beginCombo(c, "##map-views", viewsText(data.mapViews), rowFieldWidth())) {
        for (const int count : {0, 64, 256, 1024, 4096}) {
            if (ImGui::Selectable(viewsText(count).c_str(), count == data.mapViews)) {
                data.mapViews = count;
                data.mapsWait = true;
            }
            c.named("map-views=" + std::to_string(count));
        }
        ImGui::EndCombo();
    }
    c.named("map-views");
    tooltip("Exact maps",
            "Rays find the depths that so many of the views should see; the depth maps of each "
            "side are compared with them, texel by texel.");
}

void mapErrors(Context& c) {
    const ErrorsData& data = c.model.errors;
    sectionTitle(c, "Depth maps");
    mapChoice(c);
    std::vector<const ErrorTable*> columns;
    for (const ErrorTable& side : data.maps) {
        if (!side.reason.empty()) {
            wrappedText(side.reason, palette::kDim);
        } else if (data.mapViews > 0) {
            wrappedText(side.of + (side.against.empty() ? "" : ", " + side.against), palette::kDim);
            columns.push_back(&side);
        }
    }
    if (columns.empty()) return;
    if (data.mapsWait) {
        const std::string& stage = c.model.referenceStage;
        const int percent = static_cast<int>(100 * c.model.referenceFraction);
        wrappedText(stage.empty() || percent < 0 ? "Measured once nothing moves."
                                                 : stage + " " + std::to_string(percent) + " %",
                    palette::kNotice);
        if (button(c, "maps.cancel", "Cancel")) c.model.errors.mapViews = 0;
    }
    values(c, "maps", columns, data.tables.size());
    for (const ErrorTable* side : columns) leftOut(side->badPixels, "texels");
}

}  // namespace

void errorsPanel(Context& c) {
    pictureErrors(c);
    mapErrors(c);
}

}  // namespace mv::ui
