#include "megaviews/settings/debug_legends.h"

namespace mv {
namespace {

constexpr std::array<float, 3> colourOf(unsigned rgb) {
    return {static_cast<float>(rgb >> 16 & 255) / 255, static_cast<float>(rgb >> 8 & 255) / 255,
            static_cast<float>(rgb & 255) / 255};
}

// Colours of Okabe and Ito [Color Universal Design, 2008], told apart by colour-blind eyes.
constexpr LegendClass kSharedClasses[] = {
    {"neither", colourOf(0x8C8C8C), "No pair shows this surface to either view."},
    {"A only", colourOf(0xE69F00), "Rendered for view A, culled for view B."},
    {"B only", colourOf(0x56B4E9), "Rendered for view B, culled for view A."},
    {"apart", colourOf(0xCC79A7), "Both views see it, each through a pair of its own."},
    {"shared", colourOf(0x009E73),
     "One pair renders it for both views; the brighter, the larger the scene node."},
};

constexpr DebugLegend kNoLegend;
constexpr DebugLegend kDepth{
    LegendKind::scale, "Depth", "root edges", ColourMap::grey, true, 0.01, 2, {}};
constexpr DebugLegend kCandidates{
    LegendKind::scale, "Views kept by culling", "of all", ColourMap::viridis, false, 0, 1, {}};
constexpr DebugLegend kUndecided{LegendKind::scale,
                                 "Views that maps are not sure of",
                                 "of those that could give light",
                                 ColourMap::viridis,
                                 false,
                                 0,
                                 1,
                                 {}};
constexpr DebugLegend kSharing{
    LegendKind::scale, "Views that share a pair", "views", ColourMap::viridis, true, 1, 256, {}};
constexpr DebugLegend kShared{
    LegendKind::classes, "Views A and B", "", ColourMap::viridis, false, 0, 1, kSharedClasses};

}  // namespace

const DebugLegend& legendOf(DebugView view) {
    switch (view) {
        case DebugView::depth:
            return kDepth;
        case DebugView::candidates:
            return kCandidates;
        case DebugView::undecided:
            return kUndecided;
        case DebugView::sharing:
            return kSharing;
        case DebugView::shared:
            return kShared;
        default:
            return kNoLegend;
    }
}

}  // namespace mv
