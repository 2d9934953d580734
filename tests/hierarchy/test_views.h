#pragma once
// View sets that are hard on an octree, for the CPU's and the GPU's builder alike.

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "shaders/shared/types.glsl"

namespace mv::test {

inline View makeView(glm::vec3 p, glm::vec3 n, std::uint32_t slot) {
    View v{};
    v.positionX = p.x;
    v.positionY = p.y;
    v.positionZ = p.z;
    v.flags = n == glm::vec3(0) ? kViewOmnidirectional : kViewHemisphere;
    v.normalX = n.x;
    v.normalY = n.y;
    v.normalZ = n.z;
    v.fluxR = static_cast<float>(slot);
    v.slot = slot;
    return v;
}

// volume: anywhere, any direction. walls: on the six sides of a box, facing in, as VPLs lie.
// point: all at one place, normals nearly alike. planes: on octree planes, 0 and 1 included.
// dead: two of three slots are. particles: no direction. pairs: almost coincident twos with
// opposite normals. outside: some beyond the cube.
inline const std::vector<std::string>& viewKinds() {
    static const std::vector<std::string> kinds = {"volume", "walls",     "point", "planes",
                                                   "dead",   "particles", "pairs", "outside"};
    return kinds;
}

inline std::vector<View> makeViews(const std::string& kind, std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    std::normal_distribution<float> gauss(0, 1);
    const auto direction = [&] {
        return normalizeOr(glm::vec3(gauss(random), gauss(random), gauss(random)),
                           glm::vec3(0, 1, 0));
    };
    std::vector<View> views;
    views.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        glm::vec3 p(unit(random), unit(random), unit(random));
        glm::vec3 n = direction();
        bool dead = false;
        if (kind == "walls") {
            const auto side = static_cast<int>(i % 6);
            p = 0.1f + 0.8f * p;
            p[side / 2] = side % 2 ? 0.9f : 0.1f;
            n = glm::vec3(0);
            n[side / 2] = side % 2 ? -1.0f : 1.0f;
        } else if (kind == "point") {
            p = glm::vec3(0.3f, 0.7f, 0.123f);
            n = normalizeOr(glm::vec3(0, 1, 0) + 1e-3f * n, glm::vec3(0, 1, 0));
        } else if (kind == "planes") {
            for (int k = 0; k < 3; ++k) p[k] = std::round(p[k] * 8) / 8;
        } else if (kind == "dead") {
            dead = i % 3 != 1;
        } else if (kind == "particles") {
            n = glm::vec3(0);
        } else if (kind == "pairs" && i % 2 == 1) {
            const View& twin = views.back();
            p = glm::vec3(twin.positionX, twin.positionY, twin.positionZ) + 1e-5f * n;
            n = -glm::vec3(twin.normalX, twin.normalY, twin.normalZ);
        } else if (kind == "outside") {
            p = p * 1.5f - 0.25f;
        }
        views.push_back(makeView(p, n, static_cast<std::uint32_t>(i)));
        if (dead) views.back() = View{};
        views.back().slot = static_cast<std::uint32_t>(i);
    }
    return views;
}

}  // namespace mv::test
