#pragma once
// Small triangle soups for the tests of the BVH, and the definition of a hit they are held to.

#include <cstdint>
#include <random>

#include "megaviews/scene/triangle_bvh.h"

namespace mv::testing {

// Triangles without shared corners, one opaque white material.
inline Scene soupScene(const std::vector<glm::vec3>& corners) {
    Scene scene;
    scene.positions = corners;
    scene.materials.push_back({});
    for (std::uint32_t i = 0; i + 2 < corners.size(); i += 3) {
        glm::vec3 n = normalizeOr(cross3(corners[i + 1] - corners[i], corners[i + 2] - corners[i]),
                                  glm::vec3(0, 1, 0));
        for (int k = 0; k < 3; ++k) scene.normals.push_back(n);
        scene.triangles.push_back({i, i + 1, i + 2});
        scene.triangleMaterials.push_back(0);
    }
    return scene;
}

class Random {
  public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}
    float uniform(float low = 0, float high = 1) {
        return low + (high - low) * (static_cast<float>(engine_() >> 8) * 0x1p-24f);
    }
    glm::vec3 point() {
        float x = uniform(), y = uniform(), z = uniform();
        return {x, y, z};
    }
    glm::vec3 direction() {
        for (;;) {
            glm::vec3 d = 2.0f * point() - 1.0f;
            float l = length3(d);
            if (l > 0.05f && l <= 1) return d / l;
        }
    }
    std::uint32_t index(std::size_t n) { return static_cast<std::uint32_t>(engine_() % n); }

  private:
    std::mt19937 engine_;
};

inline std::vector<glm::vec3> randomSoup(Random& random, std::size_t triangles, float size) {
    std::vector<glm::vec3> corners;
    for (std::size_t i = 0; i < triangles; ++i) {
        glm::vec3 centre = random.point();
        for (int k = 0; k < 3; ++k) corners.push_back(centre + size * (random.point() - 0.5f));
    }
    return corners;
}

// Moeller-Trumbore in double: distance to one triangle, and how far inside its edges the hit is
// (smallest barycentric weight; negative outside). Independent of bvh.glsl.
struct ExactHit {
    bool parallel = true;
    double t = 0, inside = -1;
};
inline ExactHit exactHit(const Scene& scene, std::size_t triangle, glm::vec3 o, glm::vec3 d) {
    glm::uvec3 corner = scene.triangles[triangle];
    glm::dvec3 a = scene.positions[corner.x];
    glm::dvec3 e1 = glm::dvec3(scene.positions[corner.y]) - a;
    glm::dvec3 e2 = glm::dvec3(scene.positions[corner.z]) - a;
    glm::dvec3 p = glm::cross(glm::dvec3(d), e2);
    double det = glm::dot(e1, p);
    if (std::abs(det) < 1e-14 * glm::length(e1) * glm::length(e2)) return {};
    glm::dvec3 s = glm::dvec3(o) - a;
    double u = glm::dot(s, p) / det;
    glm::dvec3 q = glm::cross(s, e1);
    double v = glm::dot(glm::dvec3(d), q) / det;
    return {false, glm::dot(e2, q) / det, std::min({u, v, 1 - u - v})};
}

}  // namespace mv::testing
