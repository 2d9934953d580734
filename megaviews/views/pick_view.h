#pragma once
// Which view a user points at: the one nearest to a ray from the camera, among those that the
// visible surface does not hide.

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "shaders/shared/types.glsl"

namespace mv {

// A cone or cylinder around what is pointed at, root-cube units.
struct PickRay {
    glm::vec3 origin{0}, direction{0, 0, -1};  // direction is unit
    float radius = 0;                          // at the origin: of orthographic cameras
    float spread = 0;                          // by which it grows per unit of distance
    float radiusAt(float distance) const { return radius + spread * distance; }
};

// The slot of the alive view that is nearest to the ray's axis, as a share of the ray's radius
// there; of several, the one nearest to the camera, then that of the lowest slot. nullopt if none
// lies within the radius. surfaceDistance: where along the ray the visible surface is; views on it
// count, however it is slanted, views behind it do not.
std::optional<std::uint32_t> pickView(
    std::span<const View> views, const PickRay& ray,
    float surfaceDistance = std::numeric_limits<float>::infinity());

}  // namespace mv
