#include <string>
#include <utility>

#include "renderer/frame_state.h"
#include "renderer/passes/scene_geometry.h"

namespace mv {

std::vector<MemoryUse> FrameRenderer::Impl::memory() const {
    std::vector<MemoryUse> out;
    const auto add = [&](std::string name, std::uint64_t used, std::uint64_t predicted = 0) {
        if (used > 0) out.push_back({std::move(name), used, predicted});
    };
    const std::uint64_t geometry = gbufferPass.geometry().bytes();
    add("scene geometry", geometry + vplPass.bytes());
    add("textures", gbufferPass.bytes() - geometry);
    add("shadow maps", directPass.bytes());
    std::uint64_t octree = 0;
    for (const auto& nodes : sceneHierarchies) {
        if (nodes) {
            octree += nodes->nodes.bytes() + nodes->attributes.bytes() + nodes->mortonKeys.bytes();
        }
    }
    add("scene octree", octree);
    if (march) add("march tree", march->nodes.bytes());
    add("surface points", surfacePoints ? surfacePoints->points.bytes() : 0);
    add("views", views.views.bytes());
    std::uint64_t viewTrees = cullTree.bytes(), gather = gatherPass.bytes();
    std::uint64_t picture = display.bytes() + radiance.bytes() + direct.bytes() + overlaid.bytes() +
                            front.bytes() + (differencePass ? differencePass->bytes() : 0);
    for (const auto& side : sides) {
        if (!side) continue;
        viewTrees += side->hierarchy.bytes();
        gather += side->records.records.bytes();
        for (const gl::Texture* t :
             {&side->gathered.irradiance, &side->gathered.unfiltered, &side->gathered.candidates,
              &side->irradiance, &side->unfiltered}) {
            gather += t->bytes();
        }
        picture += side->radiance.bytes() + side->display.bytes();
    }
    add("view octree", viewTrees);
    for (std::size_t i = 0; i < static_cast<std::size_t>(sideCount); ++i) {
        const MethodStatistics& s = sides[i]->statistics;
        const std::string which = sideCount == 1 ? "" : i == 0 ? ", left" : ", right";
        const bool queue = sides[i]->key.traversal == Traversal::queue;
        add((queue ? "pair queue" : "lists") + which, s.queueBytes, s.predictedQueueBytes);
        add("working maps" + which, s.workingMapBytes, s.predictedWorkingMapBytes);
        add("final maps" + which, s.mapBytes - s.workingMapBytes, s.predictedMapBytes);
    }
    add("G-buffer", gbuffer.bytes());
    add("gather", gather);
    add("picture", picture);
    return out;
}

}  // namespace mv
