#include "renderer/passes/scene_hierarchy_upload.h"

#include <span>

#include "megaviews/core/error.h"
#include "megaviews/hierarchy/moving_surface.h"
#include "renderer/gl/context.h"

namespace mv {

void checkTexels(const SceneHierarchy& h, std::uint64_t texelsPerNode) {
    const auto limit = static_cast<std::uint64_t>(gl::limits().maxTextureBufferTexels);
    if (h.nodes.size() * texelsPerNode <= limit) return;
    if (h.samples) {
        throw Error(ExitCode::impossible,
                    "the scene tree of " + std::to_string(h.nodes.size()) +
                        " nodes is larger than a buffer texture of this device (" +
                        std::to_string(limit) +
                        " texels): each level less of --scene-depth takes a quarter of them");
    }
    int fits = 0;
    while (fits < h.levels &&
           h.levelBegin[static_cast<std::size_t>(fits) + 1] * texelsPerNode <= limit)
        ++fits;
    throw Error(ExitCode::impossible,
                "the scene octree of " + std::to_string(h.nodes.size()) +
                    " nodes is larger than a buffer texture of this device (" +
                    std::to_string(limit) + " texels): --scene-depth " + std::to_string(fits) +
                    " would fit");
}

GpuSceneHierarchy uploadSceneHierarchy(const SceneHierarchy& h, uint rules) {
    checkTexels(h, sizeof(SceneNode) / 16);
    GpuSceneHierarchy out;
    out.levels = h.levels;
    out.levelBegin = h.levelBegin;
    if (h.moving) out.movingBegin = h.moving->begin;
    out.nodeCount = static_cast<std::uint32_t>(h.nodes.size());
    SceneNodes made;
    out.nodes = {"scene nodes", h.nodesUnder(rules, made)};
    return out;
}

void uploadPose(const SceneHierarchy& h, uint rules, GpuSceneHierarchy& out) {
    SceneNodes made;
    const std::span<const SceneNode> nodes = h.nodesUnder(rules, made);
    for (std::size_t level = 0; level < h.moving->begin.size(); ++level) {
        const std::uint32_t first = h.moving->begin[level];
        out.nodes.write(first, nodes.subspan(first, h.levelBegin[level + 1] - first));
    }
}

}  // namespace mv
