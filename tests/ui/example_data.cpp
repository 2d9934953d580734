#include <cmath>
#include <random>

#include "screen.h"

namespace mv::ui {
namespace {

PairCounts pairsAt(std::size_t level, double whole) {
    // Most pairs live in the middle of the tree; deep ones are rendered, shallow ones subdivided.
    const double x = static_cast<double>(level);
    const double n = whole * std::exp(-0.5 * (x - 6) * (x - 6) / 3.5);
    PairCounts p;
    p.processed = static_cast<std::uint64_t>(n);
    p.culled = p.processed / 4;
    p.rendered = static_cast<std::uint64_t>(n * 0.55 / (1 + std::exp(5 - x)));
    p.forced = level == 7 ? p.rendered / 6 : 0;
    p.skipped = p.processed / 200;
    p.subdivided = p.processed - p.culled - p.rendered - p.skipped;
    p.renderedViews = p.rendered * 9;
    return p;
}

MethodStatistics methodOf(double whole, std::uint64_t mib) {
    MethodStatistics m;
    for (std::size_t level = 0; level < 8; ++level) {
        const PairCounts p = pairsAt(level, whole);
        m.pairsPerLevel.push_back(p);
        m.pairs += p;
        m.occupancy.push_back(p.processed);
        m.occupancy.push_back(p.processed * 3 / 2);
    }
    m.queuePeakPairs = 1204531;
    m.passes.made = 2;
    m.queueBytes = mib << 19;
    m.mapBytes = mib << 20;
    m.stages = {{Stage::traverse, whole / 9000},
                {Stage::fill, 12.25},
                {Stage::fuse, 48.5},
                {Stage::gather, 310.75}};
    m.mapsMs = whole / 9000 + 12.25 + 48.5;
    return m;
}

void fillViews(ViewsData& v) {
    std::mt19937 random(7);
    const auto unit = [&] { return static_cast<float>(random() % 1000) / 1000; };
    v.perBounce = {3920, 3144, 2210, 1630};
    v.leavesByViews = {0, 812, 604, 377, 210, 122, 61, 30, 12};
    v.total = 16384;
    for (std::int64_t slot = 0; slot < 4096; ++slot) {
        ViewRow row;
        row.slot = slot;
        row.bounce = 1 + static_cast<int>(slot % 4);
        row.leaf = slot / 5;
        row.position = {unit(), unit(), unit()};
        row.normal = {0, 1, 0};
        row.flux = {unit(), unit(), unit()};
        v.rows.push_back(row);
    }
    for (auto* picked : {&v.a, &v.b}) {
        *picked = PickedView{};
        (*picked)->view = v.rows[picked == &v.a ? 1204 : 2551];
        (*picked)->viewsInLeaf = 5;
        for (const char* name : {"fused", "level 1, 4,096 views", "level 2, 610 views"}) {
            MapPicture map;
            map.name = name;
            map.fused = (*picked)->maps.empty();
            map.picture.width = 64;
            map.picture.height = 32;
            (*picked)->maps.push_back(map);
        }
    }
    v.shared = {{1, true, 4096, 88, 88, 12, 11},
                {2, true, 610, 1240, 1240, 160, 155},
                {3, false, 122, 902, 877, 201, 190},
                {4, false, 5, 410, 433, 92, 100}};
    v.mapLegend.title = "Scene level a texel was rendered at";
    v.mapLegend.entries = {{"level 5", {0.27f, 0.0f, 0.33f}, 40},
                           {"level 6", {0.19f, 0.41f, 0.56f}, 210},
                           {"level 7", {0.99f, 0.91f, 0.14f}, 262}};
}

void fillPixel(PixelData& p) {
    PixelValues hover;
    hover.x = 512;
    hover.y = 288;
    hover.radiance = {1.284f, 0.733f, 0.0412f};
    hover.display = {239, 189, 72};
    hover.direct = {1.1f, 0.6f, 0.02f};
    hover.indirect = {0.184f, 0.133f, 0.0212f};
    hover.albedo = {0.73f, 0.71f, 0.68f};
    hover.normal = {0, 1, 0};
    hover.surface = true;
    hover.depth = 4.812;
    hover.position = {1.25, 0.0, -3.5};
    p.hover = p.picked = hover;
    for (int i = 0; i < 64; ++i) {
        GatheredView g;
        g.slot = 31 + 61 * i;
        const float x = 0.02f / static_cast<float>(1 + (i * 37) % 64);
        g.contribution = {x, x * 0.8f, x * 0.5f};
        g.distance = 0.4 + 0.05 * i;
        g.visible = i % 3 != 0;
        p.gathered.push_back(g);
    }
}

}  // namespace

void fillExample(Settings& settings, Model& model, FrameStatistics& statistics) {
    settings.picture.accumulate = 64;
    model.setsWanted = 64;
    model.sceneName = "sponza";
    model.sceneSummary = "262,267 triangles, 3,101,222 octree leaves";
    model.cameras = {"Nave", "Gallery", "Lion's head, from the left"};
    model.lights = {{"Sun",
                     "directional",
                     false,
                     true,
                     false,
                     false,
                     {},
                     {0.2, -0.9, 0.1},
                     {3, 2.9, 2.5},
                     {},
                     {},
                     {}},
                    {"Lamp",
                     "spot",
                     true,
                     true,
                     true,
                     true,
                     {1.5, 2.25, -0.75},
                     {0, -1, 0},
                     {40, 30, 20},
                     {20, 35},
                     {},
                     {}}};
    model.builtinScenes = {"builtin:cornell", "builtin:atrium"};
    model.ignored = {"KHR_materials_sheen", "occlusion maps"};
    model.notes = {"no light in the file: a lamp was hung in the room"};
    model.bookmarks = {true, true, false, false, true, false, false, false, false};
    model.recent = {{"/data/scenes/sponza/Sponza.gltf", true}, {"/data/gone.glb", false}};
    model.renderer = "llvmpipe (LLVM 15.0.6, 256 bits)";
    model.software = true;
    model.notices = {"octree of 8 levels, 16 samples; draft while moving"};
    model.preset = "balanced";
    model.animationS = 10;
    model.timeS = 3.2;
    fillViews(model.views);
    fillPixel(model.pixel);
    const ErrorValue mse{"MSE", "", "Mean squared error.", false, 0.0001234};
    const ErrorValue psnr{"PSNR", "dB", "Peak signal to noise ratio.", true, 24.8127};
    const ErrorValue late{"HDR-FLIP", "", "Not there yet.", false, std::nullopt};
    model.errors.tables = {
        {"Right: ManyLoDs", "Left: MegaViews", {mse, psnr, late}, 3, {}},
        {"Left: MegaViews", "/a/long/way/to/a/reference.exr", {}, 0, "It has another size."}};
    const ErrorValue off{"Off by 10 %", "%", "Off by more than 10 %.", false, 32.1763};
    const ErrorValue range{"Out of range", "%", "Outside what rays find.", false, std::nullopt};
    model.errors.mapViews = 4096;
    model.errors.mapsWait = true;
    model.errors.maps = {
        {"Left: MegaViews", "4,096 views, 1,155,319 texels", {off, range}, 0, {}},
        {"Right: imperfect maps", "4,096 views, 55,319 texels", {off, range}, 12, {}}};
    model.referenceStage = "exact maps";
    model.referenceFraction = 0.37f;
    model.steps.steps = 19;
    model.steps.pairs = model.steps.eligible = 12400;
    model.steps.drawn = 10000;
    model.steps.links = 120;
    model.steps.decisions = {
        {"culled", {0.48f, 0.51f, 0.56f}, 4200},     {"rendered", {0.34f, 0.71f, 0.91f}, 5000},
        {"forced", {0.84f, 0.37f, 0.0f}, 100},       {"split scene", {0.94f, 0.62f, 0.0f}, 2050},
        {"split view", {0.94f, 0.89f, 0.26f}, 1000}, {"skipped", {0.8f, 0.47f, 0.65f}, 50}};
    model.steps.picked = PickedPair{
        "node 3101222, level 11, a leaf",
        "node 5120, level 11, 1 view, a leaf",
        "skipped",
        {0.8f, 0.47f, 0.65f},
        "Both nodes are leaves, and the view lies within the ball of the scene node, "
        "0.00012 from its centre, radius 0.0008; it lies on the surface, 1.2e-06 off its "
        "plane where 6.02e-05 is clear.",
        {{"below the horizon", "-0.000312 <= 1e-06"},
         {"size, texels", "inf >= 2"},
         {"distance, radius", "0.00012 <= 0.0008"},
         {"off its surface", "1.2e-06 <= 6.02e-05"},
         {"radius, twice the views'", "0.000312 < 0.00112"}}};
    model.steps.sceneNode = "Scene node 0: level 1, 3,101,222 leaves below";
    model.steps.viewNode = "View node 0: level 1, 4,096 views below";

    FrameStatistics& s = statistics;
    s.clock = "wall clock, synchronised";
    s.viewsRequested = 4096;
    s.viewsAlive = 3920;
    s.viewNodes = 5120;
    s.viewLeaves = 1204;
    s.stagesOfBothSides = {{Stage::traceViews, 4.5}, {Stage::viewHierarchy, 2.25},
                           {Stage::gBuffer, 31.5},   {Stage::guideViews, 18.75},
                           {Stage::directLight, 22}, {Stage::toneMap, 3.5}};
    s.methods = {methodOf(812345, 128)};
    s.memory = {{"scene octree", 98ull << 20, 0},     {"view octree", 700ull << 10, 768ull << 10},
                {"maps", 128ull << 20, 140ull << 20}, {"lists", 64ull << 20, 256ull << 20},
                {"textures", 310ull << 20, 0},        {"G-buffer", 28ull << 20, 0}};
    s.accumulatedFrames = 12;
    s.exposureEv = 1.25;
    s.differenceRange = 0.125;
    s.frameMs = 427.3;
}

}  // namespace mv::ui
