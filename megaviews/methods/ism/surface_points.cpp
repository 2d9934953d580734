#include "megaviews/methods/ism/surface_points.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace mv {
namespace {

constexpr std::uint32_t kDimension = 0x50F7;  // tells these draws from others of the same seed

glm::dvec3 corner(float x, float y, float z) { return {x, y, z}; }

}  // namespace

SurfacePoints makeSurfacePoints(const TriangleBvh& bvh, std::uint64_t count, std::uint32_t seed) {
    SurfacePoints out;
    std::vector<double> before(bvh.triangles.size() + 1, 0);  // area before each triangle
    for (std::size_t i = 0; i < bvh.triangles.size(); ++i) {
        const BvhTriangle& t = bvh.triangles[i];
        const glm::dvec3 a = corner(t.ax, t.ay, t.az);
        const glm::dvec3 n = glm::cross(corner(t.bx, t.by, t.bz) - a, corner(t.cx, t.cy, t.cz) - a);
        before[i + 1] = before[i] + (bvh.isFirst(i) ? 0.5 * glm::length(n) : 0.0);
    }
    out.area = before.back();
    if (!(out.area > 0)) return out;

    const BvhData data = bvh.data();
    out.points.resize(count);
    const auto draw = [&](std::uint32_t index) -> SurfacePoint {
        const vec4 r = random4(seed, index, 0, kDimension);
        const double along =
            (static_cast<double>(index) + double{r.x}) / static_cast<double>(count) * out.area;
        const auto found = std::upper_bound(before.begin() + 1, before.end() - 1, along);
        const auto triangle = static_cast<std::size_t>(found - before.begin()) - 1;
        const BvhTriangle& t = bvh.triangles[triangle];
        // How far into the triangle's area says how far from its first corner.
        const double into = (along - before[triangle]) / (before[triangle + 1] - before[triangle]);
        const double root = std::sqrt(std::clamp(into, 0.0, 1.0));
        const double u = root * (1 - double{r.y}), v = root * double{r.y};
        const glm::dvec3 a = corner(t.ax, t.ay, t.az), b = corner(t.bx, t.by, t.bz),
                         c = corner(t.cx, t.cy, t.cz);
        const glm::vec3 p(a + u * (b - a) + v * (c - a));
        const bool cutOut = (t.material & kMaterialMask) != 0 &&
                            bvhMaskedOut(data, t.triangle, t.material & ~kMaterialMask,
                                         static_cast<float>(u), static_cast<float>(v));
        return {p.x, p.y, p.z, cutOut ? 0u : 1u};
    };
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, out.points.size(), 1024),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i)
                              out.points[i] = draw(static_cast<std::uint32_t>(i));
                      });
    return out;
}

}  // namespace mv
