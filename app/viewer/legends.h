#pragma once
// What the colours in and over the picture mean: debug views, differences, maps, lines.

#include <cstdint>
#include <optional>
#include <vector>

#include "megaviews/inspect/overlay.h"
#include "megaviews/settings/debug_legends.h"
#include "ui/model.h"

namespace mv {

// Lines from a pixel to the views that it gathers.
inline constexpr std::uint32_t kVisibleColour = kGreen, kOccludedColour = kVermilion;

ui::Float3 displayColour(std::uint32_t rgba8);
// The colours of a legend's bar.
std::vector<ui::Float3> scaleOf(ColourMap colours);

std::optional<ui::Legend> debugViewLegend(DebugView view);
// range: end of the colour scale in use; 0 until it is known.
std::optional<ui::Legend> differenceLegend(Difference difference, double range);
ui::Legend gatheredLegend();
// One for each kind of line that the settings ask for.
void appendOverlayLegends(const Settings& settings, const Overlay& overlay,
                          std::vector<ui::Legend>& legends);

}  // namespace mv
