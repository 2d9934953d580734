#include "app/viewer/legends.h"

#include <spdlog/fmt/fmt.h>

#include <iterator>
#include <span>
#include <string>
#include <utility>

#include "shaders/shared/colour_map.glsl"

namespace mv {
namespace {

constexpr int kScaleColours = 64;  // of a legend's bar

// colourAt: from 0..1.
template <typename ColourAt>
std::vector<ui::Float3> sampled(const ColourAt& colourAt) {
    std::vector<ui::Float3> scale;
    for (int i = 0; i < kScaleColours; ++i) {
        const vec3 colour = colourAt(static_cast<float>(i) / (kScaleColours - 1));
        scale.push_back({colour.x, colour.y, colour.z});
    }
    return scale;
}

ui::LegendEntry entry(std::string label, std::uint32_t colour,
                      std::optional<std::uint64_t> count = {}) {
    return {std::move(label), displayColour(colour), count};
}

std::vector<ui::LegendEntry> entriesOf(std::span<const LegendEntry> classes) {
    std::vector<ui::LegendEntry> entries;
    for (const LegendEntry& c : classes) entries.push_back(entry(std::string(c.name), c.colour));
    return entries;
}

ui::Legend nodesLegend(std::string title, std::uint32_t colour, DrawnCount count) {
    ui::Legend legend;
    legend.title = std::move(title);
    legend.entries.push_back(
        entry(count.drawn < count.exist ? fmt::format("nodes (of {} drawn)", count.drawn) : "nodes",
              colour, count.exist));
    return legend;
}

}  // namespace

ui::Float3 displayColour(std::uint32_t rgba8) {
    const auto channel = [&](int shift) {
        return static_cast<float>(rgba8 >> shift & 255u) / 255.0f;
    };
    return {channel(0), channel(8), channel(16)};
}

std::vector<ui::Float3> scaleOf(ColourMap colours) {
    if (colours == ColourMap::grey) return sampled([](float t) { return vec3(t); });
    return sampled([](float t) { return viridis(t); });
}

std::optional<ui::Legend> debugViewLegend(DebugView view) {
    const DebugLegend& debug = legendOf(view);
    if (debug.kind == LegendKind::none) return std::nullopt;
    ui::Legend legend;
    legend.title = debug.title;
    legend.unit = debug.unit;
    legend.low = debug.low;
    legend.high = debug.high;
    legend.logarithmic = debug.logarithmic;
    if (debug.kind == LegendKind::scale) legend.scale = scaleOf(debug.colours);
    for (const LegendClass& c : debug.classes) {
        legend.entries.push_back({std::string(c.name), c.colour, std::nullopt});
    }
    return legend;
}

std::optional<ui::Legend> differenceLegend(Difference difference, double range) {
    ui::Legend legend;
    legend.unit = "W/(m² sr)";
    legend.high = range > 0 ? range : 1;
    legend.scale = scaleOf(ColourMap::viridis);
    switch (difference) {
        case Difference::off:
            return std::nullopt;
        case Difference::absolute:
            legend.title = "Absolute difference";
            break;
        case Difference::signedValue:
            legend.title = "Right minus left";
            legend.low = -legend.high;
            legend.scale = sampled([](float t) { return divergingColor(2 * t - 1); });
            break;
        case Difference::relative:
            legend.title = "Relative difference";
            legend.unit.clear();
            legend.scale = sampled([](float t) { return cividis(t); });
            break;
        case Difference::flip:
            legend.title = range > 0 ? "FLIP" : "FLIP, once complete";
            legend.unit.clear();
            break;
    }
    return legend;
}

ui::Legend gatheredLegend() {
    ui::Legend legend;
    legend.title = "Views gathered by the pixel";
    legend.entries = {entry("visible", kVisibleColour), entry("occluded", kOccludedColour)};
    return legend;
}

void appendOverlayLegends(const Settings& settings, const Overlay& overlay,
                          std::vector<ui::Legend>& legends) {
    const InspectSettings& inspect = settings.inspect;
    if (inspect.showOctree > 0) {
        legends.push_back(nodesLegend(fmt::format("Scene octree, level {}", inspect.showOctree),
                                      kSceneNodeColour, overlay.sceneNodes));
    }
    if (inspect.showViewOctree > 0) {
        legends.push_back(nodesLegend(fmt::format("View octree, level {}", inspect.showViewOctree),
                                      kViewNodeColour, overlay.viewNodes));
    }
    if (inspect.step > 0) {
        ui::Legend legend;
        legend.title = "Traversal step";
        legend.entries = entriesOf(decisionLegend());
        legend.entries.push_back(entry("view nodes", kViewNodeColour));
        if (inspect.pairScene && inspect.pairView) {
            legend.entries.push_back(entry("picked pair", kPickedPairColour));
        }
        legends.push_back(std::move(legend));
    }
    if (inspect.pickA && inspect.pickB && overlay.a.sortedView && overlay.b.sortedView) {
        ui::Legend legend;
        legend.title = "Pairs of the picked views";
        legend.entries = entriesOf(sharingLegend());
        const std::uint64_t counts[] = {overlay.pairsOfBoth, overlay.pairsOfAAlone,
                                        overlay.pairsOfBAlone};
        for (std::size_t i = 0; i < legend.entries.size() && i < std::size(counts); ++i) {
            legend.entries[i].count = counts[i];
        }
        legends.push_back(std::move(legend));
    }
}

}  // namespace mv
