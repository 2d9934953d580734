#pragma once
// Scenes that a camera or a light is to be placed in, and what was placed.

#include <cmath>
#include <functional>
#include <utility>

#include "megaviews/scene/builtin_mesh.h"
#include "megaviews/scene/framing.h"
#include "megaviews/scene/triangle_bvh.h"

namespace mv::test {

using builtin::MeshBuilder;
using builtin::Vec;

// A box seen from inside.
inline void addRoom(MeshBuilder& mesh, Vec a, Vec b, bool roof = true) {
    mesh.quad({a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, a.y, a.z}, {a.x, a.y, a.z});
    if (roof) mesh.quad({a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z});
    mesh.quad({a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z});
    mesh.quad({b.x, a.y, b.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z});
    mesh.quad({a.x, a.y, b.z}, {a.x, a.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z});
    mesh.quad({b.x, a.y, a.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z});
}

// A closed room seen from inside, 9 x 3 x 5 m times `scale`, with a few boxes for furniture.
inline Scene room(double scale = 1, bool roof = true, double height = 3) {
    Scene s;
    MeshBuilder mesh(s);
    mesh.use(mesh.addMaterial("white", glm::vec3(0.8f)));
    addRoom(mesh, Vec(-4.5, 0, -2.5) * scale, Vec(4.5, height, 2.5) * scale, roof);
    auto box = [&](double a, double b, double c, double d, double h) {
        mesh.box(Vec(a, 0, b) * scale, Vec(c, h, d) * scale, MeshBuilder::kAllFaces & ~4u);
    };
    box(-1, -2.4, 1, -1.6, 0.9);
    box(2.5, 1.2, 3.5, 2.2, 1.8);
    box(-4, 1.5, -3.4, 2.1, 0.5);
    mesh.finish();
    return s;
}

inline void addBall(MeshBuilder& mesh, Vec centre, double radius) {
    mesh.surface(32, 16, true, false, [&](int i, int j) {
        double a = -i / 32.0, b = -0.25 + j / 32.0;
        double r = j == 0 || j == 16 ? 0 : radius * builtin::cosTurns(b);
        return centre + Vec(r * builtin::cosTurns(a), radius * builtin::sinTurns(b),
                            r * builtin::sinTurns(a));
    });
}

// A white scene of what `add` adds.
inline Scene made(const std::function<void(MeshBuilder&)>& add) {
    Scene s;
    MeshBuilder mesh(s);
    mesh.use(mesh.addMaterial("white", glm::vec3(0.8f)));
    add(mesh);
    mesh.finish();
    return s;
}

inline Scene ball(Vec centre, double radius) {
    return made([&](MeshBuilder& mesh) { addBall(mesh, centre, radius); });
}

inline void addFloor(MeshBuilder& mesh, double edge, double height) {
    mesh.quad({-edge, height, edge}, {edge, height, edge}, {edge, height, -edge},
              {-edge, height, -edge});
}

inline void addLamp(Scene& scene, LightType type, Vec at, Vec target, float intensity) {
    Light lamp;
    lamp.type = type;
    lamp.intensity = glm::vec3(intensity);
    lamp.node = builtin::addNode(scene, at, target);
    scene.lights.push_back(lamp);
}

// What is there once the defaults are placed.
struct Placed {
    Scene scene;
    TriangleBvh bvh;
    explicit Placed(Scene s) : scene(std::move(s)), bvh(TriangleBvh::build(scene)) {
        bvh.scene = &scene;
        placeDefaults(scene, bvh);
    }
    PosedCamera camera() const { return scene.camerasAt(0, -1).at(0); }
    int animation() const { return scene.animations.empty() ? -1 : 0; }
};

// Largest |x| and |y| of the geometry in the picture's coordinates at an aspect of 16:9, or
// infinity if something lies behind the camera.
inline std::pair<double, double> extentInPicture(const Scene& scene, const PosedCamera& c) {
    Vec right = glm::cross(c.forward, c.up);
    double t = std::tan(c.camera.yfovRad / 2), x = 0, y = 0;
    for (const glm::uvec3& triangle : scene.triangles)
        for (int k = 0; k < 3; ++k) {
            Vec p = scene.root.worldFromRoot(scene.positions[triangle[k]]) - c.position;
            double z = glm::dot(p, c.forward);
            if (z <= 0) return {1e9, 1e9};
            x = std::max(x, std::abs(glm::dot(p, right)) / (z * t * 16 / 9));
            y = std::max(y, std::abs(glm::dot(p, c.up)) / (z * t));
        }
    return {x, y};
}

}  // namespace mv::test
