#include "megaviews/settings/statistics_table.h"

namespace mv {
namespace {

using enum StageGroup;

constexpr StageInfo kStages[] = {
    {Stage::pose, views, "pose",
     "Moving geometry brought to its time on the CPU: vertices, triangle hierarchy, scene octree."},
    {Stage::guideViews, views, "guide views",
     "A pilot on the CPU: what the camera sees, and which light reaches it."},
    {Stage::traceViews, views, "trace views",
     "Light paths shot through the scene, a virtual point light at each bounce."},
    {Stage::chooseViews, views, "choose views",
     "Of the candidates those kept that light what the camera sees."},
    {Stage::particles, views, "particles", "Glowing particles moved along their paths."},
    {Stage::sortViews, views, "sort views", "Views sorted along the Morton curve."},
    {Stage::viewHierarchy, views, "view hierarchy",
     "Octree over the views, with tight boxes and cones of directions."},
    {Stage::gBuffer, surfaces, "G-buffer", "Surfaces the camera sees."},
    {Stage::drawParticles, surfaces, "draw particles", "Glowing particles drawn into the picture."},
    {Stage::drawSky, surfaces, "draw sky", "The sky behind the surfaces."},
    {Stage::directLight, surfaces, "direct light", "Light that comes straight from the lights."},
    {Stage::reflections, surfaces, "reflections",
     "Rays from glossy surfaces to what they reflect, and their filter."},
    {Stage::traverse, maps, "traverse",
     "Pairs of scene and view nodes culled, rendered or subdivided."},
    {Stage::fill, maps, "fill", "Holes between rendered scene leaves filled."},
    {Stage::fuse, maps, "fuse", "Maps of inner view nodes merged into those of the leaves."},
    {Stage::rasterise, maps, "rasterise",
     "Every triangle of the scene drawn into every view's map."},
    {Stage::makePoints, maps, "make points",
     "Points of the triangles made, as dense as the views ask."},
    {Stage::splatPoints, maps, "splat points",
     "Points of the scene splatted into the maps of views."},
    {Stage::pullAndPush, maps, "pull and push",
     "Holes between splatted points filled from coarser levels."},
    {Stage::gatherCull, gather, "gather cull", "Views that cannot light a place set aside."},
    {Stage::marchTree, gather, "march tree",
     "Scene octree laid out for marching, once a scene, or a pose of it."},
    {Stage::skyMaps, gather, "sky maps",
     "Depth maps of the scene along the sky's parallel views, once a geometry and sky."},
    {Stage::gather, gather, "gather",
     "Light of the sampled views summed at every pixel, shadowed by maps or marches."},
    {Stage::nearField, gather, "near field",
     "Light of surfaces nearer than their views are to each other, by short rays."},
    {Stage::skyLight, gather, "sky light",
     "Light of the sky at every pixel, by rays towards it or the maps of its views."},
    {Stage::history, gather, "history",
     "Light of the frames before brought to where its surfaces are seen now, and averaged."},
    {Stage::filter, gather, "filter",
     "Cross-bilateral filter over the gathered light, and pixels gathered again."},
    {Stage::accumulate, gather, "accumulate", "One more set of samples averaged into the picture."},
    {Stage::compose, picture, "compose", "Direct, indirect and emitted light put together."},
    {Stage::sharing, picture, "sharing",
     "Views that share the pair which renders a pixel's surface, counted at every pixel."},
    {Stage::shared, picture, "shared", "Pairs that two picked views have in common, in colours."},
    {Stage::difference, picture, "difference",
     "Right side minus left side, and the end of its colour scale."},
    {Stage::toneMap, picture, "tone map", "Exposure, tone curve and sRGB encoding."},
    {Stage::overlay, picture, "overlay", "Lines drawn over the picture."},
};

constexpr bool rowsStandInOrder() {
    for (std::size_t i = 0; i < std::size(kStages); ++i) {
        if (static_cast<std::size_t>(kStages[i].stage) != i) return false;
    }
    return std::size(kStages) == static_cast<std::size_t>(Stage::overlay) + 1;
}
static_assert(rowsStandInOrder(), "a row for each Stage, in its order");

}  // namespace

std::span<const StageInfo> stageTable() { return kStages; }

const StageInfo& infoOf(Stage stage) { return kStages[static_cast<std::size_t>(stage)]; }

double groupMs(const std::vector<StageTime>& stages, StageGroup group) {
    double sum = 0;
    for (const StageTime& time : stages) sum += infoOf(time.stage).group == group ? time.ms : 0;
    return sum;
}

}  // namespace mv
