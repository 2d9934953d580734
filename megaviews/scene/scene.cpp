#include "megaviews/scene/scene.h"

#include <algorithm>
#include <cmath>

#include "megaviews/scene/pose.h"

namespace mv {

namespace {

glm::dvec3 unitOr(glm::dvec3 v, glm::dvec3 otherwise) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : otherwise;
}

std::vector<glm::dmat4> matricesAt(const Scene& scene, double timeS, int animation) {
    const Animation* chosen = nullptr;
    if (animation >= 0 && static_cast<std::size_t>(animation) < scene.animations.size()) {
        chosen = &scene.animations[static_cast<std::size_t>(animation)];
    }
    return worldMatrices(scene.nodes, chosen, chosen ? loopTime(timeS, chosen->duration) : 0);
}

}  // namespace

RootCube RootCube::around(glm::dvec3 min, glm::dvec3 max) {
    constexpr double kMargin = 1.0 / 64;  // of the edge, on each side
    glm::dvec3 size = max - min;
    glm::dvec3 centre = min + 0.5 * size;
    double longest = std::max({size.x, size.y, size.z});
    if (!(longest >= 0) || !std::isfinite(longest)) {  // an empty box
        centre = glm::dvec3(0);
        longest = 0;
    }
    if (longest == 0) {
        // One point: an edge large enough to have resolution where the point lies.
        const double distance =
            std::max({std::abs(centre.x), std::abs(centre.y), std::abs(centre.z)});
        longest = std::max(1.0, 1e-6 * distance);
    }
    RootCube cube;
    cube.edge = longest / (1 - 2 * kMargin);
    cube.origin = centre - 0.5 * cube.edge;
    return cube;
}

int Scene::defaultAnimation() const {
    if (animations.empty()) return -1;
    return animations.back().together ? static_cast<int>(animations.size()) - 1 : 0;
}

std::vector<PosedLight> Scene::lightsAt(double timeS, int animation) const {
    const std::vector<glm::dmat4> world = matricesAt(*this, timeS, animation);
    std::vector<PosedLight> posed;
    posed.reserve(lights.size());
    for (const Light& light : lights) {
        const glm::dmat4& m = world[static_cast<std::size_t>(light.node)];
        posed.push_back({light, glm::dvec3(m[3]), unitOr(-glm::dvec3(m[2]), {0, 0, -1})});
    }
    return posed;
}

std::vector<PosedCamera> Scene::camerasAt(double timeS, int animation) const {
    const std::vector<glm::dmat4> world = matricesAt(*this, timeS, animation);
    std::vector<PosedCamera> posed;
    posed.reserve(cameras.size());
    for (const Camera& camera : cameras) {
        const glm::dmat4& m = world[static_cast<std::size_t>(camera.node)];
        const glm::dvec3 forward = unitOr(-glm::dvec3(m[2]), {0, 0, -1});
        // Scaled and sheared nodes: up is what of y is perpendicular to forward.
        const glm::dvec3 y = unitOr(glm::dvec3(m[1]), {0, 1, 0});
        const glm::dvec3 any =
            std::abs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
        const glm::dvec3 fallback = glm::normalize(any - forward * glm::dot(any, forward));
        const glm::dvec3 across = y - forward * glm::dot(y, forward);
        const glm::dvec3 up = glm::length(across) > 1e-9 ? glm::normalize(across) : fallback;
        posed.push_back({camera, glm::dvec3(m[3]), forward, up});
    }
    return posed;
}

bool Scene::animated() const {
    std::vector<bool> carries(nodes.size(), false);
    const auto markUpwards = [&](int node) {
        for (; node >= 0 && !carries[static_cast<std::size_t>(node)];
             node = nodes[static_cast<std::size_t>(node)].parent) {
            carries[static_cast<std::size_t>(node)] = true;
        }
    };
    for (const Light& light : lights) markUpwards(light.node);
    for (const Camera& camera : cameras) markUpwards(camera.node);
    for (const Animation& animation : animations) {
        for (const AnimationChannel& channel : animation.channels) {
            if (carries[static_cast<std::size_t>(channel.node)] && channel.times.size() > 1)
                return true;
        }
    }
    return false;
}

bool Scene::needsFull() const {
    return std::any_of(materials.begin(), materials.end(), [](const Material& material) {
        return material.isGlossy() || material.tints();
    });
}

const Image* Scene::imageOf(int texture) const {
    if (texture < 0) return nullptr;
    const int image = textures[static_cast<std::size_t>(texture)].image;
    if (image < 0) return nullptr;
    const Image& shown = images[static_cast<std::size_t>(image)];
    return shown.width > 0 && shown.height > 0 ? &shown : nullptr;
}

}  // namespace mv
