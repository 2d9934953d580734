#include "megaviews/hierarchy/surface_sums.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shaders/shared/surface.glsl"

namespace mv {
namespace {

constexpr double kLeastWeight = 1e-18;  // a leaf of 1024^3 has faces of 1e-6
constexpr double kCosFlat = 0.5;        // 60 degrees
constexpr double kOffPlane = 5e-6;      // a quarter of kVplOffset

// What leaves and inner nodes have in common: parts, each with sums of its own.
template <typename Part>
void addPlain(SurfaceSums& s, const Part& part, double weight) {
    s.lo = glm::min(s.lo, part.lo);
    s.hi = glm::max(s.hi, part.hi);
    s.area += part.area;
    s.weight += weight;
}

// Adds a vector that has no side to a sum whose side is that of `side`.
void addFlipped(glm::dvec3& sum, glm::dvec3 v, glm::dvec3 side) {
    sum += glm::dot(v, side) < 0 ? -v : v;
}
bool leans(glm::dvec3 unit, glm::dvec3 sum) {
    return !(std::abs(glm::dot(unit, sum)) >= kCosFlat * glm::length(sum));
}
glm::dvec3 unitOr0(glm::dvec3 v) {
    const double l = glm::length(v);
    return l > 0 ? v / l : glm::dvec3(0);
}

// Smallest float not below x >= 0.
float roundUp(double x) {
    const auto f = static_cast<float>(x);
    return static_cast<double>(f) < x ? std::nextafter(f, std::numeric_limits<float>::max()) : f;
}

}  // namespace

SurfaceSums SurfaceSums::ofFragments(std::span<const Fragment> fragments) {
    SurfaceSums s;
    const Fragment* largest = nullptr;
    for (const Fragment& f : fragments) {
        const double weight = std::max(f.area, kLeastWeight);
        addPlain(s, f, weight);
        s.centroid += f.centroid * weight;
        if (!largest || f.area > largest->area) largest = &f;
    }
    for (const Fragment& f : fragments)
        addFlipped(s.plane, f.faceNormal * std::max(f.area, kLeastWeight), largest->faceNormal);
    for (const Fragment& f : fragments) s.flat = s.flat && !leans(f.faceNormal, s.plane);
    const glm::dvec3 normal = unitOr0(s.plane), mean = s.centroid / s.weight;
    const double radius = 0.5 * glm::length(s.hi - s.lo);
    s.planar = s.flat;
    for (const Fragment& f : fragments) {
        const double off = std::abs(glm::dot(normal, f.centroid - mean)) +
                           radius * glm::length(glm::cross(normal, f.faceNormal));
        s.planar = s.planar && off <= kOffPlane;
    }
    return s;
}

SurfaceSums SurfaceSums::ofChildren(std::span<const SurfaceSums> children) {
    if (children.size() == 1) return children[0];
    SurfaceSums s;
    const SurfaceSums* largest = nullptr;
    for (const SurfaceSums& c : children) {
        addPlain(s, c, c.weight);
        s.centroid += c.centroid;
        if (!largest || c.area > largest->area) largest = &c;
    }
    for (const SurfaceSums& c : children) addFlipped(s.plane, c.plane, largest->plane);
    for (const SurfaceSums& c : children)
        s.flat = s.flat && c.flat && !leans(unitOr0(c.plane), s.plane);
    return s;
}

SceneNode SurfaceSums::node(std::uint32_t level, std::uint32_t children) const {
    SceneNode n{};
    n.children = children;
    n.level = level;
    const glm::dvec3 mean = glm::clamp(centroid / weight, lo, hi);
    float* const center[3] = {&n.centerX, &n.centerY, &n.centerZ};
    float* const half[3] = {&n.halfX, &n.halfY, &n.halfZ};
    float* const point[3] = {&n.centroidX, &n.centroidY, &n.centroidZ};
    for (int k = 0; k < 3; ++k) {
        *center[k] = static_cast<float>(0.5 * (lo[k] + hi[k]));
        const double c = *center[k];
        *half[k] = roundUp(std::max({hi[k] - c, c - lo[k], 0.0}));
        *point[k] = static_cast<float>(mean[k]);
        // Rounding may carry the centroid out of a box thinner than an ulp.
        *half[k] = std::max(*half[k], roundUp(std::abs(double{*point[k]} - c)));
    }
    const bool usable = flat && glm::length(plane) > 0;
    n.surface = packSurface(glm::vec3(unitOr0(plane)), usable);
    if (planar && surfaceUsable(n.surface)) n.surface |= kSurfacePlanar;
    return n;
}

SceneNode rootOver(std::span<const SceneNode> children, std::uint32_t packed) {
    SurfaceSums sums;
    for (const SceneNode& n : children) {
        const glm::dvec3 c(n.centerX, n.centerY, n.centerZ), h(n.halfX, n.halfY, n.halfZ);
        sums.lo = glm::min(sums.lo, c - h);
        sums.hi = glm::max(sums.hi, c + h);
        sums.centroid += glm::dvec3(n.centroidX, n.centroidY, n.centroidZ);
    }
    sums.weight = static_cast<double>(children.size());
    sums.flat = false;
    return sums.node(0, packed);
}

}  // namespace mv
