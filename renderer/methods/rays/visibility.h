#pragma once
// Octree rays: no maps, each of the gather's samples marches the scene octree.

#include "megaviews/hierarchy/scene_hierarchy.h"
#include "renderer/gl/texel_buffer.h"
#include "renderer/passes/gather_pass.h"

namespace mv {

// The scene octree as shaders/shared/march.glsl walks it.
struct GpuMarchTree {
    gl::TexelBuffer<glm::uvec4> nodes;  // MarchTree::nodes
    std::uint32_t nodeCount = 0;
    float leafEdge = 0;  // root-cube units
};

// Throws as checkTexels() does.
GpuMarchTree uploadMarchTree(const SceneHierarchy& hierarchy);

// The tree outlives what is returned.
SampleVisibility marchedSample(const GpuMarchTree& tree);

}  // namespace mv
