#include "megaviews/methods/shadow_rays/shadow_ray.h"

#include "shaders/shared/shadow_ray.glsl"

namespace mv {

bool shadowRayBlocked(const TriangleBvh& bvh, glm::vec3 receiver, glm::vec3 normal,
                      glm::vec3 view) {
    return shadowRayBlocked(bvh.data(), receiver, normal, view);
}

}  // namespace mv
