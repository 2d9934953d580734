#pragma once
// The scene's triangles in Embree: rays that owe nothing to our own hierarchy, for tests and for
// the ground truth. Alpha masks are honoured by the same rule as in shaders/shared/bvh.glsl.

#include <memory>
#include <optional>
#include <span>

#include "megaviews/scene/triangle_bvh.h"

namespace mv {

class EmbreeScene {
  public:
    // bvh lends materials and trace textures; it and its scene outlive this.
    explicit EmbreeScene(const TriangleBvh& bvh);
    ~EmbreeScene();
    EmbreeScene(EmbreeScene&&) noexcept;
    EmbreeScene& operator=(EmbreeScene&&) noexcept;

    // As TriangleBvh::intersect and occluded. Any number of threads may ask at once.
    std::optional<RayHit> intersect(glm::vec3 origin, glm::vec3 direction, float tMin,
                                    float tMax) const;
    bool occluded(glm::vec3 origin, glm::vec3 direction, float tMin, float tMax) const;
    // By colour, the share of light that gets so far: nothing past what stops it, and what is clear
    // tints it where `bvh`, of this scene, has materials that do.
    glm::vec3 passed(const BvhData& bvh, glm::vec3 origin, glm::vec3 direction, float tMin,
                     float tMax) const;
    // Distances to the closest hits of rays from one point, eight at a time (rtcIntersect8): what a
    // depth map costs by rays. Directions are unit, as many as depths; infinity where nothing is
    // hit.
    void closestDepths(glm::vec3 origin, std::span<const glm::vec3> directions,
                       std::span<float> depths) const;
    const TriangleBvh& bvh() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv
