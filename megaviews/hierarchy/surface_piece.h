#pragma once
// Triangles cut up along the octree's grid planes, which makes the voxelisation exact (Scene ->
// SceneHierarchy): a cell holds a triangle if and only if a piece of it is left inside. In double
// over root-cube coordinates, where grid planes are exact. Cells are half open: a face that lies in
// a grid plane belongs to the cell above it, and touching in an edge or a point leaves no piece; so
// the pieces tile the surface without a gap or a doubled face.

#include <array>
#include <cstdint>

#include <glm/glm.hpp>

#include "megaviews/scene/scene.h"

namespace mv {

// The part of a triangle inside a box: a convex polygon, corners in the triangle's winding order.
struct SurfacePiece {
    static constexpr std::size_t kMaxCorners = 16;  // 9, and what rounding may double
    glm::dvec3 lo, hi;                              // tight
    std::uint32_t triangle;
    std::uint32_t count;
    std::array<glm::dvec3, kMaxCorners> corners;

    SurfacePiece() {}  // uninitialised: pieces are many and large
    SurfacePiece(const SurfacePiece& other) { *this = other; }
    SurfacePiece& operator=(const SurfacePiece& other);
    static SurfacePiece whole(const Scene& scene, std::uint32_t triangle);

    void add(glm::dvec3 corner);  // a corner equal to the one before is not added again
    double area() const;
    glm::dvec3 centroid() const;  // by area; the mean of the corners if there is no area
};

// Whether a whole triangle has an area. Corners are single precision: where a triangle is no wider
// than their rounding, its area and plane are rounding alone, and nodes made of it would hide what
// it cannot. False for NaN.
bool hasSurface(const SurfacePiece& triangle);

// Cuts a piece at a plane. out[0] is what lies below it, out[1] above; nullptr where nothing does.
// A piece that is not cut is passed through; storage takes the halves of one that is.
void cut(const SurfacePiece& piece, int axis, double at, SurfacePiece (&storage)[2],
         const SurfacePiece* (&out)[2]);

// Barycentric weights of a triangle's second and third corner at points of its plane: linear, so
// two dot products a point. Not finite where the triangle has no area.
struct CornerWeights {
    glm::dvec3 origin, toSecond, toThird;

    CornerWeights(const Scene& scene, std::uint32_t triangle);
    glm::dvec2 at(glm::dvec3 point) const;
};

// What lies in a cell; false if nothing does. The root cube's own faces do not cut.
bool clipToCell(SurfacePiece& piece, glm::dvec3 lo, glm::dvec3 hi);

}  // namespace mv
