#pragma once
// Ground truth for the stress cases: every view's light at every receiver, with visibility by brute
// force over all triangles in double. Knows no hierarchy, no rays' library and no rounding beyond
// that of the corners themselves; for scenes of at most some hundred triangles.

#include <span>
#include <vector>

#include "megaviews/gather/receiver.h"
#include "megaviews/scene/scene.h"
#include "shaders/shared/types.glsl"

namespace mv::stress {

// Does any triangle, seen from either side, stand strictly between the two points?
bool blocked(const Scene& scene, glm::dvec3 from, glm::dvec3 to);

struct Truth {
    std::vector<glm::vec3> irradiance;  // W/m^2, of each receiver
    std::vector<glm::vec3> open;        // the same if nothing hid anything
};
// By the definition of docs/references.md: rays from the receiver, lifted as VPLs are, to the
// view's own position. A zero normal is no surface.
Truth bruteForceGather(const Scene& scene, std::span<const View> views,
                       std::span<const Receiver> receivers, float clampDistance);

}  // namespace mv::stress
