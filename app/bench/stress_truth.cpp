#include "app/bench/stress_truth.h"

#include <tbb/parallel_for.h>

#include "shaders/shared/gather.glsl"
#include "shaders/shared/vpl.glsl"

namespace mv::stress {
namespace {

// Views on the very surface see what lies before it: hits this near either end are none.
constexpr double kAtTheEnd = 1e-9;

// A triangle as a plane and two edges, for rays in double [MT97].
struct Facet {
    glm::dvec3 a, e1, e2;
};

std::vector<Facet> facetsOf(const Scene& scene) {
    std::vector<Facet> facets;
    for (const glm::uvec3& t : scene.triangles) {
        const glm::dvec3 a(scene.positions[t.x]);
        facets.push_back(
            {a, glm::dvec3(scene.positions[t.y]) - a, glm::dvec3(scene.positions[t.z]) - a});
    }
    return facets;
}

bool blocked(const std::vector<Facet>& facets, glm::dvec3 from, glm::dvec3 to) {
    const glm::dvec3 d = to - from;
    for (const Facet& f : facets) {
        const glm::dvec3 p = glm::cross(d, f.e2);
        const double det = glm::dot(f.e1, p);
        if (det == 0) continue;
        const double inverse = 1 / det;
        const glm::dvec3 s = from - f.a;
        const double u = glm::dot(s, p) * inverse;
        if (!(u >= 0 && u <= 1)) continue;
        const glm::dvec3 q = glm::cross(s, f.e1);
        const double v = glm::dot(d, q) * inverse;
        if (!(v >= 0 && u + v <= 1)) continue;
        const double t = glm::dot(f.e2, q) * inverse;
        if (t > kAtTheEnd && t < 1 - kAtTheEnd) return true;
    }
    return false;
}

}  // namespace

bool blocked(const Scene& scene, glm::dvec3 from, glm::dvec3 to) {
    return blocked(facetsOf(scene), from, to);
}

Truth bruteForceGather(const Scene& scene, std::span<const View> views,
                       std::span<const Receiver> receivers, float clampDistance) {
    const std::vector<Facet> facets = facetsOf(scene);
    const double perArea = 1 / (scene.root.edge * scene.root.edge);
    Truth truth;
    truth.irradiance.assign(receivers.size(), glm::vec3(0));
    truth.open = truth.irradiance;
    tbb::parallel_for(std::size_t{0}, receivers.size(), [&](std::size_t i) {
        const Receiver& r = receivers[i];
        if (r.normal == glm::vec3(0)) return;
        const glm::dvec3 lifted(r.position + r.normal * kVplOffset);
        glm::dvec3 lit(0), open(0);
        for (const View& v : views) {
            if (v.flags == kViewDead) continue;
            const vec3 position = viewPosition(v);
            const float term = gatherTerm(position - r.position, r.normal, viewNormal(v),
                                          v.flags == kViewOmnidirectional, clampDistance, 0);
            if (!(term > 0)) continue;
            const glm::dvec3 light = double{term} * glm::dvec3(viewFlux(v));
            open += light;
            if (!blocked(facets, lifted, glm::dvec3(position))) lit += light;
        }
        truth.irradiance[i] = glm::vec3(lit * perArea);
        truth.open[i] = glm::vec3(open * perArea);
    });
    return truth;
}

}  // namespace mv::stress
