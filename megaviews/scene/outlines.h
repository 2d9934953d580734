#pragma once
// Outlines drawn by an inverted hull, as toon models have them: a copy of the surface, swollen a
// little and turned inside out, whose backs no camera sees. Rays of light meet surfaces from both
// sides; to them it would be a sack around everything.

#include <cstdint>
#include <vector>

#include "megaviews/scene/triangle_bvh.h"

namespace mv {

// Materials of single-sided, opaque surfaces that are closed, face inwards, and nearly everywhere
// face the front of another material within a fiftieth of the root cube's edge. A room faces
// inwards, too, but mostly nothing so near.
std::vector<std::uint32_t> outlineMaterials(const TriangleBvh& bvh);

}  // namespace mv
