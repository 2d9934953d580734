#pragma once
// The scene octree on the GPU (SceneHierarchy -> GpuSceneHierarchy), once a scene and rule set.

#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/settings/settings.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

// Throws Error(ExitCode::impossible), saying how deep a tree would fit, if nodes of so many texels
// exceed a buffer texture of the device.
void checkTexels(const SceneHierarchy& hierarchy, std::uint64_t texelsPerNode);

// Nodes as the rules see them. An empty hierarchy gives empty buffers. Throws as checkTexels()
// does.
GpuSceneHierarchy uploadSceneHierarchy(const SceneHierarchy& hierarchy, uint rules);

// After SceneHierarchy::refit(): the nodes of what moves, and the root.
void uploadPose(const SceneHierarchy& hierarchy, uint rules, GpuSceneHierarchy& out);

}  // namespace mv
