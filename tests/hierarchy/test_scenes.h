#pragma once
// Small scenes made in memory for the hierarchy tests.

#include <random>

#include "megaviews/scene/scene.h"
#include "megaviews/scene/triangle_bvh.h"

namespace mv::test {

// The angle between two directions, precise for small ones, too.
inline double angle(glm::dvec3 a, glm::dvec3 b) {
    a = glm::normalize(a);
    b = glm::normalize(b);
    return 2 * std::atan2(glm::length(a - b), glm::length(a + b));
}

// A scene of single triangles, each with its own corners and its face normal at all of them.
inline void addTriangle(Scene& scene, glm::vec3 a, glm::vec3 b, glm::vec3 c,
                        std::uint32_t material = 0) {
    if (scene.materials.empty()) scene.materials.emplace_back();
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const glm::vec3 normal = normalizeOr(cross3(b - a, c - a), glm::vec3(0, 0, 1));
    for (const glm::vec3& p : {a, b, c}) {
        scene.positions.push_back(p);
        scene.normals.push_back(normal);
    }
    scene.triangles.emplace_back(first, first + 1, first + 2);
    scene.triangleMaterials.push_back(material);
}

inline void addQuad(Scene& scene, glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
    addTriangle(scene, a, b, c);
    addTriangle(scene, a, c, d);
}

// Triangles of all sizes and shapes, some of them slivers, some on grid planes, random normals.
inline Scene randomTriangles(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    const auto point = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
    Scene scene;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 a = point();
        const float size = std::pow(2.0f, -8 * unit(random));
        glm::vec3 b = glm::clamp(a + (point() - 0.5f) * size, 0.0f, 1.0f);
        glm::vec3 c = glm::clamp(a + (point() - 0.5f) * size, 0.0f, 1.0f);
        if (i % 5 == 1) c = glm::mix(a, b, 0.5f) + (point() - 0.5f) * 1e-5f;
        if (i % 5 == 2) {
            const int k = static_cast<int>(i / 5 % 3);
            const float plane = std::round(a[k] * 16) / 16;
            glm::vec3 flat = a;
            flat[k] = b[k] = c[k] = plane;
            addTriangle(scene, flat, b, c);
        } else {
            addTriangle(scene, a, b, glm::clamp(c, 0.0f, 1.0f));
        }
        for (std::size_t k = 0; k < 3; ++k)
            scene.normals[scene.normals.size() - 1 - k] =
                normalizeOr(point() - 0.5f, glm::vec3(0, 1, 0));
    }
    return scene;
}

}  // namespace mv::test
