#pragma once
// The distance below which each view lights no brighter (shaders/shared/view_spacing.glsl).

#include <span>
#include <vector>

#include "shaders/shared/types.glsl"

namespace mv {

// For each view, dead ones included (theirs means nothing), root-cube units: what
// shaders/passes/gather_clamp.comp gives the gather.
std::vector<float> clampDistances(std::span<const View> views);

}  // namespace mv
