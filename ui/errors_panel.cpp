// How far one picture is from another, in numbers: the metrics of megaviews/metrics.

#include <cmath>
#include <string>

#include "ui/format.h"
#include "ui/panels.h"
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

void table(Context& c, const ErrorTable& errors, std::size_t index) {
    sectionTitle(c, errors.of.c_str());
    wrappedText("against " + errors.against, palette::kDim);
    if (!errors.reason.empty()) {
        wrappedText(errors.reason, palette::kNotice);
        return;
    }
    if (!beginValues(("errors" + std::to_string(index)).c_str(), 1, 0.5f)) return;
    for (const ErrorValue& value : errors.values) {
        valueRow(c, value.label, {valueText(value)}, value.value ? palette::kText : palette::kDim);
        tooltip(value.label,
                value.help + (value.higherIsBetter ? " Higher is better." : " Lower is better."));
    }
    endValues();
    if (errors.badPixels > 0) {
        wrappedText(withThousands(errors.badPixels) + " pixels are NaN or infinite and left out.",
                    palette::kTrouble);
    }
}

}  // namespace

void errorsPanel(Context& c) {
    const ErrorsData& data = c.model.errors;
    if (data.tables.empty()) {
        wrappedText(
            "Shows how far the right side is from the left, or either from a reference. Compare "
            "two methods, or start with --reference FILE.",
            palette::kDim);
        actionButton(c, Action::toggleSplit, "Compare");
        return;
    }
    wrappedText(
        data.waits ? "Measured once the picture is complete." : "Of the picture as it stands.",
        palette::kDim);
    for (std::size_t i = 0; i < data.tables.size(); ++i) table(c, data.tables[i], i);
}

}  // namespace mv::ui
