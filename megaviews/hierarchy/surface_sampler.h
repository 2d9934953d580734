#pragma once
// What a piece of surface reflects and emits, for the voxelisation: textures are sampled at a few
// points of the piece, through the same reduced textures that VPL rays see, nearest texel.

#include <array>
#include <cstdint>

#include "megaviews/hierarchy/surface_piece.h"
#include "megaviews/scene/triangle_bvh.h"

namespace mv {

struct SurfaceSample {
    glm::dvec3 albedo{0}, emission{0};  // means over the points that the alpha mask leaves
    double coverage = 1;                // share of the points that it leaves
};

class SurfaceSampler {
  public:
    explicit SurfaceSampler(const TriangleBvh& bvh);
    SurfaceSample sample(const SurfacePiece& piece, glm::dvec3 centroid) const;
    bool doubleSided(std::uint32_t triangle) const;

  private:
    glm::vec4 texel(std::uint32_t texture, glm::vec2 uv) const;

    const Scene& scene_;
    const TriangleBvh& bvh_;
    BvhData data_;
    std::array<float, 256> linear_;  // of an sRGB byte
};

}  // namespace mv
