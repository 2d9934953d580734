#pragma once
// Random and adversarial view sets for the gather's tests; the same seed gives the same views.

#include <random>
#include <vector>

#include "megaviews/hierarchy/view_hierarchy.h"

namespace mv::test {

using Rng = std::mt19937;

inline float uniform(Rng& rng, float lo, float hi) {
    return std::uniform_real_distribution<float>(lo, hi)(rng);
}
inline vec3 point(Rng& rng, float lo = 0, float hi = 1) {
    const float x = uniform(rng, lo, hi), y = uniform(rng, lo, hi), z = uniform(rng, lo, hi);
    return {x, y, z};
}
inline vec3 direction(Rng& rng) {
    for (;;) {
        const vec3 p = point(rng, -1, 1);
        const float l2 = dot(p, p);
        if (l2 > 1e-4f && l2 <= 1) return p / std::sqrt(l2);
    }
}
// A unit vector within `cosTheta` of the axis; with edge set, right at that angle.
inline vec3 inCone(Rng& rng, vec3 axis, float cosTheta, bool edge) {
    const vec3 side = std::abs(axis.x) < 0.6f ? vec3(1, 0, 0) : vec3(0, 1, 0);
    const vec3 u = normalize(cross(axis, side)), v = cross(axis, u);
    const float c = edge ? cosTheta : uniform(rng, cosTheta, 1);
    const float s = std::sqrt(std::max(0.0f, 1 - c * c)), phi = uniform(rng, 0, 6.2831853f);
    return normalize(axis * c + u * (s * std::cos(phi)) + v * (s * std::sin(phi)));
}

inline View makeView(vec3 p, vec3 n, vec3 flux, uint flags = kViewHemisphere) {
    return {p.x, p.y, p.z, flags, n.x, n.y, n.z, 1, flux.x, flux.y, flux.z, 0};
}
inline View makeParticle(vec3 p, vec3 flux) {
    return makeView(p, vec3(0), flux, kViewOmnidirectional);
}
inline void numberSlots(std::vector<View>& views) {
    for (std::size_t i = 0; i < views.size(); ++i) views[i].slot = static_cast<uint>(i);
}

// VPLs on the walls of a box, facing inwards, with fluxes over six decades; a share of particles.
inline std::vector<View> roomViews(std::size_t count, unsigned seed, double particleShare = 0) {
    Rng rng(seed);
    std::vector<View> views;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 flux = point(rng, 0.1f, 1) * std::pow(10.0f, uniform(rng, -5, 1));
        if (uniform(rng, 0, 1) < static_cast<float>(particleShare)) {
            views.push_back(makeParticle(point(rng, 0.2f, 0.8f), flux));
            continue;
        }
        vec3 p = point(rng, 0.1f, 0.9f), n(0);
        const int axis = static_cast<int>(rng() % 3);
        const bool high = rng() % 2 != 0;
        p[axis] = high ? 0.89998f : 0.10002f;
        n[axis] = high ? -1.0f : 1.0f;
        views.push_back(makeView(p, n, flux));
    }
    numberSlots(views);
    return views;
}

}  // namespace mv::test
