#include <algorithm>
#include <string>
#include <utility>

#include "renderer/frame_state.h"
#include "renderer/gl/memory.h"
#include "renderer/passes/scene_geometry.h"

namespace mv {

std::vector<MemoryUse> FrameRenderer::Impl::memory() const {
    std::vector<MemoryUse> out;
    const auto add = [&](std::string name, std::uint64_t used, std::uint64_t predicted = 0) {
        if (used > 0) out.push_back({std::move(name), used, predicted});
    };
    const std::uint64_t geometry = gbufferPass.geometry().bytes();
    add("scene geometry", geometry + vplPass.bytes() + thinViewsPass.bytes());
    add("textures", gbufferPass.bytes() - geometry);
    add("sky", lights.sky.bytes());
    add("punctual lights", lights.punctual.bytes());
    add("sky maps", lights.skyMaps ? lights.skyMaps->bytes() : 0);
    add("scene octree", sceneOnGpu->nodeBytes());
    for (const auto& side : sides) {
        if (!side || !side->visibility) continue;
        for (const MemoryUse& use : side->visibility->memory()) add(use.name, use.usedBytes);
    }
    std::uint64_t viewBytes = views.frame.views.views.bytes() + views.spare.views.bytes();
    std::uint64_t viewTrees = views.frame.treeBytes();
    if (views.next) viewBytes += views.next->views.views.bytes();
    if (views.ofSet) {
        viewBytes += views.ofSet->views.views.bytes();
        viewTrees += views.ofSet->treeBytes();
    }
    add("views", viewBytes);
    std::uint64_t gather = gatherPass.bytes(), setMaps = 0;
    std::uint64_t pictureBytes = picture.display.bytes() + picture.radiance.bytes() +
                                 surfaces.direct.bytes() + late.front.bytes() +
                                 (differencePass ? differencePass->bytes() : 0);
    std::uint64_t reflectedBytes = reflections.bytes();
    for (const auto& side : sides) {
        if (!side) continue;
        reflectedBytes += side->reflected.bytes();
        const GpuViewHierarchy* tree = &mapHierarchy(*side);
        if (tree != &views.frame.tree && tree != &views.frame.mapViews.subset.tree)
            viewTrees += tree->bytes();
        gather += side->records.records.records.bytes() + side->history.bytes();
        if (side->setMaps) {
            const SetMaps& own = *side->setMaps;
            gather += own.records.records.records.bytes();
            setMaps += own.statistics.mapBytes + own.statistics.queueBytes;
            if (own.visibility) {
                for (const MemoryUse& use : own.visibility->memory()) setMaps += use.usedBytes;
            }
        }
        gather += side->gathered.bytes() + side->irradiance.bytes() + side->unfiltered.bytes();
        pictureBytes += side->radiance.bytes() + side->display.bytes() + side->points.bytes() +
                        side->rememberedPoints.bytes() + side->temporal.bytes();
    }
    add("view octree", viewTrees);
    for (std::size_t i = 0; i < static_cast<std::size_t>(sideCount); ++i) {
        const MethodStatistics& s = sides[i]->statistics;
        const std::string which = sideCount == 1 ? "" : i == 0 ? ", left" : ", right";
        const bool queue = sides[i]->settings.pairs.traversal == Traversal::queue;
        const char* name = s.cuts.nodes > 0 ? "kept cuts" : queue ? "pair queue" : "lists";
        add(name + which, s.queueBytes, s.predictedQueueBytes);
        add("working maps" + which, s.workingMapBytes, s.predictedWorkingMapBytes);
        add("final maps" + which, s.mapBytes - s.workingMapBytes, s.predictedMapBytes);
    }
    add("maps of fresh views", setMaps);
    add("G-buffer", surfaces.gbuffer.bytes() + (pixelPoint ? pixelPoint->bytes() : 0));
    add("gather", gather);
    add("reflections", reflectedBytes);
    add("picture", pictureBytes);
    add("overlay", overlay.pass ? overlay.pass->bytes() + overlay.picture.bytes() : 0);
    // Counters, tables of a few KiB, read-backs, pictures of the window.
    std::uint64_t named = 0;
    for (const MemoryUse& use : out) named += use.usedBytes;
    add("other", std::max(gl::heldMemory(), named) - named);
    return out;
}

}  // namespace mv
