#include "megaviews/hierarchy/triangle_box.h"

#include <algorithm>
#include <cmath>

namespace mv {

BoxTriangle::BoxTriangle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c)
    : corners{a, b, c},
      lo(glm::min(a, glm::min(b, c))),
      hi(glm::max(a, glm::max(b, c))),
      areaNormal(glm::cross(b - a, c - a)) {}

namespace {

// Children on the low and high side of each axis.
constexpr std::uint8_t kLowSide[3] = {0x55, 0x33, 0x0F};
constexpr std::uint8_t side(int axis, bool high) {
    return high ? static_cast<std::uint8_t>(~kLowSide[axis]) : kLowSide[axis];
}

// Edge products with box axis k, seen as the 2-D outline of the triangle along k: of the four
// columns of children (on the low or high side of u and v), those that the outline overlaps.
std::uint8_t overlappedColumns(const BoxTriangle& t, int k, glm::dvec3 center, double quarter,
                               std::uint8_t mask) {
    const int u = (k + 1) % 3, v = (k + 2) % 3;
    for (int j = 0; j < 3; ++j) {
        const glm::dvec3& p = t.corners[static_cast<std::size_t>(j)];
        const glm::dvec3& q = t.corners[static_cast<std::size_t>((j + 1) % 3)];
        const glm::dvec3& opposite = t.corners[static_cast<std::size_t>((j + 2) % 3)];
        const double au = p[v] - q[v], av = q[u] - p[u];  // normal of the edge
        const double reach = (std::abs(au) + std::abs(av)) * quarter;
        if (reach == 0) continue;
        const double onEdge = 0;
        const double across = au * (opposite[u] - p[u]) + av * (opposite[v] - p[v]);
        const double lo = std::min(onEdge, across) - reach, hi = std::max(onEdge, across) + reach;
        const double middle = au * (center[u] - p[u]) + av * (center[v] - p[v]);
        std::uint8_t kept = 0;
        for (int column = 0; column < 4; ++column) {
            const bool uHigh = column & 1, vHigh = column & 2;
            const double at = middle + (uHigh ? au : -au) * quarter + (vHigh ? av : -av) * quarter;
            if (at > lo && at < hi)
                kept = static_cast<std::uint8_t>(kept | (side(u, uHigh) & side(v, vHigh)));
        }
        mask &= kept;
    }
    return mask;
}

}  // namespace

std::uint8_t overlappedChildren(const BoxTriangle& t, glm::dvec3 center, double cellHalf) {
    // Faces of the boxes; a triangle flat in an axis goes to the upper cell of two.
    std::uint8_t mask = 0xFF;
    int flatAxis = -1;
    for (int k = 0; k < 3; ++k) {
        const bool flat = t.lo[k] == t.hi[k];
        if (flat) flatAxis = k;
        if (t.lo[k] >= center[k]) mask &= side(k, true);
        if (flat ? t.hi[k] < center[k] : t.hi[k] <= center[k]) mask &= side(k, false);
    }
    if ((mask & (mask - 1)) == 0) return mask;

    const double quarter = cellHalf * 0.5;
    if (flatAxis >= 0) return overlappedColumns(t, flatAxis, center, quarter, mask);

    // The triangle's plane.
    const glm::dvec3 n = t.areaNormal;
    const double reach = (std::abs(n.x) + std::abs(n.y) + std::abs(n.z)) * quarter;
    const double middle = glm::dot(n, center - t.corners[0]);
    for (int child = 0; child < 8; ++child) {
        const double at = middle + (child & 1 ? n.x : -n.x) * quarter +
                          (child & 2 ? n.y : -n.y) * quarter + (child & 4 ? n.z : -n.z) * quarter;
        if (!(std::abs(at) < reach)) mask &= static_cast<std::uint8_t>(~(1 << child));
    }
    for (int k = 0; k < 3 && mask; ++k) mask = overlappedColumns(t, k, center, quarter, mask);
    return mask;
}

namespace {

// Keeps the side of the plane x[axis] = at where sign * (x - at) <= 0 [SH74].
void clipToPlane(ClippedTriangle& polygon, int axis, double at, double sign) {
    const ClippedTriangle in = polygon;
    polygon.count = 0;
    for (int i = 0; i < in.count; ++i) {
        const glm::dvec3& p = in.corners[static_cast<std::size_t>(i)];
        const glm::dvec3& q = in.corners[static_cast<std::size_t>((i + 1) % in.count)];
        const double dp = sign * (p[axis] - at), dq = sign * (q[axis] - at);
        if (dp <= 0) polygon.corners[static_cast<std::size_t>(polygon.count++)] = p;
        if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
            // From the inner end, so that both neighbours of a shared edge cut it alike.
            const glm::dvec3& a = dp < 0 ? p : q;
            const glm::dvec3& b = dp < 0 ? q : p;
            glm::dvec3 x = a + (b - a) * ((at - a[axis]) / (b[axis] - a[axis]));
            x = glm::clamp(x, glm::min(a, b), glm::max(a, b));
            x[axis] = at;
            polygon.corners[static_cast<std::size_t>(polygon.count++)] = x;
        }
    }
}

}  // namespace

ClippedTriangle clip(const BoxTriangle& t, glm::dvec3 lo, glm::dvec3 hi) {
    ClippedTriangle polygon;
    std::copy(t.corners.begin(), t.corners.end(), polygon.corners.begin());
    polygon.count = 3;
    for (int k = 0; k < 3; ++k) {
        if (t.lo[k] < lo[k]) clipToPlane(polygon, k, lo[k], -1);
        if (t.hi[k] > hi[k]) clipToPlane(polygon, k, hi[k], 1);
    }
    if (polygon.count == 0) return polygon;

    // Area and centroid by a fan around the first corner.
    glm::dvec3 moment(0), mean(0);
    double doubledArea = 0;
    const glm::dvec3 a = polygon.corners[0];
    for (int i = 1; i + 1 < polygon.count; ++i) {
        const glm::dvec3 b = polygon.corners[static_cast<std::size_t>(i)] - a;
        const glm::dvec3 c = polygon.corners[static_cast<std::size_t>(i + 1)] - a;
        const double doubled = glm::length(glm::cross(b, c));
        doubledArea += doubled;
        moment += (b + c) * (doubled / 3);
    }
    for (int i = 0; i < polygon.count; ++i) mean += polygon.corners[static_cast<std::size_t>(i)];
    polygon.area = 0.5 * doubledArea;
    polygon.centroid = doubledArea > 0 ? a + moment / doubledArea : mean / double(polygon.count);
    return polygon;
}

}  // namespace mv
