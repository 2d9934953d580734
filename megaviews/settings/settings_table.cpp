#include "megaviews/settings/settings_table.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include "megaviews/core/error.h"
#include "megaviews/settings/light_placement.h"

namespace mv {
namespace {

constexpr double kMaxViews = 1048576;
constexpr double kMaxSlot = 16777216, kMaxNode = 268435456;  // that can be named

auto& at(auto& object, auto member) { return object.*member; }
auto& at(auto& object, auto member, auto... rest) { return at(object.*member, rest...); }

// A member of Settings, by the pointers to members that lead to it.
auto field(auto... path) {
    using T = std::decay_t<decltype(at(std::declval<Settings&>(), path...))>;
    return Field<T>{[=](const Settings& s) { return at(s, path...); },
                    [=](Settings& s, T v) { at(s, path...) = std::move(v); }};
}
// A member of MethodSettings, which both sides have.
auto methodField(auto... path) {
    using T = std::decay_t<decltype(at(std::declval<MethodSettings&>(), path...))>;
    return Field<T>{[=](const Settings& s) { return at(s.side[0], path...); },
                    [=](Settings& s, T v) {
                        T &left = at(s.side[0], path...), &right = at(s.side[1], path...);
                        if (right == left) right = v;
                        left = v;
                    }};
}
// The same of the right side, where it differs from the left one; else unset.
auto rightField(auto... path) {
    using T = std::decay_t<decltype(at(std::declval<MethodSettings&>(), path...))>;
    return Field<std::optional<T>>{
        [=](const Settings& s) {
            const T &left = at(s.side[0], path...), &right = at(s.side[1], path...);
            return left == right ? std::nullopt : std::optional<T>(right);
        },
        [=](Settings& s, std::optional<T> v) {
            at(s.side[1], path...) = v.value_or(at(s.side[0], path...));
        }};
}
// The left side's method; the right one is compared, or follows.
const Field<Method> kMethod = {[](const Settings& s) { return s.side[0].method; },
                               [](Settings& s, Method v) { setMethod(s, v); }};
const Field<std::optional<Method>> kCompare = {
    [](const Settings& s) { return s.compare ? std::optional(s.side[1].method) : std::nullopt; },
    [](Settings& s, std::optional<Method> v) {
        s.compare = v.has_value();
        s.side[1].method = v.value_or(s.side[0].method);
    }};
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

void checkLights(std::string_view text, std::string_view where) {
    parseLightPlacements(text, where);
}
void checkEnvironment(std::string_view text, std::string_view where) {
    if (!text.empty()) return;
    throw Error(ExitCode::usage,
                std::string(where) + ": '' names neither an environment nor a file");
}

using Names = std::vector<std::string_view>;

// In the order of the bits of rules.glsl.
constexpr std::array<std::string_view, kRuleCount> kRuleNames = {
    "centroid", "boxes", "lone-views", "bound", "radius", "two-texels", "surfaces", "footprint"};

// Choices and sets all go through an int, so that panels need to know only one kind.
template <typename T>
Field<int> asInt(Field<T> of) {
    return {[of](const Settings& s) { return static_cast<int>(of.get(s)); },
            [of](Settings& s, int v) { of.set(s, static_cast<T>(v)); }};
}
template <typename T>
Field<int> asInt(Field<std::optional<T>> of) {
    return {[of](const Settings& s) {
                const std::optional<T> value = of.get(s);
                return value ? static_cast<int>(*value) : -1;
            },
            [of](Settings& s, int v) {
                of.set(s, v < 0 ? std::nullopt : std::optional(static_cast<T>(v)));
            }};
}
ChoiceField choice(auto of, Names names) { return {asInt(of), std::move(names)}; }
SetField rules(auto of) {
    return {asInt(of),
            {kRuleNames.begin(), kRuleNames.end()},
            {{"published", static_cast<int>(kPublishedRules)},
             {"corrected", static_cast<int>(kCorrectedRules)}}};
}

// In the order of the enums in settings.h.
const Names kMethodNames = [] {
    Names names;
    for (const MethodInfo& info : kMethods) names.emplace_back(info.name);
    return names;
}();
const std::string kMethodHelp = [] {
    std::string help = "How the visibility of the views is found: ";
    for (const MethodInfo& info : kMethods) {
        help.append(&info == kMethods ? "" : "; ").append(info.name).append(" (");
        help.append(info.summary).append(")");
    }
    return help + ".";
}();
const Names kSceneTreeNames = {"octree", "binary"};
const Names kTraversalNames = {"queue", "lists"};
const Names kCutNames = {"basic", "incremental", "lazy"};
const Names kUndecidedNames = {"rays", "off"};
const Names kPlacementNames = {"importance", "traced", "random"};
const Names kToneMapNames = {"none", "aces", "neutral", "agx"};
const Names kMaterialsNames = {"lambert", "full"};
const Names kDebugViewNames = {"final",   "direct",  "indirect", "unfiltered",
                               "normals", "albedo",  "depth",    "candidates",
                               "nan",     "sharing", "shared",   "undecided"};
const Names kMapQuantityNames = {"level", "depth", "views"};
const Names kStepPairsNames = {"spread", "largest", "pair", "views"};
const Names kDifferenceNames = {"off", "absolute", "signed", "relative", "flip"};

std::vector<SettingInfo> sceneTable() {
    using S = Settings;
    return {
        {.key = "camera",
         .label = "Camera",
         .field = TextField{field(&S::camera, &CameraSettings::name)},
         .help = "Camera of the scene by name or number; empty takes the first."},
        {.key = "camera-position",
         .label = "Camera position",
         .field = field(&S::camera, &CameraSettings::position),
         .minimum = -1e12,
         .maximum = 1e12,
         .unset = "auto",
         .unit = "world units",
         .help = "Where the camera stands, instead of the scene's camera."},
        {.key = "camera-target",
         .label = "Camera target",
         .field = field(&S::camera, &CameraSettings::target),
         .minimum = -1e12,
         .maximum = 1e12,
         .unset = "auto",
         .unit = "world units",
         .help = "The point the camera looks at."},
        {.key = "camera-up",
         .label = "Camera up",
         .field = field(&S::camera, &CameraSettings::up),
         .minimum = -1e12,
         .maximum = 1e12,
         .help = "Which way is up when a camera position or target is given."},
        {.key = "fov",
         .label = "Field of view",
         .field = field(&S::camera, &CameraSettings::fovDeg),
         .minimum = 1,
         .maximum = 179,
         .unset = "auto",
         .unit = "degrees",
         .help = "Vertical field of view, instead of the camera's own."},
        {.key = "file-scene",
         .label = "Scene of the file",
         .field = field(&S::scene, &SceneSettings::fileScene),
         .minimum = 0,
         .maximum = 65535,
         .unset = "default",
         .help = "Which of a glTF file's scenes is shown, counted from 0; --info lists them."},
        {.key = "variant",
         .label = "Material variant",
         .field = TextField{field(&S::scene, &SceneSettings::variant)},
         .help = "Variant of a glTF file's materials by name or number; empty takes the materials "
                 "that the file shows without; --info lists them."},
        {.key = "animation",
         .label = "Animation",
         .field = TextField{field(&S::scene, &SceneSettings::animation)},
         .help = "Animation of the scene by name or number, or none; empty takes the first."},
        {.key = "time",
         .label = "Time",
         .field = field(&S::scene, &SceneSettings::timeS),
         .minimum = -1e9,
         .maximum = 1e9,
         .unit = "s",
         .help = "Time of the first frame in the animation."},
        {.key = "light-scale",
         .label = "Light scale",
         .field = field(&S::scene, &SceneSettings::lightScale),
         .minimum = 0,
         .maximum = 1e9,
         .help = "Factor on every light of the scene, emissive surfaces included."},
        {.key = "lights",
         .label = "Lights",
         .field =
             TextField{field(&S::scene, &SceneSettings::lights), "N:X,Y,Z[:X,Y,Z]", checkLights},
         .help =
             "Lights put elsewhere or changed: LIGHT:X,Y,Z:DX,DY,DZ:R,G,B:INNER,OUTER are place, "
             "direction, intensity and cone in the file's units and degrees; what is empty or "
             "left out stays, several are separated by spaces."},
        {.key = "materials",
         .label = "Materials",
         .field = choice(field(&S::scene, &SceneSettings::materials), kMaterialsNames),
         .help = "What is shown of a file's materials: lambert (base colour, emission and masks: "
                 "matt surfaces), or full (metal, roughness and normal maps too, what gloss, "
                 "mirrors and clear coats reflect, and what is seen through glass)."},
        {.key = "environment",
         .label = "Environment",
         .field =
             TextField{field(&S::scene, &SceneSettings::environment, &EnvironmentSettings::source),
                       "auto|none|sky|white|FILE", checkEnvironment},
         .help = "The light around the scene: auto (a sky where a sun was placed because the file "
                 "has no light), none, sky (a gradient about the scene's sun), white (1 W/m²/sr "
                 "from everywhere), or an image file, EXR or HDR, of latitude and longitude. white "
                 "and images stand instead of a light that was placed."},
        {.key = "sky-rotation",
         .label = "Sky rotation",
         .field = field(&S::scene, &SceneSettings::environment, &EnvironmentSettings::rotationDeg),
         .minimum = -360,
         .maximum = 360,
         .unit = "degrees",
         .help = "Turns the environment about the vertical, counter-clockwise seen from above."},
        {.key = "sky-scale",
         .label = "Sky scale",
         .field = field(&S::scene, &SceneSettings::environment, &EnvironmentSettings::scale),
         .minimum = 0,
         .maximum = 1e9,
         .help = "Factor on the environment's light, beside that on every light."},
    };
}

std::vector<SettingInfo> methodTable() {
    using S = Settings;
    return {
        {.key = "method",
         .label = "Method",
         .field = choice(kMethod, kMethodNames),
         .help = kMethodHelp,
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
         .field = choice(field(&S::scene, &SceneSettings::tree), kSceneTreeNames),
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
         .field = choice(methodField(&MethodSettings::pairs, &PairSettings::cut), kCutNames),
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
         .field = choice(kCompare, kMethodNames),
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
         .field = choice(field(&S::display, &DisplaySettings::difference), kDifferenceNames),
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

std::vector<SettingInfo> viewTable() {
    using S = Settings;
    return {
        {.key = "vpls",
         .label = "Virtual point lights",
         .field = field(&S::views, &ViewSettings::vpls),
         .minimum = 1,
         .maximum = kMaxViews,
         .unit = "views",
         .help = "Virtual point lights chosen every frame; traced: slots for them, of which those "
                 "stay empty whose path has left the scene.",
         .paper = "Kol19 4.1"},
        {.key = "particles",
         .label = "Glowing particles",
         .field = field(&S::views, &ViewSettings::particles),
         .minimum = 0,
         .maximum = kMaxViews,
         .unit = "views",
         .atLowest = "none",
         .help = "Glowing particles that light the scene instead of its lights; 0 for none.",
         .paper = "Kol19 4.1"},
        {.key = "bounces",
         .label = "Bounces",
         .field = field(&S::views, &ViewSettings::bounces),
         .minimum = 1,
         .maximum = 16,
         .help = "Virtual point lights along each light path.",
         .paper = "Kol19 4.1"},
        {.key = "placement",
         .label = "Placement",
         .field = choice(field(&S::views, &ViewSettings::placement), kPlacementNames),
         .help =
             "Where virtual point lights lie: importance (on light paths, and of several "
             "candidates a view those that light what the camera sees), traced (every point "
             "of the light paths, as published, whether it lights anything in sight or not), or "
             "random (anywhere in the scene's box, looking anywhere: the least coherent views).",
         .paper = "Kol19 4.1"},
        {.key = "views",
         .label = "Views file",
         .field = TextField{field(&S::views, &ViewSettings::file), "FILE.ply"},
         .help = "PLY file of views (x y z nx ny nz red green blue) that replace traced ones."},
        {.key = "seed",
         .label = "Seed",
         .field = field(&S::seed),
         .minimum = 0,
         .maximum = 4294967295.0,
         .help = "Seed of every random number; the same seed gives the same picture."},
    };
}

std::vector<SettingInfo> gatherTable() {
    using S = Settings;
    return {
        {.key = "gather-samples",
         .label = "Samples",
         .field = field(&S::gather, &GatherSettings::samples),
         .minimum = 0,
         .maximum = 65536,
         .unit = "views a pixel",
         .atLowest = "all",
         .help = "Views gathered by each pixel; 0 gathers every view that culling keeps.",
         .paper = "Kol19 5.1"},
        {.key = "gather-candidates",
         .label = "Candidates",
         .field = field(&S::gather, &GatherSettings::candidates),
         .minimum = 1,
         .maximum = 64,
         .unit = "views a sample",
         .help = "Views weighed for each sample by what they would give if nothing stood between "
                 "(resampled importance sampling); one of them is asked for its visibility. 1 "
                 "takes each view as it is drawn."},
        {.key = "gather-scale",
         .label = "Gather scale",
         .field = field(&S::gather, &GatherSettings::cull, &CullSettings::scale),
         .minimum = 1,
         .maximum = 2,
         .unit = "pixels",
         .help = "1 gathers at every pixel, 2 at half resolution brought up by the filter."},
        {.key = "cull-level",
         .label = "Cull level",
         .field = field(&S::gather, &GatherSettings::cull, &CullSettings::level),
         .minimum = 0,
         .maximum = 10,
         .unit = "level",
         .atLowest = "none",
         .help = "Deepest level of the view hierarchy at which views that cannot light a tile of "
                 "the picture are culled: the one in use follows distance. 0 for none.",
         .paper = "Kol19 5.1"},
        {.key = "cutoff",
         .label = "Cutoff distance",
         .field = field(&S::gather, &GatherSettings::cull, &CullSettings::cutoff),
         .minimum = 0,
         .maximum = 2,
         .unit = "root edges",
         .atLowest = "none",
         .help = "Distance beyond which views are ignored (biased); 0 for none.",
         .paper = "Kol19 5.1"},
        {.key = "clamp-distance",
         .label = "Clamp distance",
         .field = field(&S::gather, &GatherSettings::clampDistance),
         .minimum = 1e-6,
         .maximum = 1,
         .unset = "auto",
         .unit = "root edges",
         .help =
             "Distance below which a view lights no brighter; loses energy in corners. auto: of "
             "each view by how far its neighbours are."},
        {.key = "near-field",
         .label = "Near field",
         .field = field(&S::gather, &GatherSettings::nearField),
         .help = "Give back the light that the clamp takes away in corners: a short ray a pixel "
                 "meets the surface whose nearest view says how brightly it shines."},
        {.key = "sky-samples",
         .label = "Sky samples",
         .field = field(&S::gather, &GatherSettings::skySamples),
         .minimum = 1,
         .maximum = 1024,
         .help = "Directions a pixel that are asked which light of the environment reaches it."},
        {.key = "sky-views",
         .label = "Sky views",
         .field = field(&S::gather, &GatherSettings::skyViews),
         .minimum = 0,
         .maximum = 4096,
         .powerOfTwo = true,
         .atLowest = "rays",
         .help = "Parallel views of the environment whose depth maps answer instead of rays, kept "
                 "while neither geometry nor environment changes; where a map cannot tell, a ray "
                 "does. With as many sky samples as views shadows have no noise. 0 for rays alone.",
         .paper = "Marrs17"},
        {.key = "sky-view-res",
         .label = "Sky view resolution",
         .field = field(&S::gather, &GatherSettings::skyViewRes),
         .minimum = 8,
         .maximum = 2048,
         .powerOfTwo = true,
         .unit = "texels",
         .help = "Width and height of the depth map of a sky view; it covers the whole scene."},
        {.key = "map-check",
         .label = "Checked samples",
         .field = field(&S::gather, &GatherSettings::mapCheck),
         .minimum = 0,
         .maximum = 1,
         .unit = "share",
         .help = "Of the samples that a view's map decides, the share that a ray checks all the "
                 "same; more of those that give much light, fewer of the others. What it finds "
                 "counts so often that the mean is that of rays alone: light that maps let "
                 "through walls goes, for a little noise. Where undecided samples are rays."},
        {.key = "undecided",
         .label = "Undecided samples",
         .field = choice(field(&S::gather, &GatherSettings::undecided), kUndecidedNames),
         .help = "What answers where the four nearest texels of a view's map disagree: rays (a ray "
                 "against the triangles), or off (the nearest texel alone, with a bias as wide as "
                 "it is). Of corrected rules with fused maps."},
        {.key = "bias",
         .label = "Bias",
         .field = field(&S::gather, &GatherSettings::bias),
         .minimum = 0,
         .maximum = 16,
         .help =
             "How much nearer than a receiver an occluder must be to hide it, times the rules' "
             "own: "
             "corrected, the footprint of a texel; published, 1 % of the root edge. Less darkens "
             "surfaces that hide themselves, more leaks light."},
        {.key = "history",
         .label = "History",
         .field = field(&S::gather, &GatherSettings::history),
         .minimum = 0,
         .maximum = 1024,
         .unit = "frames",
         .atLowest = "none",
         .help = "Frames before whose samples a pixel remembers while camera or light move: less "
                 "noise, but light that changes by less than the noise lags behind (biased). A "
                 "picture then depends on the frames before it."},
        {.key = "filter",
         .label = "Filter",
         .field = field(&S::gather, &GatherSettings::filter),
         .help = "Cross-bilateral filter of the gathered irradiance.",
         .paper = "Kol19 5.1"},
        {.key = "accumulate",
         .label = "Accumulate",
         .field = field(&S::picture, &PictureSettings::accumulate),
         .minimum = 1,
         .maximum = 65536,
         .unit = "frames",
         .help = "Frames whose samples are averaged in one picture while nothing moves."},
        {.key = "reference-samples",
         .label = "Reference paths",
         .field = methodField(&MethodSettings::referenceSamples),
         .minimum = 1,
         .maximum = 1e6,
         .unit = "a pixel",
         .help = "Paths a pixel of the method pathtraced."},
    };
}

std::vector<SettingInfo> pictureTable() {
    using S = Settings;
    return {
        {.key = "resolution",
         .label = "Resolution",
         .field = field(&S::resolution),
         .minimum = 1,
         .maximum = 16384,
         .unit = "pixels",
         .help = "Size of the picture."},
        {.key = "pixel-samples",
         .label = "Samples a pixel",
         .field = field(&S::picture, &PictureSettings::pixelSamples),
         .minimum = 1,
         .maximum = 4096,
         .help = "Points within a pixel whose light is averaged while nothing moves, which makes "
                 "edges soft; each has gather samples of its own, and where more sets of those "
                 "accumulate, each set has a point of its own. 1: the pixel's centre alone. Data, "
                 "differences, references and what is measured are of centres."},
        {.key = "fresh-views",
         .label = "Fresh views",
         .field = field(&S::picture, &PictureSettings::freshViews),
         .help = "Each further set of samples that a still picture averages is lit by views of its "
                 "own, and maps of them, so that the mean has not the blotches of one set of "
                 "views. Views from a file, particles and what stands beside a reference stay."},
        {.key = "temporal",
         .label = "Smooth motion",
         .field = field(&S::picture, &PictureSettings::temporal),
         .help = "While something moves and frames are remembered: each frame is drawn at another "
                 "point of its pixels and averaged with what those before showed of the same "
                 "surfaces, which makes edges soft and calm. Data, differences and references "
                 "have none of it."},
        {.key = "exposure",
         .label = "Exposure",
         .field = field(&S::display, &DisplaySettings::exposureEv),
         .minimum = -64,
         .maximum = 64,
         .unset = "auto",
         .unit = "EV",
         .help = "Power of two on the radiance; auto fits it to the first frame, in "
                 "a window also to where the camera comes to rest if it is more than 2 EV off."},
        {.key = "tonemap",
         .label = "Tone map",
         .field = choice(field(&S::display, &DisplaySettings::toneMap), kToneMapNames),
         .help = "Curve from radiance to the display: none, ACES-like, Khronos neutral, or "
                 "AgX."},
        {.key = "view",
         .label = "Debug view",
         .field = choice(field(&S::picture, &PictureSettings::view), kDebugViewNames),
         .help = "What the picture shows: the final light, parts of it, or what it is made from."},
    };
}

std::vector<SettingInfo> instrumentTable() {
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
         .field = choice(field(&S::inspect, &InspectSettings::mapColours), kMapQuantityNames),
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
         .field = choice(field(&S::inspect, &InspectSettings::stepPairs), kStepPairsNames),
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

std::vector<SettingInfo> makeTable() {
    std::vector<SettingInfo> table;
    const auto add = [&](SettingGroup group, std::vector<SettingInfo> rows) {
        for (SettingInfo& row : rows) {
            row.group = group;
            table.push_back(std::move(row));
        }
    };
    add(SettingGroup::scene, sceneTable());
    add(SettingGroup::method, methodTable());
    add(SettingGroup::views, viewTable());
    add(SettingGroup::gather, gatherTable());
    add(SettingGroup::picture, pictureTable());
    add(SettingGroup::instruments, instrumentTable());
    return table;
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

std::string_view nameOf(Method method) { return infoOf(method).name; }
std::string_view nameOf(Traversal traversal) {
    return kTraversalNames.at(static_cast<std::size_t>(traversal));
}
std::string_view nameOf(ToneMap toneMap) {
    return kToneMapNames.at(static_cast<std::size_t>(toneMap));
}
std::string_view nameOf(DebugView view) {
    return kDebugViewNames.at(static_cast<std::size_t>(view));
}
std::string nameOfRules(uint rules) {
    Settings settings;
    settings.side[0].rules = rules;
    return toText(settings, *findSetting("rules"));
}

}  // namespace mv
