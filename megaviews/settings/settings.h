#pragma once
// Everything a user can choose about a picture, as one plain aggregate with defaults. The command
// line, the panel, image metadata and statistics all go through the table in settings_table.h,
// which names each member once; passes read this struct by const reference.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "shaders/shared/rules.glsl"

namespace mv {

enum class Method {
#define MV_METHOD(id, ...) id,
#include "megaviews/settings/methods.inc"
#undef MV_METHOD
};

// What a method is, combined in its row of methods.inc.
constexpr unsigned kMethodReference = 1;  // made on the CPU by megaviews/references, not by passes
constexpr unsigned kMethodPairs = 2;      // tests pairs of scene and view nodes: has traversal,
                                          // fusion and filling
constexpr unsigned kMethodMaps = 4;       // makes depth maps
constexpr unsigned kMethodFlat = 8;       // its maps are of a flat hierarchy: a leaf for each view

struct MethodInfo {
    Method method;
    const char *name, *title;
    unsigned traits;
    const char* summary;
};
inline constexpr MethodInfo kMethods[] = {
#define MV_METHOD(id, name, title, traits, summary) {Method::id, name, title, traits, summary},
#include "megaviews/settings/methods.inc"
#undef MV_METHOD
};
constexpr const MethodInfo& infoOf(Method method) {
    return kMethods[static_cast<std::size_t>(method)];
}
constexpr bool isReference(Method method) { return infoOf(method).traits & kMethodReference; }
constexpr bool testsPairs(Method method) { return infoOf(method).traits & kMethodPairs; }
constexpr bool makesMaps(Method method) { return infoOf(method).traits & kMethodMaps; }
constexpr bool hasFlatViews(Method method) { return infoOf(method).traits & kMethodFlat; }

// What stands for the scene: MegaViews' octree over its surface, or ManyLoDs' complete binary tree
// of bounding spheres over samples of it [HREB11 §4].
enum class SceneTree { octree, binary };
enum class Traversal { queue, lists };
// Where ManyLoDs' descents through the scene begin: at the root, or where those of the frame before
// ended; lazy: no further down from there than a few levels a frame [HREB11 §3].
enum class Cut { basic, incremental, lazy };
// What answers where a map's nearest texels do not agree: a ray, or the texel alone.
enum class Undecided { rays, off };
// How views are placed. importance: of more candidates, those that light what the camera sees.
enum class Placement { importance, traced, random };
enum class ToneMap { none, aces, neutral, agx };
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
    undecided,   // share of the samples whose maps could not tell
};
// Whether a view shows light, not data in colours of its own.
bool showsLight(DebugView view);
// What the texels of a picked view's map are coloured by: the level of the scene node that won, its
// distance, or how many views share the pair.
enum class MapQuantity { level, depth, views };
// Which of a step's pairs are drawn: an even sample, the largest, those above and below the picked
// pair, those whose view node holds a picked view.
enum class StepPairs { spread, largest, ofPair, ofViews };
// What becomes of a pair, in the order of kPair* in shaders/shared/pair.glsl.
inline constexpr std::array<std::string_view, 6> kOutcomeNames = {
    "culled", "rendered", "forced", "split-scene", "split-view", "skipped"};
// Two sides are compared by radiance before exposure, right minus left. flip compares the
// pictures as they are seen, once they are complete.
enum class Difference { off, absolute, signedValue, relative, flip };

// ---- scene: what is loaded, and how it is posed and lit

struct CameraSettings {
    std::string name;                               // or number; empty = default
    std::optional<std::array<double, 3>> position;  // file's world units
    std::optional<std::array<double, 3>> target;
    std::array<double, 3> up = {0, 1, 0};
    std::optional<double> fovDeg;  // vertical
    bool operator==(const CameraSettings&) const = default;
};

// The light around the scene.
struct EnvironmentSettings {
    // auto (a sky where a sun was placed because the file has no light), none, sky, white, or an
    // image file: environmentFile().
    std::string source = "auto";
    double rotationDeg = 0;  // about the vertical
    double scale = 1;        // of its radiance
    bool operator==(const EnvironmentSettings&) const = default;
};
// The image file that a source names; empty where it is one of the words.
std::string environmentFile(const EnvironmentSettings& settings);

// What of a file's materials is shown: base colour, emission and masks alone, or metal, roughness
// and normal maps, too.
enum class Materials { lambert, full };

struct SceneSettings {
    std::optional<int> fileScene;  // of several in a glTF file, from 0; unset: the file's default
    std::string variant;           // of materials: name or number; empty = the file's own materials
    std::string animation;         // name, number or "none"; empty = first
    double timeS = 0;
    double lightScale = 1;
    std::string lights;  // placed elsewhere; see light_placement.h
    EnvironmentSettings environment;
    Materials materials = Materials::full;
    SceneTree tree = SceneTree::octree;
    int octreeDepth = 11;  // levels counted with the root; of a binary tree, as fine as so many
    bool operator==(const SceneSettings&) const = default;
};

// ---- views: candidates, view set, view hierarchy

struct ViewSettings {
    std::int64_t vpls = 65536;
    std::int64_t particles = 0;  // > 0: glowing particles instead of VPLs
    int bounces = 4;
    Placement placement = Placement::importance;
    std::string file;      // PLY file whose views replace traced ones; empty = none
    int octreeDepth = 11;  // levels counted with the root
    // Views that have maps at most; others share that of a view nearby. 0: all have one.
    std::int64_t maps = 4096;
    // Do the views stand for the light of the scene's lamps?
    bool areOfLamps() const {
        return particles == 0 && (placement != Placement::random || !file.empty());
    }
    bool operator==(const ViewSettings&) const = default;
};

// ---- method: visibility, one for each side of a comparison

// Every method that has depth maps reads these.
struct MapSettings {
    int resolution = 16;   // texels across one face of a map
    int memoryMiB = 4096;  // budget
    int depthBits = 32;    // of a texel, 16 or 32; megaviews and manylods
    bool operator==(const MapSettings&) const = default;
};
// Methods that test pairs of scene and view nodes read these.
struct PairSettings {
    Traversal traversal = Traversal::lists;
    double size = 1;  // threshold of a pair's size: times that of the rules
    bool fusion = true;
    bool holeFill = true;
    int queueMemoryMiB = 256;
    double queueFill = 0.9;  // share of it that a pass is planned to fill, α of [TSK13 eq. 2]
    Cut cut = Cut::basic;
    int lazyIterations = 1;  // levels of Cut::lazy
    bool operator==(const PairSettings&) const = default;
};
// Imperfect shadow maps read these.
struct IsmSettings {
    int points = 8192;   // that each view splats
    int pool = 1048576;  // surface points that they are drawn from
    bool operator==(const IsmSettings&) const = default;
};
// View-independent rasterisation reads this.
struct VirSettings {
    double density = 2;  // points for a texel of the nearest view that they are made for
    bool operator==(const VirSettings&) const = default;
};
struct MethodSettings {
    Method method = Method::megaviews;
    uint rules = kCorrectedRules;  // kRule* of rules.glsl: of pairs and of the shadow test
    MapSettings maps = {};
    PairSettings pairs = {};
    IsmSettings ism = {};
    VirSettings vir = {};
    int referenceSamples = 256;  // paths a pixel of Method::pathtraced
    bool operator==(const MethodSettings&) const = default;
};

// ---- gather

// Which views a receiver keeps: shared by both sides of a comparison.
struct CullSettings {
    int scale = 1;      // pixels a gathered one, each way: the rest is brought up
    int level = 7;      // of the view hierarchy at most; 0 = no culling
    double cutoff = 0;  // share of the root edge beyond which views are ignored; 0 = never
    bool operator==(const CullSettings&) const = default;
};
struct GatherSettings {
    CullSettings cull;
    int samples = 8;                        // a pixel; 0: every kept view, the full sum
    int candidates = 32;                    // views weighed for each sample
    std::optional<double> clampDistance;    // share of the root edge; unset: of each view its own
    double bias = 1;                        // of the shadow test: times that of the rules
    Undecided undecided = Undecided::rays;  // off: the maps alone, by the footprint of a texel
    double mapCheck = 0.6;  // how far maps are doubted where they are sure, beside 1
    bool nearField = true;  // what the clamp takes away, given back by short rays
    int skySamples = 4;     // directions a pixel towards the sky
    int skyViews = 0;       // parallel views whose maps are asked instead of rays; 0: rays
    int skyMapRes = 128;    // of those maps
    int history = 0;        // frames before whose samples are remembered
    bool filter = true;
    bool limitFireflies = true;  // after the filter: what a sample made brighter than all around
    bool secondLook = true;      // where the filter gives light that all own samples were denied
    bool operator==(const GatherSettings&) const = default;
};

// ---- picture: what is rendered; display: how its light is shown

// Width and height, written 1920x1080 or 1920,1080.
struct Size {
    int width = 0, height = 0;
    bool operator==(const Size&) const = default;
};
struct PictureSettings {
    DebugView view = DebugView::final;
    int accumulate = 1;      // frames whose samples are averaged while nothing moves
    int pixelSamples = 1;    // points within a pixel whose light is averaged while nothing moves
    bool freshViews = true;  // each of those sets of samples is lit by views of its own
    bool temporal = false;   // edges of frames that move are averaged with those of frames before
    bool operator==(const PictureSettings&) const = default;
};
struct DisplaySettings {
    double split = 0.5;  // where the split stands, share of the width
    // The side that has less of the picture, 0 left, 1 right.
    int smallerSide() const { return split > 0.5 ? 1 : 0; }
    Difference difference = Difference::off;  // instead of the split; needs Settings::compare
    std::optional<double> differenceRange;    // end of the colour scale; unset: 99th percentile
    std::optional<double> exposureEv;         // unset: fitted on the first frame
    ToneMap toneMap = ToneMap::agx;
    bool operator==(const DisplaySettings&) const = default;
};

// ---- inspect: instruments drawn over the picture

struct InspectSettings {
    int showOctree = 0;      // scene octree nodes of this level, 1 = root; 0 = none
    int showViewOctree = 0;  // view octree nodes of this level with their cones
    bool showViews = false;  // positions, normals and flux of the views
    std::optional<std::int64_t> pickA, pickB;  // picked views by slot
    MapQuantity mapColours = MapQuantity::level;
    int step = 0;                // pairs of this step of the traversal, 1 = root pair
    std::int64_t stepScene = 0;  // the pair it starts from: node of the scene octree
    std::int64_t stepView = 0;   // and of the view octree; 0 = the roots
    StepPairs stepPairs = StepPairs::spread;
    std::array<bool, kOutcomeNames.size()> stepHidden{};  // outcomes that are not drawn
    std::optional<std::int64_t> pairScene, pairView;      // nodes of the picked pair
    bool operator==(const InspectSettings&) const = default;
};

// Nested as the stages of docs/architecture.md are. A stage takes its own struct, and runs again
// where that or the version of its input is not the one it ran with.

// What the gathered light depends on, beside the camera's pose and the time.
struct LightSettings {
    std::uint32_t seed = 0;  // of every random number
    SceneSettings scene;
    ViewSettings views;
    // Left and right of the split: same views, camera and seed. The right one only while `compare`.
    std::array<MethodSettings, 2> side;
    bool compare = false;
    GatherSettings gather;
    Size resolution = {1280, 720};

    std::size_t sideCount() const { return compare ? 2 : 1; }
    bool operator==(const LightSettings&) const = default;
};
struct Settings : LightSettings {
    CameraSettings camera;
    PictureSettings picture;
    DisplaySettings display;
    InspectSettings inspect;

    const LightSettings& light() const { return *this; }
    // Pictures of light average more than one point of a pixel; what shows data, a difference or a
    // reference is of pixel centres. Data alone takes nothing away from a picture of light.
    bool mayAveragePixels() const;
    bool averagesPixels() const { return mayAveragePixels() && showsLight(picture.view); }
    // Frames that move are averaged with those before, where these are remembered
    // (GatherSettings::history).
    bool smoothsMotion() const;
    // Each further set of a still picture's samples is of views of its own; not beside a reference,
    // which is of one set of views.
    bool averagesViews() const;
    // Sets of gather samples that a still picture averages, one a frame. Where it averages pixels
    // each set is of a point of its own (pixelOffset()).
    int setsWanted() const;
    bool operator==(const Settings&) const = default;
};

// Compares the left side with the same under another method.
void compareWith(Settings& settings, Method method);
// The left side's method; the right one follows unless it is compared.
void setMethod(Settings& settings, Method method);
// One side as if it were the only one: it stands left.
Settings sideAlone(const Settings& settings, std::size_t side);
// Takes over what is said of a scene and means nothing in another: camera, animation, time, views.
void copySceneChoices(Settings& settings, const Settings& from);
// The same settings for another scene: of these, lights, sky, exposure and what is picked, none.
Settings forAnotherScene(Settings settings);

}  // namespace mv
