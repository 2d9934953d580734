#pragma once
// The CPU twin of the method shadow-rays: one sample's visibility by a ray against the scene's
// triangles, by the same lines (shaders/shared/shadow_ray.glsl).

#include "megaviews/scene/triangle_bvh.h"

namespace mv {

// Whether a triangle stands between a receiver with a unit normal and a view's position, root-cube
// units; where alpha masks let the ray through it does not.
bool shadowRayBlocked(const TriangleBvh& bvh, glm::vec3 receiver, glm::vec3 normal, glm::vec3 view);

}  // namespace mv
