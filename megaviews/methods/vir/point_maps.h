#pragma once
// Reference of the maps that renderer/methods/vir/vir_pass.h makes: points of the triangles as they
// stand, made for many views at once and splatted into the map of each [Marrs17]. The GPU runs the
// same lines of shaders/shared/vir.glsl; it leaves out triangles and views that a level of detail
// has nothing for, and so does not change the maps.

#include <cstdint>
#include <span>
#include <vector>

#include "megaviews/maps/view_maps.h"
#include "megaviews/scene/triangle_bvh.h"
#include "shaders/shared/parallel.glsl"
#include "shaders/shared/vir.glsl"

namespace mv {

struct VirOptions {
    int mapRes = 16;
    // Points for a texel in the middle of a face, of the nearest view that a level serves.
    float density = 2;
};

// Distance of neighbouring points of a level, root-cube units; 1/2048 at least: splats near a view
// grow as they have to.
float virSpacing(const VirOptions& options, std::uint32_t level);

// No level has more points than this.
std::uint64_t virMostPoints(const TriangleBvh& bvh, const VirOptions& options);

// Map k of views[k], from its own position. Points behind a hemispherical view are left out, as it
// lights nothing there, and so are those that the alpha mask cuts out.
ViewMaps pointMaps(const TriangleBvh& bvh, std::span<const View> views, const VirOptions& options);

// Distance of neighbouring points for parallel views (shaders/shared/parallel.glsl) of a ball of
// this radius, root-cube units.
float parallelSpacing(float radius, int mapRes);
std::uint64_t parallelMostPoints(const TriangleBvh& bvh, float radius, int mapRes);

// Map k, mapRes^2 texels, of all that lies in the ball, along directions[k] towards the light:
// reference of renderer/passes/sky_maps.h. centre, radius: root-cube units.
std::vector<std::uint32_t> parallelMaps(const TriangleBvh& bvh, std::span<const vec3> directions,
                                        vec3 centre, float radius, int mapRes);

}  // namespace mv
