#include "megaviews/settings/settings_table.h"

#include <algorithm>
#include <type_traits>

namespace mv {
namespace {

constexpr double kMaxViews = 1048576;

// Members that are enums all go through an int, so that panels need to know only one kind.
template <auto member, typename Enum>
ChoiceMember choice(std::vector<std::string_view> names) {
    return {[](const Settings& s) { return static_cast<int>(s.*member); },
            [](Settings& s, int v) { s.*member = static_cast<Enum>(v); }, std::move(names)};
}
template <auto member, typename Enum>
ChoiceMember optionalChoice(std::vector<std::string_view> names) {
    return {[](const Settings& s) {
                return (s.*member).has_value() ? static_cast<int>(*(s.*member)) : -1;
            },
            [](Settings& s, int v) {
                if (v < 0) {
                    (s.*member).reset();
                } else {
                    s.*member = static_cast<Enum>(v);
                }
            },
            std::move(names)};
}

// In the order of the enums in settings.h.
const std::vector<std::string_view> kMethodNames = {"megaviews", "manylods", "none",  "rays",
                                                    "raster",    "ism",      "exact", "pathtraced"};
const std::vector<std::string_view> kTraversalNames = {"queue", "lists"};
const std::vector<std::string_view> kRulesNames = {"published", "corrected"};
const std::vector<std::string_view> kPlacementNames = {"traced", "random"};
const std::vector<std::string_view> kToneMapNames = {"none", "aces", "neutral"};
const std::vector<std::string_view> kDebugViewNames = {
    "final", "direct",     "indirect", "unfiltered", "normals", "albedo",
    "depth", "candidates", "nan",      "sharing",    "shared"};
const std::vector<std::string_view> kDifferenceNames = {"off", "absolute", "signed", "relative",
                                                        "flip"};

std::vector<SettingInfo> makeTable() {
    using S = Settings;
    using G = SettingGroup;
    std::vector<SettingInfo> t;
    const auto add = [&](SettingInfo info) { t.push_back(std::move(info)); };

    // ------------------------------------------------------------ scene
    add({.key = "camera",
         .group = G::scene,
         .label = "Camera",
         .member = &S::camera,
         .help = "Camera of the scene by name or number; empty takes the first."});
    add({.key = "camera-position",
         .group = G::scene,
         .label = "Camera position",
         .member = &S::cameraPosition,
         .minimum = -1e12,
         .maximum = 1e12,
         .unset = "auto",
         .unit = "world units",
         .help = "Where the camera stands, instead of the scene's camera."});
    add({.key = "camera-target",
         .group = G::scene,
         .label = "Camera target",
         .member = &S::cameraTarget,
         .minimum = -1e12,
         .maximum = 1e12,
         .unset = "auto",
         .unit = "world units",
         .help = "The point the camera looks at."});
    add({.key = "camera-up",
         .group = G::scene,
         .label = "Camera up",
         .member = &S::cameraUp,
         .minimum = -1e12,
         .maximum = 1e12,
         .help = "Which way is up when a camera position or target is given."});
    add({.key = "fov",
         .group = G::scene,
         .label = "Field of view",
         .member = &S::fovDeg,
         .minimum = 1,
         .maximum = 179,
         .unset = "auto",
         .unit = "degrees",
         .help = "Vertical field of view, instead of the camera's own."});
    add({.key = "animation",
         .group = G::scene,
         .label = "Animation",
         .member = &S::animation,
         .help = "Animation of the scene by name or number, or none; empty takes the first."});
    add({.key = "time",
         .group = G::scene,
         .label = "Time",
         .member = &S::timeS,
         .minimum = -1e9,
         .maximum = 1e9,
         .unit = "s",
         .help = "Time of the first frame in the animation."});
    add({.key = "light-scale",
         .group = G::scene,
         .label = "Light scale",
         .member = &S::lightScale,
         .minimum = 0,
         .maximum = 1e9,
         .help = "Factor on every light of the scene, emissive surfaces included."});

    add({.key = "lights",
         .group = G::scene,
         .label = "Lights",
         .member = &S::lights,
         .help = "Lights put elsewhere, as LIGHT:X,Y,Z or LIGHT:X,Y,Z:DX,DY,DZ, in the file's "
                 "units; several are separated by spaces."});

    // ------------------------------------------------------------ method
    add({.key = "method",
         .group = G::method,
         .label = "Method",
         .member = choice<&S::method, Method>(kMethodNames),
         .help =
             "How the visibility of the views is found: shared between views, a cut for each "
             "view, not at all, by marching the scene octree (rays), by every triangle "
             "rasterised for every view (raster: slow), or by some of the scene's points "
             "splatted for each (ism); exact and pathtraced are references, made slowly by rays.",
         .paper = "Kol19 3, HREB11 3.1"});
    add({.key = "compare",
         .group = G::method,
         .label = "Compare with",
         .member = optionalChoice<&S::compare, Method>(kMethodNames),
         .unset = "off",
         .help = "A second method, shown right of the split with the same views and seed."});
    add({.key = "split",
         .group = G::method,
         .label = "Split",
         .member = &S::split,
         .minimum = 0,
         .maximum = 1,
         .unit = "share of the width",
         .help = "Where the two sides of a comparison meet."});
    add({.key = "compare-traversal",
         .group = G::method,
         .label = "Traversal, right",
         .member = optionalChoice<&S::compareTraversal, Traversal>(kTraversalNames),
         .unset = "as left",
         .help = "Traversal of the compared side."});
    add({.key = "compare-rules",
         .group = G::method,
         .label = "Rules, right",
         .member = optionalChoice<&S::compareRules, Rules>(kRulesNames),
         .unset = "as left",
         .help = "Rules of the compared side."});
    add({.key = "compare-view-res",
         .group = G::method,
         .label = "View resolution, right",
         .member = &S::compareViewRes,
         .minimum = 0,
         .maximum = 256,
         .powerOfTwo = true,
         .unit = "texels",
         .help = "View resolution of the compared side; 0 takes the left side's."});
    add({.key = "difference",
         .group = G::method,
         .label = "Difference",
         .member = choice<&S::difference, Difference>(kDifferenceNames),
         .help =
             "Shows the difference of the two sides instead of the split: of their radiance, "
             "right minus left; relative is divided by the left side's; flip: of what is seen."});
    add({.key = "difference-range",
         .group = G::method,
         .label = "Difference range",
         .member = &S::differenceRange,
         .minimum = 1e-9,
         .maximum = 1e9,
         .unset = "auto",
         .help = "Difference at the end of the colour scale; auto takes the 99th percentile, or 1 "
                 "for flip."});
    add({.key = "traversal",
         .group = G::method,
         .label = "Traversal",
         .member = choice<&S::traversal, Traversal>(kTraversalNames),
         .help = "How pairs are worked through: a breadth-first pair queue as published, or a list "
                 "of scene nodes for each view node. Both give the same maps. Of megaviews and "
                 "manylods.",
         .paper = "Kol19 3.2"});
    add({.key = "rules",
         .group = G::method,
         .label = "Rules",
         .member = choice<&S::rules, Rules>(kRulesNames),
         .help = "Which tests decide on a pair: those printed in the paper, or tighter ones with "
                 "true bounds. Methods without pairs take only the shadow test's bias from them.",
         .paper = "Kol19 3.2"});
    add({.key = "scene-depth",
         .group = G::method,
         .label = "Scene levels",
         .member = &S::sceneDepth,
         .minimum = 1,
         .maximum = 11,
         .unit = "levels",
         .help = "Levels of the scene octree counted with the root; 11 is a grid of 1024 a side.",
         .paper = "Kol19 3.1"});
    add({.key = "view-depth",
         .group = G::method,
         .label = "View levels",
         .member = &S::viewDepth,
         .minimum = 1,
         .maximum = 11,
         .unit = "levels",
         .help = "Levels of the view octree counted with the root; the gather culls with it "
                 "whatever the method.",
         .paper = "Kol19 3.1"});
    add({.key = "view-res",
         .group = G::method,
         .label = "View resolution",
         .member = &S::viewRes,
         .minimum = 8,
         .maximum = 256,
         .powerOfTwo = true,
         .unit = "texels",
         .help = "Texels across one of the two faces of a view's depth map.",
         .paper = "Kol19 4"});
    add({.key = "pair-size",
         .group = G::method,
         .label = "Pair size",
         .member = &S::pairSize,
         .minimum = 0.125,
         .maximum = 8,
         .help =
             "Size below which a scene node is drawn once for all the views of a view node, times "
             "the rules' own: corrected 1.41 texels, published 1. Larger is faster and coarser.",
         .paper = "Kol19 3.2"});
    add({.key = "fusion",
         .group = G::method,
         .label = "Fusion",
         .member = &S::fusion,
         .help = "Merge the maps of inner view nodes into those of the leaves; off queries them "
                 "from the root down. Of megaviews.",
         .paper = "Kol19 3.2"});
    add({.key = "hole-fill",
         .group = G::method,
         .label = "Hole filling",
         .member = &S::holeFill,
         .help = "Fill all the texels a near scene leaf covers, not only its middle. Of megaviews "
                 "and manylods.",
         .paper = "Kol19 3.2"});
    add({.key = "ism-points",
         .group = G::method,
         .label = "Points a view",
         .member = &S::ismPoints,
         .minimum = 1,
         .maximum = 65536,
         .unit = "points",
         .help = "Points of the scene's surfaces that each view splats into its map. Of ism.",
         .paper = "RGK08 3"});
    add({.key = "ism-pool",
         .group = G::method,
         .label = "Surface points",
         .member = &S::ismPool,
         .minimum = 1,
         .maximum = 16777216,
         .unit = "points",
         .help = "Points spread over the scene's surfaces once, of which each view draws its own "
                 "few; at least as many are made. Of ism.",
         .paper = "RGK08 3"});
    add({.key = "gpu-memory",
         .group = G::method,
         .label = "Map memory",
         .member = &S::gpuMemoryMiB,
         .minimum = 1,
         .maximum = 1048576,
         .unit = "MiB",
         .help = "Budget for depth maps; a request that cannot fit is refused."});
    add({.key = "queue-memory",
         .group = G::method,
         .label = "Queue memory",
         .member = &S::queueMemoryMiB,
         .minimum = 1,
         .maximum = 1048576,
         .unit = "MiB",
         .help = "Budget for pair queues or lists of megaviews and manylods; what does not fit is "
                 "done in more passes.",
         .paper = "Kol19 4.2"});

    // ------------------------------------------------------------ views
    add({.key = "vpls",
         .group = G::views,
         .label = "Virtual point lights",
         .member = &S::vpls,
         .minimum = 1,
         .maximum = kMaxViews,
         .unit = "views",
         .help = "Virtual point lights traced from the lights every frame.",
         .paper = "Kol19 4.1"});
    add({.key = "particles",
         .group = G::views,
         .label = "Glowing particles",
         .member = &S::particles,
         .minimum = 0,
         .maximum = kMaxViews,
         .unit = "views",
         .help = "Glowing particles that light the scene instead of its lights; 0 for none.",
         .paper = "Kol19 4.1"});
    add({.key = "bounces",
         .group = G::views,
         .label = "Bounces",
         .member = &S::bounces,
         .minimum = 1,
         .maximum = 16,
         .help = "Virtual point lights along each light path.",
         .paper = "Kol19 4.1"});
    add({.key = "placement",
         .group = G::views,
         .label = "Placement",
         .member = choice<&S::placement, Placement>(kPlacementNames),
         .help = "Where virtual point lights lie: on light paths, or at random places in the "
                 "scene's box, looking anywhere: the least coherent views.",
         .paper = "Kol19 4.1"});
    add({.key = "views",
         .group = G::views,
         .label = "Views file",
         .member = &S::viewsFile,
         .help = "PLY file of views (x y z nx ny nz red green blue) that replace traced ones."});
    add({.key = "seed",
         .group = G::views,
         .label = "Seed",
         .member = &S::seed,
         .minimum = 0,
         .maximum = 4294967295.0,
         .help = "Seed of every random number; the same seed gives the same picture."});

    // ------------------------------------------------------------ gather
    add({.key = "gather-samples",
         .group = G::gather,
         .label = "Samples",
         .member = &S::gatherSamples,
         .minimum = 0,
         .maximum = 65536,
         .unit = "views a pixel",
         .help = "Views gathered by each pixel; 0 gathers every view that culling keeps.",
         .paper = "Kol19 5.1"});
    add({.key = "gather-scale",
         .group = G::gather,
         .label = "Gather scale",
         .member = &S::gatherScale,
         .minimum = 1,
         .maximum = 2,
         .unit = "pixels",
         .help = "1 gathers at every pixel, 2 at half resolution brought up by the filter."});
    add({.key = "cull-level",
         .group = G::gather,
         .label = "Cull level",
         .member = &S::cullLevel,
         .minimum = 0,
         .maximum = 10,
         .unit = "level",
         .help = "Octree level at which views that cannot light a place are culled; 0 for none.",
         .paper = "Kol19 5.1"});
    add({.key = "cutoff",
         .group = G::gather,
         .label = "Cutoff distance",
         .member = &S::cutoff,
         .minimum = 0,
         .maximum = 2,
         .unit = "root edges",
         .help = "Distance beyond which views are ignored (biased); 0 for none.",
         .paper = "Kol19 5.1"});
    add({.key = "clamp-distance",
         .group = G::gather,
         .label = "Clamp distance",
         .member = &S::clampDistance,
         .minimum = 1e-6,
         .maximum = 1,
         .unit = "root edges",
         .help = "Distance below which a view lights no brighter; loses energy in corners."});
    add({.key = "bias",
         .group = G::gather,
         .label = "Bias",
         .member = &S::bias,
         .minimum = 0,
         .maximum = 16,
         .help =
             "How much nearer than a receiver an occluder must be to hide it, times the rules' "
             "own: "
             "corrected, the footprint of a texel; published, 1 % of the root edge. Less darkens "
             "surfaces that hide themselves, more leaks light."});
    add({.key = "filter",
         .group = G::gather,
         .label = "Filter",
         .member = &S::filter,
         .help = "Cross-bilateral filter of the gathered irradiance.",
         .paper = "Kol19 5.1"});

    add({.key = "accumulate",
         .group = G::gather,
         .label = "Accumulate",
         .member = &S::accumulate,
         .minimum = 1,
         .maximum = 65536,
         .unit = "frames",
         .help = "Frames whose samples are averaged in one picture while nothing moves."});
    add({.key = "reference-samples",
         .group = G::gather,
         .label = "Reference paths",
         .member = &S::referenceSamples,
         .minimum = 1,
         .maximum = 1e6,
         .unit = "a pixel",
         .help = "Paths a pixel of the method pathtraced."});

    // ------------------------------------------------------------ picture
    add({.key = "resolution",
         .group = G::picture,
         .label = "Resolution",
         .member = SizeMember{&S::width, &S::height},
         .minimum = 1,
         .maximum = 16384,
         .unit = "pixels",
         .help = "Size of the picture."});
    add({.key = "exposure",
         .group = G::picture,
         .label = "Exposure",
         .member = &S::exposureEv,
         .minimum = -64,
         .maximum = 64,
         .unset = "auto",
         .unit = "EV",
         .help = "Power of two on the radiance; auto fits it once on the first frame."});
    add({.key = "tonemap",
         .group = G::picture,
         .label = "Tone map",
         .member = choice<&S::toneMap, ToneMap>(kToneMapNames),
         .help = "Curve from radiance to the display: none, ACES-like, or Khronos neutral."});
    add({.key = "view",
         .group = G::picture,
         .label = "Debug view",
         .member = choice<&S::view, DebugView>(kDebugViewNames),
         .help = "What the picture shows: the final light, parts of it, or what it is made from."});

    // ------------------------------------------------------------ instruments
    add({.key = "show-octree",
         .group = G::instruments,
         .label = "Scene octree",
         .member = &S::showOctree,
         .minimum = 0,
         .maximum = 11,
         .unit = "level",
         .help = "Draws the scene octree's nodes of a level, 1 is the root; 0 for none.",
         .paper = "Kol19 3.1"});
    add({.key = "show-view-octree",
         .group = G::instruments,
         .label = "View octree",
         .member = &S::showViewOctree,
         .minimum = 0,
         .maximum = 11,
         .unit = "level",
         .help = "Draws the view octree's nodes of a level and their cones; 0 for none.",
         .paper = "Kol19 3.1"});
    add({.key = "show-views",
         .group = G::instruments,
         .label = "Views",
         .member = &S::showViews,
         .help = "Draws the views: where they are, where they look and how bright they are."});
    add({.key = "pick-a",
         .group = G::instruments,
         .label = "Picked view",
         .member = &S::pickA,
         .minimum = -1,
         .maximum = 16777216,
         .unit = "slot",
         .help = "A view to look at closely; -1 for none."});
    add({.key = "pick-b",
         .group = G::instruments,
         .label = "Second picked view",
         .member = &S::pickB,
         .minimum = -1,
         .maximum = 16777216,
         .unit = "slot",
         .help = "The view whose sharing with the first is shown; -1 for none.",
         .paper = "Kol19 1"});
    add({.key = "step",
         .group = G::instruments,
         .label = "Traversal step",
         .member = &S::step,
         .minimum = 0,
         .maximum = 32,
         .help = "Draws the pairs of one step of the traversal, 1 is the first; 0 for none.",
         .paper = "Kol19 3.2"});
    add({.key = "step-scene",
         .group = G::instruments,
         .label = "Step from scene node",
         .member = &S::stepScene,
         .minimum = 0,
         .maximum = 268435456,
         .unit = "node",
         .help = "Scene octree node from which the steps start; 0 is the root."});
    add({.key = "step-view",
         .group = G::instruments,
         .label = "Step from view node",
         .member = &S::stepView,
         .minimum = 0,
         .maximum = 268435456,
         .unit = "node",
         .help = "View octree node from which the steps start; 0 is the root."});
    return t;
}

}  // namespace

std::string_view groupTitle(SettingGroup group) {
    switch (group) {
        case SettingGroup::scene:
            return "Scene";
        case SettingGroup::method:
            return "Method";
        case SettingGroup::views:
            return "Views";
        case SettingGroup::gather:
            return "Gather";
        case SettingGroup::instruments:
            return "Instruments";
        case SettingGroup::picture:
            return "Picture";
    }
    return "";
}

std::span<const SettingInfo> settingsTable() {
    static const std::vector<SettingInfo> table = makeTable();
    return table;
}

const SettingInfo* findSetting(std::string_view key) {
    const auto table = settingsTable();
    const auto it = std::find_if(table.begin(), table.end(),
                                 [&](const SettingInfo& s) { return s.key == key; });
    return it == table.end() ? nullptr : &*it;
}

std::string_view nameOf(Method method) { return kMethodNames.at(static_cast<std::size_t>(method)); }
std::string_view nameOf(Traversal traversal) {
    return kTraversalNames.at(static_cast<std::size_t>(traversal));
}
std::string_view nameOf(Rules rules) { return kRulesNames.at(static_cast<std::size_t>(rules)); }
std::string_view nameOf(ToneMap toneMap) {
    return kToneMapNames.at(static_cast<std::size_t>(toneMap));
}
std::string_view nameOf(DebugView view) {
    return kDebugViewNames.at(static_cast<std::size_t>(view));
}

}  // namespace mv
