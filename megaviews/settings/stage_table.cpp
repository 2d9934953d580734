#include <algorithm>

#include "megaviews/settings/statistics_table.h"

namespace mv {
namespace {

constexpr StageInfo kStages[] = {
    {"trace views", "Light paths shot through the scene, a virtual point light at each bounce."},
    {"particles", "Glowing particles moved along their paths."},
    {"sort views", "Views sorted along the Morton curve."},
    {"view hierarchy", "Octree over the views, with tight boxes and cones of directions."},
    {"G-buffer", "Surfaces the camera sees."},
    {"draw particles", "Glowing particles drawn into the picture."},
    {"shadow maps", "Depth from the lights, while they move."},
    {"direct light", "Light that comes straight from the lights."},
    {"traverse", "Pairs of scene and view nodes culled, rendered or subdivided.", true},
    {"fill", "Holes between rendered scene leaves filled.", true},
    {"fuse", "Maps of inner view nodes merged into those of the leaves.", true},
    {"rasterise", "Every triangle of the scene drawn into every view's map.", true},
    {"splat points", "Each view's points of the scene splatted into its map.", true},
    {"pull and push", "Holes between splatted points filled from coarser levels.", true},
    {"gather cull", "Views that cannot light a place set aside."},
    {"march tree", "Scene octree laid out for marching, once a scene."},
    {"gather", "Light of the sampled views summed at every pixel, shadowed by maps or marches."},
    {"gather measurements", "Shares of kept views and clamped light measured."},
    {"filter", "Cross-bilateral filter over the gathered light."},
    {"accumulate", "One more set of samples averaged into the picture."},
    {"compose", "Direct, indirect and emitted light put together."},
    {"difference", "Right side minus left side, and the end of its colour scale."},
    {"tone map", "Exposure, tone curve and sRGB encoding."},
};

}  // namespace

std::span<const StageInfo> stageTable() { return kStages; }

double totalMs(const std::vector<StageTime>& stages) {
    double sum = 0;
    for (const StageTime& stage : stages) sum += stage.ms;
    return sum;
}

double visibilityMs(const std::vector<StageTime>& stages) {
    double sum = 0;
    for (const StageTime& stage : stages) {
        const auto it =
            std::find_if(std::begin(kStages), std::end(kStages),
                         [&](const StageInfo& info) { return info.name == stage.name; });
        if (it != std::end(kStages) && it->visibility) sum += stage.ms;
    }
    return sum;
}

}  // namespace mv
