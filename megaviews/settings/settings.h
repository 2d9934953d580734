#pragma once
// Everything a user can choose about a picture, as one plain aggregate with defaults. The command
// line, the panel, image metadata and statistics all go through the table in settings_table.h,
// which names each member once; passes read this struct by const reference.

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace mv {

enum class Method {
    megaviews,
    manylods,
    none,
    rays,        // no maps: the scene octree is marched
    raster,      // brute force: every triangle into every view's own map
    ism,         // imperfect shadow maps: some points into every view's own map
    exact,       // reference: all views, shadow rays (docs/references.md)
    pathtraced,  // reference: no views at all
};
// Computed on the CPU by what links megaviews/references, not by passes on the GPU.
constexpr bool isReference(Method method) {
    return method == Method::exact || method == Method::pathtraced;
}
// Tests pairs of scene and view nodes: traversal, fusion and filling are theirs alone.
constexpr bool testsPairs(Method method) {
    return method == Method::megaviews || method == Method::manylods;
}
constexpr bool makesMaps(Method method) {
    return testsPairs(method) || method == Method::raster || method == Method::ism;
}
enum class Traversal { queue, lists };
enum class Rules { published, corrected };
enum class Placement { traced, random };  // of views: from the lights, or anywhere
enum class ToneMap { none, aces, neutral };
enum class DebugView {
    final,
    direct,
    indirect,
    unfiltered,  // indirect irradiance before the cross-bilateral filter, lit as final
    normals,
    albedo,
    depth,
    candidates,  // share of the views that gather culling keeps
    nan,         // NaN and infinity in red
    sharing,     // how many views share the pair that shows a pixel's surface
    shared,      // what the two picked views share [Kol19 fig. 1c]
};
// Of the two sides of a comparison, radiance before exposure: right minus left. flip: of the
// pictures as they are seen, by megaviews/measure once they are complete.
enum class Difference { off, absolute, signedValue, relative, flip };

struct Settings {
    // scene
    std::string camera;                                   // name or number; empty = default
    std::optional<std::array<double, 3>> cameraPosition;  // file's world units
    std::optional<std::array<double, 3>> cameraTarget;
    std::array<double, 3> cameraUp = {0, 1, 0};
    std::optional<double> fovDeg;  // vertical
    std::string animation;         // name, number or "none"; empty = first
    double timeS = 0;
    double lightScale = 1;
    std::string lights;  // placed elsewhere; see light_placement.h

    // many-view method
    Method method = Method::megaviews;
    std::optional<Method> compare;  // shown right of the split, same views, camera and seed
    double split = 0.5;             // where the split stands, share of the width
    // What the compared side does otherwise; nothing: as the left side.
    std::optional<Traversal> compareTraversal;
    std::optional<Rules> compareRules;
    int compareViewRes = 0;                   // 0: as the left side
    Difference difference = Difference::off;  // instead of the split; needs `compare`
    std::optional<double> differenceRange;    // end of the colour scale; unset: 99th percentile
    Traversal traversal = Traversal::lists;
    Rules rules = Rules::corrected;
    int sceneDepth = 11;  // levels counted with the root
    int viewDepth = 11;
    int viewRes = 16;  // texels across one face of a map
    bool fusion = true;
    bool holeFill = true;
    double pairSize = 1;    // threshold of a pair's size: times that of the rules
    int ismPoints = 8192;   // points that each view splats, of Method::ism
    int ismPool = 1048576;  // surface points that they are drawn from
    int gpuMemoryMiB = 2048;
    int queueMemoryMiB = 256;

    // views
    std::int64_t vpls = 4096;
    std::int64_t particles = 0;  // > 0: glowing particles instead of VPLs
    int bounces = 4;
    Placement placement = Placement::traced;
    std::string viewsFile;  // PLY file whose views replace traced ones; empty = none
    std::uint32_t seed = 0;

    // gather
    int gatherSamples = 64;
    int gatherScale = 1;  // 2 = gather at half resolution, upsampled by the filter
    int cullLevel = 6;
    double cutoff = 0;  // share of the root edge beyond which views are ignored; 0 = never
    double clampDistance = 0.01;  // share of the root edge
    double bias = 1;              // of the shadow test: times that of the rules
    bool filter = true;
    int accumulate = 1;          // frames whose samples are averaged while nothing moves
    int referenceSamples = 256;  // paths a pixel of Method::pathtraced

    // picture
    int width = 1280;
    int height = 720;
    std::optional<double> exposureEv;  // unset: fitted on the first frame
    ToneMap toneMap = ToneMap::aces;
    DebugView view = DebugView::final;

    // instruments drawn over the picture
    int showOctree = 0;      // scene octree nodes of this level, 1 = root; 0 = none
    int showViewOctree = 0;  // view octree nodes of this level with their cones; 0 = none
    bool showViews = false;  // positions, normals and flux of the views
    std::int64_t pickA = -1, pickB = -1;  // picked views by slot; -1 = none
    int step = 0;                         // pairs of this step of the traversal, 1 = root pair
    std::int64_t stepScene = 0;           // the pair it starts from: node of the scene octree
    std::int64_t stepView = 0;            // and of the view octree; 0 = the roots

    bool operator==(const Settings&) const = default;
};

// What the side right of the split runs with: method, traversal, rules and view resolution of its
// own, everything else as on the left.
Settings comparedSide(const Settings& settings);

// The settings with those at their defaults that only show light which is there already: split,
// difference, exposure and tone map.
Settings withoutDisplay(Settings settings);
void copyCamera(Settings& settings, const Settings& from);
// Takes over what is said of a scene and means nothing in another: camera, animation, time, views.
void copySceneChoices(Settings& settings, const Settings& from);

}  // namespace mv
