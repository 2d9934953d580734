#include "megaviews/settings/settings_rows.h"

#include <array>
#include <string>

namespace mv::rows {
namespace {

// The left side's method; the right one is compared, or follows.
Field<Method> method() {
    return {[](const Settings& s) { return s.side[0].method; },
            [](Settings& s, Method v) { setMethod(s, v); }};
}
Field<std::optional<Method>> compare() {
    return {[](const Settings& s) {
                return s.compare ? std::optional(s.side[1].method) : std::nullopt;
            },
            [](Settings& s, std::optional<Method> v) {
                s.compare = v.has_value();
                s.side[1].method = v.value_or(s.side[0].method);
            }};
}

// In the order of the bits of rules.glsl.
constexpr std::array<std::string_view, kRuleCount> kRuleNames = {
    "centroid", "boxes", "lone-views", "bound", "radius", "two-texels", "surfaces", "footprint"};

SetField rules(auto of) {
    return {asInt(of),
            {kRuleNames.begin(), kRuleNames.end()},
            {{"published", static_cast<int>(kPublishedRules)},
             {"corrected", static_cast<int>(kCorrectedRules)}}};
}

constexpr std::array<std::string_view, 2> kTraversalNames = {"queue", "lists"};

std::vector<std::string_view> methodNames() {
    std::vector<std::string_view> names;
    for (const MethodInfo& info : kMethods) names.emplace_back(info.name);
    return names;
}
std::string methodHelp() {
    std::string help = "How the visibility of the views is found: ";
    for (const MethodInfo& info : kMethods) {
        help.append(&info == kMethods ? "" : "; ").append(info.name).append(" (");
        help.append(info.summary).append(")");
    }
    return help + ".";
}

}  // namespace

std::vector<SettingInfo> ofMethod() {
    using S = Settings;
    static const std::string help = methodHelp();
    return {
        {.key = "method",
         .label = "Method",
         .field = choice(method(), methodNames()),
         .help = help,
         .paper = "Kol19 3, HREB11 3.1"},
        {.key = "traversal",
         .label = "Traversal",
         .field =
             choice(methodField(&MethodSettings::pairs, &PairSettings::traversal), kTraversalNames),
         .help = "How pairs are worked through: a breadth-first pair queue as published, or a list "
                 "of scene nodes for each view node. Both give the same maps. Of megaviews and "
                 "manylods.",
         .paper = "Kol19 3.2"},
        {.key = "rules",
         .label = "Rules",
         .field = rules(methodField(&MethodSettings::rules)),
         .help =
             "Which tests decide on a pair: those printed in the paper (published), tighter ones "
             "with true bounds (corrected), or the printed ones with some corrections, named "
             "with commas: centroid, boxes, lone-views, bound, radius, two-texels, surfaces, "
             "footprint. Methods without pairs take only the shadow test's bias from them.",
         .paper = "Kol19 3.2"},
        {.key = "scene-tree",
         .label = "Scene tree",
         .field = choice(field(&S::scene, &SceneSettings::tree), {"octree", "binary"}),
         .help = "What stands for the scene: an octree over its surface, or ManyLoDs' complete "
                 "binary tree over uniform samples of it, about as many as the octree of the same "
                 "levels has leaves.",
         .paper = "HREB11 4"},
        {.key = "scene-depth",
         .label = "Scene levels",
         .field = field(&S::scene, &SceneSettings::octreeDepth),
         .minimum = 1,
         .maximum = 11,
         .unit = "levels",
         .help = "Levels of the scene octree counted with the root; 11 is a grid of 1024 a side. A "
                 "binary scene tree is as fine, and has levels of its own.",
         .paper = "Kol19 3.1"},
        {.key = "view-depth",
         .label = "View levels",
         .field = field(&S::views, &ViewSettings::octreeDepth),
         .minimum = 1,
         .maximum = 11,
         .unit = "levels",
         .help = "Levels of the view octree counted with the root; the gather culls with it "
                 "whatever the method.",
         .paper = "Kol19 3.1"},
        {.key = "view-res",
         .label = "Map resolution",
         .field = methodField(&MethodSettings::maps, &MapSettings::resolution),
         .minimum = 8,
         .maximum = 256,
         .powerOfTwo = true,
         .unit = "texels",
         .help = "Texels across one of the two faces of a view's depth map.",
         .paper = "Kol19 4"},
        {.key = "depth-bits",
         .label = "Depth bits",
         .field = methodField(&MethodSettings::maps, &MapSettings::depthBits),
         .minimum = 16,
         .maximum = 32,
         .powerOfTwo = true,
         .unit = "bits",
         .help =
             "What a depth takes in the maps of megaviews and manylods. 16 are half the memory, "
             "and off by up to 0.025 % of the depth."},
        {.key = "pair-size",
         .label = "Pair size",
         .field = methodField(&MethodSettings::pairs, &PairSettings::size),
         .minimum = 0.125,
         .maximum = 8,
         .help =
             "Size below which a scene node is drawn once for all the views of a view node, times "
             "the rules' own: corrected 2 texels, published 1. Larger is faster and coarser.",
         .paper = "Kol19 3.2"},
        {.key = "fusion",
         .label = "Fusion",
         .field = methodField(&MethodSettings::pairs, &PairSettings::fusion),
         .help = "Merge the maps of inner view nodes into those of the leaves, where the nearer "
                 "depth stays; off keeps all maps and takes the last texel that is not empty "
                 "from the root down, as published. Of megaviews.",
         .paper = "Kol19 3.2"},
        {.key = "hole-fill",
         .label = "Hole filling",
         .field = methodField(&MethodSettings::pairs, &PairSettings::holeFill),
         .help = "Fill all the texels a near scene leaf covers, not only its middle. Of megaviews "
                 "and manylods.",
         .paper = "Kol19 3.2"},
        {.key = "cut",
         .label = "Cut",
         .field = choice(methodField(&MethodSettings::pairs, &PairSettings::cut),
                         {"basic", "incremental", "lazy"}),
         .help = "Where a view's descent through the scene begins: basic at the root; incremental "
                 "where that of the frame before ended, for the same maps from fewer tests; lazy "
                 "goes no more than --lazy-iterations levels further. Of manylods.",
         .paper = "HREB11 3"},
        {.key = "lazy-iterations",
         .label = "Levels a frame",
         .field = methodField(&MethodSettings::pairs, &PairSettings::lazyIterations),
         .minimum = 1,
         .maximum = 11,
         .help = "Levels by which a frame may refine a lazy cut: maps lag behind where views move "
                 "faster. Of manylods with --cut lazy.",
         .paper = "HREB11 3.3"},
        {.key = "ism-points",
         .label = "Points a view",
         .field = methodField(&MethodSettings::ism, &IsmSettings::points),
         .minimum = 1,
         .maximum = 65536,
         .unit = "points",
         .help = "Points of the scene's surfaces that each view splats into its map. Of ism.",
         .paper = "RGK08 3"},
        {.key = "ism-pool",
         .label = "Surface points",
         .field = methodField(&MethodSettings::ism, &IsmSettings::pool),
         .minimum = 1,
         .maximum = 16777216,
         .unit = "points",
         .help = "Points spread over the scene's surfaces once, of which each view draws its own "
                 "few; at least as many are made. Of ism.",
         .paper = "RGK08 3"},
        {.key = "vir-density",
         .label = "Points a texel",
         .field = methodField(&MethodSettings::vir, &VirSettings::density),
         .minimum = 0.125,
         .maximum = 16,
         .unit = "points",
         .help = "Points made for a texel in the middle of a map, of the nearest view that they "
                 "are splatted into. Of vir.",
         .paper = "Marrs17 3.1"},
        {.key = "gpu-memory",
         .label = "Map memory",
         .field = methodField(&MethodSettings::maps, &MapSettings::memoryMiB),
         .minimum = 1,
         .maximum = 1048576,
         .unit = "MiB",
         .help = "Budget for depth maps, and cuts that are kept. Maps that do not fit are made and "
                 "asked one part after the other, for the same picture; without fusion, filled by "
                 "coarser levels (published rules above 16 texels), or of kept cuts, they are "
                 "refused."},
        {.key = "queue-memory",
         .label = "Queue memory",
         .field = methodField(&MethodSettings::pairs, &PairSettings::queueMemoryMiB),
         .minimum = 1,
         .maximum = 1048576,
         .unit = "MiB",
         .help = "Budget for pair queues or lists of megaviews and manylods; what does not fit is "
                 "done in more passes.",
         .paper = "Kol19 4.2"},
        {.key = "queue-fill",
         .label = "Queue filled to",
         .field = methodField(&MethodSettings::pairs, &PairSettings::queueFill),
         .minimum = 0.1,
         .maximum = 1,
         .unit = "share",
         .help = "Where there are several passes, how much of the queue memory each is expected to "
                 "fill: more overflow, and are done again, the nearer this is to 1.",
         .paper = "TSK13 4.3"},
        {.key = "compare",
         .label = "Compare with",
         .field = choice(compare(), methodNames()),
         .unset = "off",
         .help = "A second method, shown right of the split with the same views and seed."},
        {.key = "split",
         .label = "Split",
         .field = field(&S::display, &DisplaySettings::split),
         .minimum = 0,
         .maximum = 1,
         .unit = "share of the width",
         .help = "Where the two sides of a comparison meet."},
        {.key = "compare-traversal",
         .label = "Traversal, right",
         .field =
             choice(rightField(&MethodSettings::pairs, &PairSettings::traversal), kTraversalNames),
         .unset = "as left",
         .help = "Traversal of the compared side."},
        {.key = "compare-rules",
         .label = "Rules, right",
         .field = rules(rightField(&MethodSettings::rules)),
         .unset = "as left",
         .help = "Rules of the compared side."},
        {.key = "compare-view-res",
         .label = "Map resolution, right",
         .field = rightField(&MethodSettings::maps, &MapSettings::resolution),
         .minimum = 8,
         .maximum = 256,
         .powerOfTwo = true,
         .unset = "as left",
         .oldUnset = 0,
         .unit = "texels",
         .help = "Map resolution of the compared side."},
        {.key = "difference",
         .label = "Difference",
         .field = choice(field(&S::display, &DisplaySettings::difference),
                         {"off", "absolute", "signed", "relative", "flip"}),
         .help =
             "Shows the difference of the two sides instead of the split: of their radiance, "
             "right minus left; relative is divided by the left side's; flip: of what is seen."},
        {.key = "difference-range",
         .label = "Difference range",
         .field = field(&S::display, &DisplaySettings::differenceRange),
         .minimum = 1e-9,
         .maximum = 1e9,
         .unset = "auto",
         .help = "Difference at the end of the colour scale; auto takes the 99th percentile, or 1 "
                 "for flip."},
    };
}

}  // namespace mv::rows

namespace mv {

std::string_view nameOf(Method method) { return infoOf(method).name; }
std::string_view nameOf(Traversal traversal) {
    return rows::kTraversalNames.at(static_cast<std::size_t>(traversal));
}
std::string nameOfRules(uint rules) {
    Settings settings;
    settings.side[0].rules = rules;
    return toText(settings, *findSetting("rules"));
}

}  // namespace mv
