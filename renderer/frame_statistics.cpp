// What a frame says of itself.

#include <algorithm>

#include "megaviews/settings/statistics_table.h"
#include "renderer/frame_state.h"
#include "renderer/gl/memory.h"

namespace mv {
namespace {

void tellViews(const GpuViewHierarchy& tree, FrameStatistics& statistics) {
    statistics.viewsAlive = tree.aliveCount;
    statistics.viewNodes = tree.nodeCount;
    statistics.viewLeaves = tree.leafCount;
    for (std::size_t l = 0; l + 1 < tree.levelBegin.size(); ++l) {
        statistics.viewNodesPerLevel.push_back(tree.levelBegin[l + 1] - tree.levelBegin[l]);
    }
}

}  // namespace

void FrameRenderer::Impl::tell(const Settings& settings,
                               std::chrono::steady_clock::time_point start,
                               FrameStatistics& statistics) {
    statistics.clock = profiler.clock();
    const bool timed = profiler.endFrame();
    if (timed) statistics.stagesOfBothSides = profiler.stages(kBothSides);
    for (std::size_t i = 0; i < static_cast<std::size_t>(sideCount); ++i) {
        MethodStatistics& method = sides[i]->statistics;
        method.stages = timed ? profiler.stages(ownerOf(i)) : std::vector<StageTime>{};
        if (const double ms = groupMs(method.stages, StageGroup::maps); ms > 0) method.mapsMs = ms;
        if (const double ms = groupMs(method.stages, StageGroup::gather); ms > 0) {
            method.gatherMs = ms;
        }
        statistics.methods.push_back(method);
        statistics.badPixels += sides[i]->badPixels;
    }
    statistics.viewsRequested = requestedViews(settings.views);
    tellViews(views.frame.tree, statistics);
    statistics.skyPoints = lights.skyMaps ? lights.skyMaps->points() : 0;
    statistics.exposureEv = exposure.usedEv;
    statistics.differenceRange = picture.differenceRange;
    statistics.memory = memory();
    statistics.freeGpuBytes = gl::freeVideoMemory();
    using Milliseconds = std::chrono::duration<double, std::milli>;
    statistics.frameMs =
        Milliseconds(std::chrono::steady_clock::now() - start).count() - profiler.watchMs();
    if (results == gl::Results::late) {
        // The CPU's time covers the submission alone; the GPU's is the sum of the stages.
        if (timed) late.gpuMs = 0;
        for (int owner = kBothSides; timed && owner <= sideCount; ++owner) {
            for (const StageTime& time : profiler.stages(owner)) late.gpuMs += time.ms;
        }
        statistics.frameMs = std::max(statistics.frameMs, late.gpuMs);
    }
}

}  // namespace mv
