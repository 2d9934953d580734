#pragma once
// What culling keeps of the views and the clamp of their light, read back.

#include "renderer/passes/gather_sum.h"

namespace mv {

// See GatherPass::readShares().
GatherShares readGatherShares(GatherSum& sum, const GatherCall& in);

}  // namespace mv
