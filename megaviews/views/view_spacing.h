#pragma once
// The distance below which each view lights no brighter (shaders/shared/view_spacing.glsl).

#include <cstdint>
#include <span>
#include <vector>

#include "shaders/shared/types.glsl"

namespace mv {

// Indices of the views that live, by Morton key, then by index: as the view hierarchy sorts them.
std::vector<std::uint32_t> alongMortonCurve(std::span<const View> views);

// Below which no view is clamped that has neighbours. order: alongMortonCurve() of the views.
float leastClampDistance(std::span<const View> views, const std::vector<std::uint32_t>& order);

// For each view, dead ones included (theirs means nothing), root-cube units: what
// shaders/passes/gather_clamp.comp gives the gather.
std::vector<float> clampDistances(std::span<const View> views);

}  // namespace mv
