#pragma once
// What the panels show that is neither a setting nor a statistic, and what they ask for in return:
// plain data on both sides. The application fills Model before each frame and acts on Requests
// after it. Panels write Model too, but only its toasts, what is open or being picked, what a
// comment marks as set by the panels, timeS while it is scrubbed, and an error that is dismissed.
// What belongs to an instrument is only read while Model::instrument names it.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "megaviews/settings/actions.h"
#include "megaviews/settings/settings.h"

namespace mv::ui {

using Float3 = std::array<float, 3>;

// The left dock shows one instrument at a time, or is not there.
enum class Instrument { profiler, traversal, memory, views, pixel, steps, errors };
// What the next click on the picture picks.
enum class Picking { none, viewA, viewB, pixel, pair, sceneNode, viewNode };
// What the file browser is open for.
enum class Browse { none, open, loadState, saveState, saveScene, loadReference };

// A texture the application owns, for ImGui's renderer.
struct Picture {
    void* texture = nullptr;  // ImTextureID
    int width = 0, height = 0;
    bool bottomUp = true;  // GL's order of rows
};

// Something drawn over or into the picture that a colour explains.
struct LegendEntry {
    std::string label;
    Float3 colour{};                     // display values, 0..1
    std::optional<std::uint64_t> count;  // shown if known
};
struct Legend {
    std::string title;  // "views that share a pair"
    std::string unit;   // behind the numbers of the scale
    double low = 0, high = 1;
    bool logarithmic = false;
    std::vector<Float3> scale;  // colours from low to high; empty: entries only
    std::vector<LegendEntry> entries;
};

struct LightRow {
    std::string name, kind;  // "spot", "point", "directional"
    bool hasPosition = true, hasDirection = true, hasCone = false;
    bool edited = false;                            // differs from the scene's file
    std::array<double, 3> position{}, direction{};  // world units; unit length
    std::array<double, 3> intensity{};              // W/sr, or W/m^2; all 0: it is out
    std::array<double, 2> cone{};                   // half angles, degrees
    // Where it is in the window, and the end of a line along its direction; unset: out of sight.
    std::optional<std::array<float, 2>> place, tip;
};
// A handle of a light was dragged to a place in the window.
struct LightDrag {
    std::size_t light = 0;
    bool tip = false;
    float x = 0, y = 0;
    bool operator==(const LightDrag&) const = default;
};
struct LightEdit {
    std::size_t light = 0;  // index into Model::lights
    std::optional<std::array<double, 3>> position, direction, intensity;
    std::optional<std::array<double, 2>> cone;
    std::optional<bool> on;  // out, or as bright as the scene has it
    bool reset = false;      // back to what the scene says
    bool operator==(const LightEdit&) const = default;
};

struct RecentFile {
    std::string path;
    bool exists = true;
};

// A built-in scene on the start page.
struct StartTile {
    std::string scene;
    Picture picture;
};

// ---------------------------------------------------------------- views panel
struct ViewRow {
    std::int64_t slot = -1;
    int bounce = 0;  // 1 = first; 0 = not from a light path
    std::int64_t leaf = -1;
    Float3 position{}, normal{};  // root-cube units
    Float3 flux{};                // W
};
struct MapPicture {
    std::string name;  // "fused", "level 3, 128 views"
    bool fused = true;
    Picture picture;  // both faces side by side, texels in the colours of mapLegend
};
struct PickedView {
    ViewRow view;
    std::uint64_t viewsInLeaf = 0;
    std::vector<MapPicture> maps;  // the fused one first, then one an ancestor, root first
};
// What two picked views share, by level of the view octree.
struct SharedLevel {
    int level = 1;                           // 1 = root
    bool common = false;                     // both views lie in this node
    std::uint64_t viewsOfNode = 0;           // of the first view's node
    std::uint64_t pairsA = 0, pairsB = 0;    // rendered into either view's node; equal if common
    std::uint64_t texelsA = 0, texelsB = 0;  // of either fused map that come from this level
};
// A texel of a map that is shown: of which view, which of its maps, and where in the picture.
struct MapPlace {
    bool ofA = true;
    int map = 0, x = 0, y = 0;
    bool operator==(const MapPlace&) const = default;
};
struct MapTexel {
    MapPlace place;
    std::string face;     // "Front (+x)"
    Float3 direction{};   // world, unit
    std::string content;  // what was seen there, in lines
};
struct ViewsData {
    // Of the views that have maps: by bounce ([0]: the first), and leaves by the views they hold.
    std::vector<std::uint64_t> perBounce, leavesByViews;
    std::vector<ViewRow> rows;  // may be capped: `total` says how many there are
    std::uint64_t total = 0;
    std::optional<PickedView> a, b;
    std::vector<SharedLevel> shared;
    Legend mapLegend;                 // colours of the maps' texels
    std::optional<MapPlace> hovered;  // set by the panel,
    std::optional<MapTexel> texel;    // and what the map says there
};

// ---------------------------------------------------------------- pixel panel
struct PixelValues {
    int x = 0, y = 0;  // of the picture, top left first
    Float3 radiance{}, direct{}, indirect{}, albedo{}, normal{};
    std::array<std::uint8_t, 3> display{};       // sRGB, as the picture shows it
    std::optional<std::array<Float3, 2>> sides;  // radiance of left and right, of a comparison
    bool surface = false;  // false: background; depth and what follows from it say nothing
    double depth = 0;      // world units
    std::array<double, 3> position{};  // world units
};
struct GatheredView {
    std::int64_t slot = -1;
    Float3 contribution{};  // to the pixel's radiance
    double distance = 0;    // world units
    bool visible = true;
};
struct PixelData {
    std::optional<PixelValues> hover, picked;
    std::vector<GatheredView> gathered;  // of the picked pixel
    Picture magnified;                   // the displayed picture, for the magnifier; may be absent
};

// ---------------------------------------------------------------- steps panel
struct PickedPair {
    std::string scene, view;                              // "node 12, level 4"
    std::string decision;                                 // "rendered"
    Float3 colour{};                                      // that it is drawn in
    std::string reason;                                   // a sentence
    std::vector<std::array<std::string, 2>> comparisons;  // "size, texels", "0.81 < 2"
};
struct StepsData {
    int shown = 0;               // 1 = the pairs it starts from; 0: none
    int steps = 0;               // that there are, or known so far
    bool last = false;           // of which the shown one is the last,
    bool finished = false;       // after which no pair is left; else there would be too many
    std::uint64_t pairs = 0;     // of the shown step
    std::uint64_t eligible = 0;  // of them neither hidden nor apart from what was picked
    std::uint64_t drawn = 0, links = 0;  // of those
    std::vector<LegendEntry> decisions;  // by kOutcomeNames: colours as drawn, counts
    std::optional<PickedPair> picked;
    std::string sceneNode, viewNode;  // that it starts from: as PickedPair
};

// ---------------------------------------------------------------- errors panel
struct ErrorValue {
    std::string label, unit, help;
    bool higherIsBetter = false;
    std::optional<double> value;  // not yet computed; infinite for equal pictures
};
struct ErrorTable {
    std::string of, against;  // "ManyLoDs", "MegaViews"
    std::vector<ErrorValue> values;
    std::uint64_t badPixels = 0;  // left out
    std::string reason;           // why it holds nothing
};
struct ErrorsData {
    std::vector<ErrorTable> tables;
    bool waits = false;  // for a picture that is complete

    // Depth maps against exact ones; `against` says how many views and texels.
    int mapViews = 0;              // of so many views; set by the panel, 0: not asked for
    std::vector<ErrorTable> maps;  // one a side, the same values in each
    bool mapsWait = false;         // for exact maps or for what they are compared with
};

struct TourStep {
    std::string title, text;
    bool back = false, next = false;  // is there another one?
};

// A picture that is being made while the window is drawn.
struct Work {
    std::string stage;
    float done = 0;       // of the stage
    double elapsedS = 0;  // since it was begun
    double wholeS = 0;    // that all of it takes at most; 0: not known
    bool draft = false;   // of what moves or was changed
};

// Whole frames, measured one after the other.
struct FrameRun {
    int wanted = 32;  // set by the panel
    int done = 0;     // of the picture that is shown
    bool running = false;
};

struct Toast {
    std::string text;
    float ageS = 0;  // advanced by the panels, which erase it in the end
};

struct Model {
    // scene
    std::string sceneName;
    std::string sceneSummary;                // "262,267 triangles, 3,101,222 octree leaves"
    std::vector<std::string> cameras;        // names; the settings hold the chosen one
    CameraSettings camera;                   // that the picture is seen by, in numbers
    std::optional<std::size_t> sceneCamera;  // through which of them the picture is seen
    std::vector<std::string> animations;
    std::vector<std::string> variants;  // of materials
    // The scene's report says what is wrong with its file, what was added, which extensions
    // are read, and what is left out.
    std::vector<std::string> warnings, notes, extensions, ignored;
    std::vector<LightRow> lights;
    bool outside = false;             // the camera has left the scene's rooms
    bool lightsOpen = false;          // set by the panels: places and tips are wanted
    std::array<bool, 9> bookmarks{};  // which are stored
    std::vector<RecentFile> recent;   // newest first
    std::vector<std::string> builtinScenes;

    // program
    std::string renderer;              // GL renderer string
    bool software = false;             // announced in the status bar
    std::vector<std::string> notices;  // what the program decided for the user: "draft ..."
    std::string preset;                // whose values the settings have; empty: none's
    Settings defaults;                 // what a reset gives, of settings that it changes
    bool canUndo = false, canRedo = false;
    FrameRun frameRun;
    std::optional<Work> work;       // the picture that is being made, where that takes long
    bool settled = false;           // for a draft: the whole picture was given up
    bool atRest = false;            // the picture is whole: no frame follows
    double foreseenS = 0;           // that the whole picture after a draft takes; 0: none follows
    int setsWanted = 1;             // that the picture averages once nothing moves
    std::optional<Settings> draft;  // what the picture was made with, while it is a draft
    bool renderingPaused = false, vsync = true, fullScreen = false;

    // transport
    bool playing = true;
    double speed = 1;       // of the animation
    double animationS = 0;  // its duration, 0 = nothing moves
    double timeS = 0;

    // what is open; the panels close and open these too
    bool hidden = false;
    bool help = false;
    bool palette = false;  // the list of commands
    bool aboutScene = false;
    bool start = false;  // the start page, and what it offers beside recent files
    std::vector<StartTile> startTiles;
    std::vector<std::string> startFound;
    bool otherSide = false;  // the other side fills the picture while a key is held
    std::optional<Instrument> instrument;
    Picking picking = Picking::none;
    Browse browse = Browse::none;
    std::string browseFolder;  // where the browser starts; follows it, also when it is given up
    double budgetMs = 33.3;    // line in the frame-time plot, set by the panels

    // loading and trouble
    std::string loadingStage;  // non-empty while a scene loads
    float loadingFraction = 0;
    std::string error, errorHint;           // a dialog until dismissed: cause, what helps
    std::vector<std::string> shaderErrors;  // shown until it is empty again
    std::vector<Toast> toasts;
    std::optional<TourStep> tour;  // while it is taken

    // a reference in the picture that is not complete; empty: none
    std::string referenceStage;
    float referenceFraction = 0;  // below 0: not begun

    // picture
    std::vector<Legend> legends;       // debug view and overlays in use
    std::optional<Legend> difference;  // while a difference is shown

    // instruments; filled only while open
    std::optional<std::uint64_t> freeGpuBytes;
    ViewsData views;
    PixelData pixel;
    StepsData steps;
    ErrorsData errors;
};

// What the user asked for while the panels were drawn.
struct Requests {
    std::vector<Action> actions;
    bool timeChanged = false;  // Model::timeS was scrubbed
    bool errorDismissed = false;
    bool cancelLoading = false;
    bool clearRecent = false;
    int tour = 0;  // steps of the tour forward or backward
    bool leaveTour = false;
    bool redraw = false;        // something moves by itself: do not sleep until the next event
    std::string openFile;       // scene, state or picture to open
    std::string loadState;      // state or picture to restore
    std::string saveState;      // file to write
    std::string saveScene;      // file to write
    std::string loadReference;  // picture to measure against
    std::vector<LightEdit> lights;
    std::optional<LightDrag> lightDrag;
    bool cancelPicture = false;  // a draft is enough
    bool wholePicture = false;   // it is not after all
    bool operator==(const Requests&) const = default;
};

}  // namespace mv::ui
