#pragma once
// The scene octree on the GPU (SceneHierarchy -> GpuSceneHierarchy), once a scene and rule set.

#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/settings/settings.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

// Nodes as the rules see them. An empty hierarchy gives empty
// buffers. Throws Error(ExitCode::impossible) if the nodes exceed a buffer texture or storage
// block of the device, saying how deep a tree would fit.
GpuSceneHierarchy uploadSceneHierarchy(const SceneHierarchy& hierarchy, uint rules);

// After SceneHierarchy::refit(): the nodes of what moves, and the root.
void uploadPose(const SceneHierarchy& hierarchy, uint rules, GpuSceneHierarchy& out);

// The tree that rays march through, made from the hierarchy; throws as above.
GpuMarchTree uploadMarchTree(const SceneHierarchy& hierarchy);

}  // namespace mv
