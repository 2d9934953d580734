#pragma once
// Scenes small enough to know every texel's value, for the tests of the picture passes.

#include <array>
#include <cmath>
#include <vector>

#include "megaviews/scene/scene.h"
#include "megaviews/views/frame_camera.h"

namespace mv::testing {

// An empty scene whose root cube is the unit cube times `edgeM`.
inline Scene emptyScene(double edgeM = 1) {
    Scene s;
    s.root.edge = edgeM;
    s.materials.push_back({});
    return s;
}

// Adds a quad a, b, c, d counter-clockwise as seen from its front, root-cube units.
inline void addQuad(Scene& s, std::array<glm::vec3, 4> corners, std::uint32_t material = 0) {
    const auto first = static_cast<std::uint32_t>(s.positions.size());
    const glm::vec3 normal =
        glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    for (const glm::vec3& c : corners) {
        s.positions.push_back(c);
        s.normals.push_back(normal);
    }
    s.triangles.push_back({first, first + 1, first + 2});
    s.triangles.push_back({first, first + 2, first + 3});
    s.triangleMaterials.insert(s.triangleMaterials.end(), {material, material});
}

// A floor that faces up at height y over [x0, x1] x [z0, z1].
inline void addFloor(Scene& s, float y, float x0 = 0, float x1 = 1, float z0 = 0, float z1 = 1,
                     std::uint32_t material = 0) {
    addQuad(s, {glm::vec3(x0, y, z1), {x1, y, z1}, {x1, y, z0}, {x0, y, z0}}, material);
}

// Looks straight down on the floor from height y; the picture's x is the world's, its top is -z.
inline FrameCamera fromAbove(float y = 0.9f, float yfovRad = 1.0f) {
    FrameCamera c;
    c.position = {0.5f, y, 0.5f};
    c.forward = {0, -1, 0};
    c.up = {0, 0, -1};
    c.yfovRad = yfovRad;
    return c;
}

inline LightRecord pointLight(glm::vec3 position, glm::vec3 intensity) {
    LightRecord l{};
    l.positionX = position.x;
    l.positionY = position.y;
    l.positionZ = position.z;
    l.directionY = -1;
    l.type = kLightPoint;
    l.intensityR = intensity.x;
    l.intensityG = intensity.y;
    l.intensityB = intensity.z;
    l.fluxR = 4 * kPi * intensity.x;
    l.fluxG = 4 * kPi * intensity.y;
    l.fluxB = 4 * kPi * intensity.z;
    l.cosOuter = -1;
    l.cosInner = -1;
    return l;
}

inline LightRecord spotLight(glm::vec3 position, glm::vec3 direction, glm::vec3 intensity,
                             float innerRad, float outerRad) {
    LightRecord l = pointLight(position, intensity);
    l.type = kLightSpot;
    l.directionX = direction.x;
    l.directionY = direction.y;
    l.directionZ = direction.z;
    l.cosInner = std::cos(innerRad);
    l.cosOuter = std::cos(outerRad);
    return l;
}

inline LightRecord sunLight(glm::vec3 direction, glm::vec3 irradiance) {
    LightRecord l = spotLight({0, 0, 0}, direction, irradiance, 0, 0);
    l.type = kLightDirectional;
    return l;
}

}  // namespace mv::testing
