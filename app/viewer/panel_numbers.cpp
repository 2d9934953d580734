#include "app/viewer/panel_numbers.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "megaviews/core/text.h"

namespace mv {
namespace {

using Json = nlohmann::ordered_json;

Json errorTable(const ui::ErrorTable& table) {
    Json values;
    for (const ui::ErrorValue& error : table.values) {
        const bool finite = error.value && std::isfinite(*error.value);
        values[error.label] = finite ? Json(*error.value) : Json();
    }
    return {{"of", table.of}, {"against", table.against}, {"values", values}};
}

Json pickedView(const std::optional<ui::PickedView>& picked) {
    if (!picked) return {};
    const ui::ViewRow& v = picked->view;
    return {{"slot", v.slot},
            {"bounce", v.bounce},
            {"leaf", v.leaf},
            {"position", v.position},
            {"normal", v.normal},
            {"flux", v.flux},
            {"viewsInLeaf", picked->viewsInLeaf}};
}

Json viewsNumbers(const ui::ViewsData& views) {
    Json shared = Json::array();
    for (const ui::SharedLevel& level : views.shared) {
        shared.push_back({{"level", level.level},
                          {"common", level.common},
                          {"views", level.viewsOfNode},
                          {"pairs", {level.pairsA, level.pairsB}},
                          {"texels", {level.texelsA, level.texelsB}}});
    }
    return {{"name", "views"},
            {"withMaps", views.total},
            {"perBounce", views.perBounce},
            {"leavesByViews", views.leavesByViews},
            {"a", pickedView(views.a)},
            {"b", pickedView(views.b)},
            {"shared", shared}};
}

Json pixelValues(const std::optional<ui::PixelValues>& pixel) {
    if (!pixel) return {};
    Json out = {{"x", pixel->x},
                {"y", pixel->y},
                {"radiance", pixel->radiance},
                {"direct", pixel->direct},
                {"indirect", pixel->indirect}};
    if (pixel->sides) out["sides"] = *pixel->sides;
    if (!pixel->surface) return out;
    out["albedo"] = pixel->albedo;
    out["normal"] = pixel->normal;
    out["depth"] = pixel->depth;
    out["position"] = pixel->position;
    return out;
}

Json pixelNumbers(const ui::PixelData& pixel) {
    Json gathered = Json::array();
    for (const ui::GatheredView& view : pixel.gathered) {
        gathered.push_back({{"slot", view.slot},
                            {"contribution", view.contribution},
                            {"distance", view.distance},
                            {"visible", view.visible}});
    }
    return {{"name", "pixel"},
            {"hover", pixelValues(pixel.hover)},
            {"picked", pixelValues(pixel.picked)},
            {"gathered", gathered}};
}

Json stepsNumbers(const ui::StepsData& steps) {
    Json decisions;
    for (const ui::LegendEntry& entry : steps.decisions) {
        decisions[entry.label] = entry.count.value_or(0);
    }
    Json out = {{"name", "steps"},        {"step", steps.shown},  {"pairs", steps.pairs},
                {"decisions", decisions}, {"drawn", steps.drawn}, {"links", steps.links},
                {"ends", steps.finished}};
    if (steps.picked) {
        const ui::PickedPair& pair = *steps.picked;
        Json comparisons = Json::array();
        for (const auto& [what, values] : pair.comparisons) {
            comparisons.push_back({{"what", what}, {"values", values}});
        }
        out["picked"] = {{"scene", pair.scene},
                         {"view", pair.view},
                         {"decision", pair.decision},
                         {"reason", pair.reason},
                         {"comparisons", comparisons}};
    }
    return out;
}

}  // namespace

Json errorNumbers(const ui::ErrorsData& errors) {
    Json out = Json::array();
    for (const auto* tables : {&errors.tables, &errors.maps}) {
        for (const ui::ErrorTable& table : *tables) out.push_back(errorTable(table));
    }
    return out;
}

Json panelNumbers(const ui::Model& model) {
    if (!model.instrument) return {};
    switch (*model.instrument) {
        case ui::Instrument::views:
            return viewsNumbers(model.views);
        case ui::Instrument::pixel:
            return pixelNumbers(model.pixel);
        case ui::Instrument::steps:
            return stepsNumbers(model.steps);
        default:
            return {};  // of the frame, or of the errors
    }
}

std::string toCsv(const Json& json) {
    std::string csv = "place,value\n";
    const Json flat = json.flatten();
    for (const auto& [place, value] : flat.items()) {
        csv += csvQuoted(place) + ',';
        if (value.is_string()) {
            csv += csvQuoted(value.get<std::string>());
        } else if (value.is_primitive() && !value.is_null()) {
            csv += value.dump();
        }
        csv += '\n';
    }
    return csv;
}

}  // namespace mv
