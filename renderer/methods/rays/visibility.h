#pragma once
// Octree rays: no maps, each of the gather's samples marches the scene octree.

#include "renderer/passes/gather_pass.h"

namespace mv {

// The tree outlives what is returned.
SampleVisibility marchedSample(const GpuMarchTree& tree);

}  // namespace mv
