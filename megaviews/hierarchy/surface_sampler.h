#pragma once
// How much of a piece of surface its alpha mask leaves, for the voxelisation: the texture is
// sampled at a few points of the piece, through the same reduced textures that VPL rays see,
// nearest texel.

#include "megaviews/hierarchy/surface_piece.h"
#include "megaviews/scene/triangle_bvh.h"

namespace mv {

class SurfaceSampler {
  public:
    explicit SurfaceSampler(const TriangleBvh& bvh);
    // The share, in 0..1, of the points that the mask leaves; 1 without a mask.
    double coverage(const SurfacePiece& piece, glm::dvec3 centroid) const;

  private:
    float texelAlpha(std::uint32_t texture, glm::vec2 uv) const;

    const Scene& scene_;
    const TriangleBvh& bvh_;
    BvhData data_;
};

}  // namespace mv
