#pragma once
// How alike what the GPU made and what its CPU twin made must be, for the checks of this program.

#include <cstdint>
#include <span>

#include "megaviews/settings/statistics.h"
#include "shaders/shared/types.glsl"

namespace mv {

// A list that is longer than the other differs in all of its entries.
std::uint64_t differingTexels(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b);
// Differences by rounding do not count: positions within 1e-5, normals and fluxes within 1e-3.
std::uint64_t differingViews(std::span<const View> a, std::span<const View> b);
// Differences by rounding do not count: boxes within 1e-6, cones within 1e-3.
std::uint64_t differingNodes(std::span<const ViewNode> a, std::span<const ViewNode> b);
// Division and square root of GPUs are not IEEE's: 1e-4 of the pairs or texels may be decided
// differently. Software renderers compute as the CPU does, to the bit and in every count.
bool pairsAgree(const PairCounts& gpu, const PairCounts& cpu);
// One node in a hundred may differ: whether a cone culls hangs on one comparison.
bool nodesAgree(std::uint64_t different, std::uint64_t nodes);
bool texelsAgree(std::uint64_t different, std::uint64_t texels);

}  // namespace mv
