#pragma once
// What the colours of each debug view mean: end values of scales, and named classes. Shaders take
// their ranges and class colours from here, legends show them; neither knows the other.

#include <array>
#include <span>
#include <string_view>

#include "megaviews/settings/settings.h"

namespace mv {

enum class LegendKind { none, scale, classes };
enum class ColourMap { viridis, grey };  // shaders/shared/colour_map.glsl; grey: black to white

struct LegendClass {
    std::string_view name;
    std::array<float, 3> colour;  // display value, sRGB encoded, 0..1
    std::string_view help;        // one sentence
};

struct DebugLegend {
    LegendKind kind = LegendKind::none;
    std::string_view title = {};
    // Scales. Values of 0 or less mean that there is nothing to show, and are black.
    std::string_view unit = {};  // empty: a plain number
    ColourMap colours = ColourMap::viridis;
    bool logarithmic = false;
    double low = 0, high = 1;
    // Classes, in the order of their numbers.
    std::span<const LegendClass> classes = {};
};

const DebugLegend& legendOf(DebugView view);

// Classes of DebugView::shared.
enum class SharedClass { neither, onlyA, onlyB, apart, together };

}  // namespace mv
