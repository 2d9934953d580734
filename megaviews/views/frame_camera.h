#pragma once
// The camera of a frame in root-cube units and its matrices (Camera -> GBuffer).

#include <cstdint>
#include <memory>

#include <glm/glm.hpp>

#include "megaviews/views/pick_view.h"

namespace mv {

struct FrameCamera {
    glm::vec3 position{0}, forward{0, 0, -1}, up{0, 1, 0};
    float yfovRad = 0.9f;
    float orthoHalfHeight = 0;  // > 0: orthographic
    // Where in its pixels a picture is sampled, off their centres and in half pictures: 2 / width
    // is a pixel to the right. The importance of views knows nothing of it.
    glm::vec2 offset{0};
    // Of the picture, in root-cube units: at distance 1 (perspective), or anywhere (orthographic).
    float halfHeight() const;
    // Right-handed view space: x right, y up, looking along -z. `up` need not be orthogonal.
    glm::mat4 viewFromWorld() const;
    // Reversed depth in [0, 1]: 1 at the near plane, 0 at infinity (perspective) or behind the
    // root cube (orthographic). With a float depth buffer the error is relative to the distance.
    glm::mat4 clipFromView(float aspect) const;
    glm::mat4 clipFromWorld(float aspect) const { return clipFromView(aspect) * viewFromWorld(); }
    bool operator==(const FrameCamera&) const = default;
};

// The i-th of a pixel's points, in pixels off its centre, [-0.5, 0.5)^2: the first is the centre,
// and each 2^k from the first on are a (0, 2) net, so that any number of them lies evenly [Sobol,
// On the distribution of points in a cube, 1967]. i < 2^24.
glm::vec2 pixelOffset(std::uint32_t i);

struct EnvironmentImage;  // megaviews/views/sky.h

// From where and when a frame shows the scene.
struct FrameMoment {
    FrameCamera camera;
    double timeS = 0;
    int animation = -1;  // index into Scene::animations, -1 = none
    // The pixels of the image that the settings name as environment.
    std::shared_ptr<const EnvironmentImage> environment = nullptr;
    bool operator==(const FrameMoment&) const = default;
};

// Nearer than this nothing is drawn, root-cube units.
inline constexpr float kNearPlane = 1e-5f;

// The ray through a point of a picture, in pixels from its lower left corner (pixel centres lie at
// halves), and `radiusPixels` around it.
PickRay rayThrough(const FrameCamera& camera, int width, int height, float x, float y,
                   float radiusPixels);

// Rows right, up, back of a frame that looks along the unit vector `forward`; `up` is replaced
// where it is parallel to it.
glm::mat4 viewMatrix(glm::vec3 position, glm::vec3 forward, glm::vec3 up);

}  // namespace mv
