#pragma once
// The samples behind one pixel of a gathered picture, for whoever asks what lights it.

#include <vector>

#include "renderer/passes/gather_sum.h"

namespace mv {

// See GatherPass::readSamples().
std::vector<GatheredSample> readGatheredSamples(GatherSum& sum, const GatherCall& in,
                                                glm::ivec2 pixel);

}  // namespace mv
