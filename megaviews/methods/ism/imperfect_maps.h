#pragma once
// Reference of the imperfect shadow maps that renderer/methods/ism/ism_pass.h makes: points
// splatted into each view's own map, holes filled by pull-push [RGK08 §3]. The GPU runs the same
// lines of shaders/shared/ism.glsl.

#include <cstdint>
#include <span>

#include "megaviews/maps/view_maps.h"
#include "megaviews/methods/ism/surface_points.h"

namespace mv {

struct IsmOptions {
    int mapRes = 16;
    std::uint32_t pointsPerView = 8192;
    std::uint32_t seed = 0;
    bool fill = true;  // pull-push
};

// Points of which each view draws one; the surface points beyond count * stratum are not used.
inline std::uint32_t ismStratum(std::uint64_t points, std::uint32_t pointsPerView) {
    return static_cast<std::uint32_t>(points / pointsPerView);
}
// Radius of a disc whose area is what one of a view's points stands for.
float ismRadius(double area, std::uint32_t pointsPerView);

// Map k of views[k], from its own position. Points behind a hemispherical view are left out, as it
// lights nothing there. surface: none, or at least pointsPerView points.
ViewMaps imperfectMaps(const SurfacePoints& surface, std::span<const View> views,
                       const IsmOptions& options);

}  // namespace mv
