#include "megaviews/views/frame_camera.h"

#include <algorithm>
#include <cmath>

namespace mv {

glm::mat4 viewMatrix(glm::vec3 position, glm::vec3 forward, glm::vec3 up) {
    glm::vec3 right = glm::cross(forward, up);
    if (!(glm::length(right) > 1e-6f)) {
        const glm::vec3 other =
            std::abs(forward.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
        right = glm::cross(forward, other);
    }
    right = glm::normalize(right);
    const glm::vec3 trueUp = glm::cross(right, forward);
    glm::mat4 rows(1);
    rows[0] = glm::vec4(right, -glm::dot(right, position));
    rows[1] = glm::vec4(trueUp, -glm::dot(trueUp, position));
    rows[2] = glm::vec4(-forward, glm::dot(forward, position));
    return glm::transpose(rows);
}

glm::mat4 FrameCamera::viewFromWorld() const { return viewMatrix(position, forward, up); }

float FrameCamera::halfHeight() const {
    if (orthoHalfHeight > 0) return orthoHalfHeight;
    constexpr float kLeastRad = 1e-3f, kMostRad = 3.125f;  // 179 degrees, and a little
    return std::tan(std::clamp(yfovRad, kLeastRad, kMostRad) / 2);
}

glm::mat4 FrameCamera::clipFromView(float aspect) const {
    glm::mat4 m(0);
    if (orthoHalfHeight > 0) {
        const float far =
            glm::length(position - glm::vec3(0.5f)) + 1;  // > half the cube's diagonal
        m[0][0] = 1 / (orthoHalfHeight * aspect);
        m[1][1] = 1 / orthoHalfHeight;
        m[2][2] = 1 / far;
        m[3][2] = 1;
        m[3][3] = 1;
        m[3][0] = 0 - offset.x;
        m[3][1] = 0 - offset.y;
    } else {
        const float f = 1 / halfHeight();
        m[0][0] = f / aspect;
        m[1][1] = f;
        m[2][3] = -1;
        m[2][0] = offset.x;  // times z, which is -w
        m[2][1] = offset.y;
        m[3][2] = kNearPlane;
    }
    return m;
}

glm::vec2 pixelOffset(std::uint32_t i) {
    // The first two dimensions of Sobol's sequence in 24 bits, the top bits turned over, which puts
    // the first point into the middle and keeps the nets.
    constexpr std::uint32_t kTop = 1u << 23;
    std::uint32_t x = kTop, y = kTop, bit = kTop, direction = kTop;
    for (; i != 0; i >>= 1) {
        if (i & 1u) {
            x ^= bit;
            y ^= direction;
        }
        bit >>= 1;
        direction ^= direction >> 1;
    }
    constexpr float kScale = 1.0f / (1u << 24);
    return {static_cast<float>(x) * kScale - 0.5f, static_cast<float>(y) * kScale - 0.5f};
}

PickRay rayThrough(const FrameCamera& camera, int width, int height, float x, float y,
                   float radiusPixels) {
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    const glm::mat4 rows = glm::transpose(camera.viewFromWorld());
    const glm::vec3 right(rows[0]), up(rows[1]), forward = -glm::vec3(rows[2]);
    // Half a picture's height is 1.
    const glm::vec2 at((2 * x / static_cast<float>(width) - 1 + camera.offset.x) * aspect,
                       2 * y / static_cast<float>(height) - 1 + camera.offset.y);
    const float radius = 2 * radiusPixels / static_cast<float>(height);
    PickRay ray;
    if (camera.orthoHalfHeight > 0) {
        ray.origin = camera.position + (right * at.x + up * at.y) * camera.orthoHalfHeight;
        ray.direction = forward;
        ray.radius = radius * camera.orthoHalfHeight;
    } else {
        const float half = camera.halfHeight();
        const glm::vec3 way = forward + (right * at.x + up * at.y) * half;
        ray.origin = camera.position;
        ray.direction = glm::normalize(way);
        ray.spread = radius * half / glm::length(way);
    }
    return ray;
}

}  // namespace mv
