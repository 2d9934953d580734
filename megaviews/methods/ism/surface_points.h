#pragma once
// Points spread over a scene's surfaces, made once a scene: what imperfect shadow maps splat
// instead of triangles [RGK08].

#include <cstdint>
#include <vector>

#include "megaviews/scene/triangle_bvh.h"
#include "shaders/shared/ism.glsl"

namespace mv {

struct SurfacePoints {
    std::vector<SurfacePoint> points;  // along the triangles of the BVH: neighbours lie together
    double area = 0;                   // of all triangles, root-cube units squared
};

// `count` points, each at random in its own strip of area / count; absent where the alpha mask cuts
// the surface out. No points where there is no area. The same bytes for any number of threads.
SurfacePoints makeSurfacePoints(const TriangleBvh& bvh, std::uint64_t count, std::uint32_t seed);

}  // namespace mv
