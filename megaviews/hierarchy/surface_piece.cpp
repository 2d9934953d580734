#include "megaviews/hierarchy/surface_piece.h"

#include <algorithm>
#include <cassert>

namespace mv {

SurfacePiece& SurfacePiece::operator=(const SurfacePiece& other) {
    lo = other.lo;
    hi = other.hi;
    triangle = other.triangle;
    count = other.count;
    std::copy_n(other.corners.begin(), count, corners.begin());
    return *this;
}

SurfacePiece SurfacePiece::whole(const Scene& scene, std::uint32_t triangle) {
    const glm::uvec3 c = scene.triangles[triangle];
    SurfacePiece p;
    p.triangle = triangle;
    p.count = 3;
    for (int i = 0; i < 3; ++i)
        p.corners[static_cast<std::size_t>(i)] = glm::dvec3(scene.positions[c[i]]);
    p.lo = glm::min(p.corners[0], glm::min(p.corners[1], p.corners[2]));
    p.hi = glm::max(p.corners[0], glm::max(p.corners[1], p.corners[2]));
    return p;
}

void SurfacePiece::add(glm::dvec3 corner) {
    if (count == 0) {
        lo = hi = corner;
    } else {
        if (corner == corners[count - 1]) return;
        lo = glm::min(lo, corner);
        hi = glm::max(hi, corner);
    }
    assert(count < kMaxCorners);
    if (count < kMaxCorners) corners[count++] = corner;
}

double SurfacePiece::area() const {
    glm::dvec3 doubled(0);
    for (std::size_t i = 1; i + 1 < count; ++i)
        doubled += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    return 0.5 * glm::length(doubled);
}

glm::dvec3 SurfacePiece::centroid() const {
    // A fan around the first corner.
    const glm::dvec3 a = corners[0];
    glm::dvec3 moment(0), mean(0);
    double doubledArea = 0;
    for (std::size_t i = 1; i + 1 < count; ++i) {
        const glm::dvec3 b = corners[i] - a, c = corners[i + 1] - a;
        const double doubled = glm::length(glm::cross(b, c));
        doubledArea += doubled;
        moment += (b + c) * doubled;
    }
    if (doubledArea > 0) return a + moment / (3 * doubledArea);
    for (std::size_t i = 0; i < count; ++i) mean += corners[i];
    return mean / static_cast<double>(count);
}

bool hasSurface(const SurfacePiece& t) {
    constexpr double kLeastWidth = 1.0 / (1 << 22);
    const double longest = std::max({glm::length(t.corners[1] - t.corners[0]),
                                     glm::length(t.corners[2] - t.corners[1]),
                                     glm::length(t.corners[0] - t.corners[2])});
    return 2 * t.area() > kLeastWidth * longest;
}

void cut(const SurfacePiece& piece, int axis, double at, SurfacePiece (&storage)[2],
         const SurfacePiece* (&out)[2]) {
    const double lo = piece.lo[axis], hi = piece.hi[axis];
    const bool below = lo < at;
    const bool above = hi > at || (lo == hi && !below);
    out[0] = below ? &piece : nullptr;
    out[1] = above ? &piece : nullptr;
    if (!below || !above) return;

    // Corners on the plane go to both halves, and so do the points where edges cross it [SH74].
    for (SurfacePiece& half : storage) {
        half.triangle = piece.triangle;
        half.count = 0;
    }
    glm::dvec3 p = piece.corners[piece.count - 1];
    double dp = p[axis] - at;
    for (std::size_t i = 0; i < piece.count; ++i) {
        const glm::dvec3 q = piece.corners[i];
        const double dq = q[axis] - at;
        if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
            // From the lower end, so that neighbours across an edge cut it alike.
            const glm::dvec3 a = dp < 0 ? p : q, b = dp < 0 ? q : p;
            glm::dvec3 x = a + (b - a) * (std::min(dp, dq) / (a[axis] - b[axis]));
            x[axis] = at;
            storage[0].add(x);
            storage[1].add(x);
        }
        if (dq <= 0) storage[0].add(q);
        if (dq >= 0) storage[1].add(q);
        p = q;
        dp = dq;
    }
    out[0] = &storage[0];
    out[1] = &storage[1];
}

CornerWeights::CornerWeights(const Scene& scene, std::uint32_t triangle) {
    const glm::uvec3 corner = scene.triangles[triangle];
    origin = glm::dvec3(scene.positions[corner.x]);
    const glm::dvec3 b = glm::dvec3(scene.positions[corner.y]) - origin;
    const glm::dvec3 c = glm::dvec3(scene.positions[corner.z]) - origin;
    const glm::dvec3 n = glm::cross(b, c);
    toSecond = glm::cross(c, n) / glm::dot(n, n);
    toThird = glm::cross(n, b) / glm::dot(n, n);
}

glm::dvec2 CornerWeights::at(glm::dvec3 point) const {
    return {glm::dot(point - origin, toSecond), glm::dot(point - origin, toThird)};
}

bool clipToCell(SurfacePiece& piece, glm::dvec3 lo, glm::dvec3 hi) {
    SurfacePiece storage[2];
    const SurfacePiece* halves[2];
    const auto keep = [&](int axis, double at, int side) {
        cut(piece, axis, at, storage, halves);
        if (!halves[side]) return false;
        if (halves[side] != &piece) piece = *halves[side];
        return true;
    };
    for (int axis = 0; axis < 3; ++axis) {
        if (lo[axis] > 0 && !keep(axis, lo[axis], 1)) return false;
        if (hi[axis] < 1 && !keep(axis, hi[axis], 0)) return false;
    }
    return true;
}

}  // namespace mv
