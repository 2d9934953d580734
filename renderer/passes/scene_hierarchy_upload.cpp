#include "renderer/passes/scene_hierarchy_upload.h"

#include "megaviews/settings/error.h"
#include "renderer/gl/context.h"

namespace mv {
namespace {

constexpr std::uint64_t kTexelsPerNode = sizeof(SceneNode) / 16;

// Nodes are read as texels, attributes and keys too where they are large: the texel limit decides.
void checkSize(const SceneHierarchy& h) {
    const auto limit = static_cast<std::uint64_t>(gl::limits().maxTextureBufferTexels);
    if (h.nodes.size() * kTexelsPerNode <= limit) return;
    int fits = 0;
    while (fits < h.levels &&
           h.levelBegin[static_cast<std::size_t>(fits) + 1] * kTexelsPerNode <= limit)
        ++fits;
    throw Error(ExitCode::impossible,
                "the scene octree of " + std::to_string(h.nodes.size()) +
                    " nodes is larger than a buffer texture of this device (" +
                    std::to_string(limit) + " texels): --scene-depth " + std::to_string(fits) +
                    " would fit");
}

}  // namespace

GpuSceneHierarchy uploadSceneHierarchy(const SceneHierarchy& h, Rules rules) {
    checkSize(h);
    GpuSceneHierarchy out;
    out.levels = h.levels;
    out.levelBegin = h.levelBegin;
    out.nodeCount = static_cast<std::uint32_t>(h.nodes.size());
    out.nodes = rules == Rules::published ? gl::Buffer::of("scene nodes", h.publishedNodes())
                                          : gl::Buffer::of("scene nodes", h.nodes);
    out.nodesTexels = gl::TextureBuffer("scene nodes", GL_RGBA32UI, out.nodes);
    out.attributes = gl::Buffer::of("scene node attributes", h.attributes);
    out.mortonKeys = gl::Buffer::of("scene node keys", h.mortonKeys);
    return out;
}

}  // namespace mv
