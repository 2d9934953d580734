#include "app/bench/stress_scene.h"

#include <algorithm>

#include "megaviews/scene/builtin_mesh.h"
#include "shaders/shared/random.glsl"
#include "shaders/shared/sampling.glsl"

namespace mv::stress {

void World::use(glm::vec3 color, glm::vec3 emission, bool doubleSided) {
    Material m;
    m.baseColor = glm::vec4(color, 1);
    m.emission = emission;
    m.doubleSided = doubleSided;
    assets_->scene.materials.push_back(m);
}

void World::triangle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    const glm::vec3 n(builtin::unit(glm::cross(b - a, c - a)));
    triangle({a, b, c}, {n, n, n});
}

void World::triangle(const std::array<glm::dvec3, 3>& corners,
                     const std::array<glm::vec3, 3>& normals) {
    Scene& scene = assets_->scene;
    if (scene.materials.empty()) use(glm::vec3(0.7f));
    const auto first = static_cast<std::uint32_t>(corners_.size());
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    scene.normals.insert(scene.normals.end(), normals.begin(), normals.end());
    scene.triangles.push_back({first, first + 1, first + 2});
    scene.triangleMaterials.push_back(static_cast<std::uint32_t>(scene.materials.size() - 1));
}

void World::quad(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d) {
    triangle(a, b, c);
    triangle(a, c, d);
}

void World::box(glm::dvec3 low, glm::dvec3 high, bool inwards) {
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 u(0), v(0), far = low;
        u[(axis + 1) % 3] = high[(axis + 1) % 3] - low[(axis + 1) % 3];
        v[(axis + 2) % 3] = high[(axis + 2) % 3] - low[(axis + 2) % 3];
        far[axis] = high[axis];
        if (inwards) std::swap(u, v);
        quad(far, far + u, far + u + v, far + v);
        quad(low, low + v, low + v + u, low + u);
    }
}

void World::repeat(int times) {
    Scene& scene = assets_->scene;
    const std::size_t count = scene.triangles.size();
    for (int k = 1; k <= times; ++k) {
        for (std::size_t i = 0; i < count; ++i) {
            const glm::uvec3 t = scene.triangles[i];
            const auto first = static_cast<std::uint32_t>(corners_.size());
            for (int c = 0; c < 3; ++c) {
                corners_.push_back(corners_[t[c]]);
                scene.normals.push_back(k % 2 ? -scene.normals[t[c]] : scene.normals[t[c]]);
            }
            scene.triangles.push_back(k % 2 ? glm::uvec3(first, first + 2, first + 1)
                                            : glm::uvec3(first, first + 1, first + 2));
            scene.triangleMaterials.push_back(scene.triangleMaterials[i]);
        }
    }
}

void World::light(Light light, glm::dvec3 from, glm::dvec3 to) {
    light.node = builtin::addNode(assets_->scene, placed(from), placed(to));
    assets_->scene.lights.push_back(light);
}

void World::pointLight(glm::dvec3 position, double intensity) {
    Light l;
    l.intensity = glm::vec3(glm::dvec3(intensity * scale_ * scale_));
    light(l, position, position + glm::dvec3(0, -1, 0));
}

void World::spotLight(glm::dvec3 from, glm::dvec3 to, double intensity, double outerConeRad) {
    Light l;
    l.type = LightType::spot;
    l.intensity = glm::vec3(glm::dvec3(intensity * scale_ * scale_));
    l.outerConeRad = outerConeRad;
    light(l, from, to);
}

void World::sun(glm::dvec3 from, glm::dvec3 to, double irradiance) {
    Light l;
    l.type = LightType::directional;
    l.intensity = glm::vec3(glm::dvec3(irradiance));
    light(l, from, to);
}

void World::camera(glm::dvec3 from, glm::dvec3 to, double yfovDeg) {
    assets_->scene.cameras.clear();
    builtin::addCamera(assets_->scene, "stress", placed(from), placed(to), yfovDeg);
}

std::unique_ptr<SceneAssets> World::finish(int levels) {
    Scene& scene = assets_->scene;
    scene.name = "stress";
    if (scene.materials.empty()) scene.materials.push_back({});
    glm::dvec3 low(1), high(-1);  // an empty box
    for (glm::dvec3& p : corners_) {
        p = placed(p);
        if (rounded_) p = glm::dvec3(glm::vec3(p));
        low = &p == corners_.data() ? p : glm::min(low, p);
        high = &p == corners_.data() ? p : glm::max(high, p);
    }
    scene.root = RootCube::around(low, high);
    for (const glm::dvec3& p : corners_) scene.positions.push_back(scene.root.rootFromWorld(p));
    assets_->bvh = TriangleBvh::build(scene);
    assets_->hierarchy = SceneHierarchy::build(scene, assets_->bvh, levels);
    return std::move(assets_);
}

World furnishedRoom(double scale, glm::dvec3 offset) {
    World w(scale, offset);
    w.use({0.72f, 0.7f, 0.66f});
    w.box({0, 0, 0}, {8, 4, 6}, true);
    w.box({4.6, 0, 0}, {4.9, 4, 3.4});
    w.use({0.65f, 0.25f, 0.2f});
    w.box({2.6, 0, 2.2}, {3.2, 4, 2.8});
    w.use({0.25f, 0.4f, 0.6f});
    w.box({5.6, 0, 3.6}, {6.9, 1.1, 4.8});
    w.camera({0.7, 1.8, 5.5}, {6, 1.1, 2.6});
    return w;
}

World litRoom(double scale, glm::dvec3 offset) {
    World w = furnishedRoom(scale, offset);
    w.pointLight({1.6, 3.2, 1.8}, 40);
    return w;
}

World corridor() {
    World w;
    w.box({0, 0, 0}, {8, 0.5, 0.5}, true);
    w.use({0.3f, 0.5f, 0.6f}, glm::vec3(0), true);
    w.quad({3, 0, 0}, {3, 0, 0.25}, {3, 0.5, 0.25}, {3, 0.5, 0});
    w.pointLight({1, 0.3, 0.25}, 0.6);
    w.camera({0.3, 0.3, 0.3}, {4, 0.2, 0.2}, 40);
    return w;
}

void addView(ViewSet& set, glm::vec3 position, glm::vec3 normal) {
    View v = vplAt(position, normal, glm::vec3(1.0f, 0.8f, 0.6f), 1,
                   static_cast<std::uint32_t>(set.views.size()));
    if (normal == glm::vec3(0)) v.flags = kViewOmnidirectional;
    set.views.push_back(v);
}

glm::vec3 randomPoint(std::uint32_t seed, std::uint32_t index) {
    const vec4 r = random4(seed, index, 0, 0);
    return {r.x, r.y, r.z};
}
glm::vec3 randomDirection(std::uint32_t seed, std::uint32_t index) {
    const vec4 r = random4(seed, index, 1, 0);
    return sphereDirection(r.x, r.y);
}

}  // namespace mv::stress
