#include "megaviews/settings/settings_rows.h"

namespace mv::rows {
namespace {

constexpr double kMaxSlot = 16777216, kMaxNode = 268435456;  // that can be named

int hiddenOutcomes(const Settings& s) {
    int hidden = 0;
    for (std::size_t i = 0; i < kOutcomeNames.size(); ++i) {
        if (s.inspect.stepHidden[i]) hidden |= 1 << i;
    }
    return hidden;
}
void hideOutcomes(Settings& s, int hidden) {
    for (std::size_t i = 0; i < kOutcomeNames.size(); ++i) {
        s.inspect.stepHidden[i] = (hidden >> i & 1) != 0;
    }
}

}  // namespace

std::vector<SettingInfo> ofInstruments() {
    using S = Settings;
    return {
        {.key = "show-octree",
         .label = "Scene octree",
         .field = field(&S::inspect, &InspectSettings::showOctree),
         .minimum = 0,
         .maximum = 11,
         .unit = "level",
         .atLowest = "none",
         .help = "Draws the scene octree's nodes of a level, 1 is the root; 0 for none.",
         .paper = "Kol19 3.1"},
        {.key = "show-view-octree",
         .label = "View octree",
         .field = field(&S::inspect, &InspectSettings::showViewOctree),
         .minimum = 0,
         .maximum = 11,
         .unit = "level",
         .atLowest = "none",
         .help = "Draws the view octree's nodes of a level and their cones; 0 for none.",
         .paper = "Kol19 3.1"},
        {.key = "show-views",
         .label = "Views",
         .field = field(&S::inspect, &InspectSettings::showViews),
         .help = "Draws the views: where they are, where they look and how bright they are."},
        {.key = "pick-a",
         .label = "Picked view",
         .field = field(&S::inspect, &InspectSettings::pickA),
         .minimum = 0,
         .maximum = kMaxSlot,
         .unset = "none",
         .oldUnset = -1,
         .unit = "slot",
         .help = "A view to look at closely."},
        {.key = "pick-b",
         .label = "Second picked view",
         .field = field(&S::inspect, &InspectSettings::pickB),
         .minimum = 0,
         .maximum = kMaxSlot,
         .unset = "none",
         .oldUnset = -1,
         .unit = "slot",
         .help = "The view whose sharing with the first is shown.",
         .paper = "Kol19 1"},
        {.key = "map-colours",
         .label = "Map colours",
         .field =
             choice(field(&S::inspect, &InspectSettings::mapColours), {"level", "depth", "views"}),
         .help = "What colours the maps of the picked views: the level of the scene node that won "
                 "a texel, its depth, or how many views share the pair."},
        {.key = "step",
         .label = "Traversal step",
         .field = field(&S::inspect, &InspectSettings::step),
         .minimum = 0,
         .maximum = 32,
         .atLowest = "none",
         .help = "Draws the pairs of one step of the traversal, 1 is the first; 0 for none.",
         .paper = "Kol19 3.2"},
        {.key = "step-scene",
         .label = "Step from scene node",
         .field = field(&S::inspect, &InspectSettings::stepScene),
         .minimum = 0,
         .maximum = kMaxNode,
         .unit = "node",
         .atLowest = "the root",
         .help = "Scene octree node from which the steps start; 0 is the root."},
        {.key = "step-view",
         .label = "Step from view node",
         .field = field(&S::inspect, &InspectSettings::stepView),
         .minimum = 0,
         .maximum = kMaxNode,
         .unit = "node",
         .atLowest = "the root",
         .help = "View octree node from which the steps start; 0 is the root."},
        {.key = "step-pairs",
         .label = "Pairs drawn",
         .field = choice(field(&S::inspect, &InspectSettings::stepPairs),
                         {"spread", "largest", "pair", "views"}),
         .help = "Which pairs of a step are drawn: evenly spread, the largest in texels, those "
                 "above and below the picked pair, or those of the picked views."},
        {.key = "step-hide",
         .label = "Outcomes hidden",
         .field =
             SetField{{hiddenOutcomes, hideOutcomes}, {kOutcomeNames.begin(), kOutcomeNames.end()}},
         .help = "Pairs that are not drawn, by what became of them: culled, rendered, forced, "
                 "split-scene, split-view or skipped; several with commas."},
        {.key = "pair-scene",
         .label = "Picked pair, scene",
         .field = field(&S::inspect, &InspectSettings::pairScene),
         .minimum = 0,
         .maximum = kMaxNode,
         .unset = "none",
         .unit = "node",
         .help = "Scene octree node of a pair to look at closely."},
        {.key = "pair-view",
         .label = "Picked pair, view",
         .field = field(&S::inspect, &InspectSettings::pairView),
         .minimum = 0,
         .maximum = kMaxNode,
         .unset = "none",
         .unit = "node",
         .help = "View octree node of a pair to look at closely."},
    };
}

}  // namespace mv::rows
