#pragma once
// Exact triangle-box overlap and clipping for the voxelisation (Scene -> SceneHierarchy). All in
// double over root-cube coordinates, whose grid planes are exact. Cells are half open: a face that
// lies in a grid plane belongs to the cell above it, touching in an edge or a point is no overlap;
// so the cells cut a surface into pieces without a gap or a doubled face.

#include <array>
#include <cstdint>

#include <glm/glm.hpp>

namespace mv {

struct BoxTriangle {
    std::array<glm::dvec3, 3> corners;
    glm::dvec3 lo, hi;
    glm::dvec3 areaNormal;  // its length is twice the area; zero for a degenerate triangle
    BoxTriangle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c);
};

// Which of a cell's eight children a triangle overlaps, given that it overlaps the cell: bit
// x + 2 y + 4 z of the child. Separating axes: box faces, triangle plane, the nine edge products.
std::uint8_t overlappedChildren(const BoxTriangle& t, glm::dvec3 cellCenter, double cellHalf);

// The part of a triangle inside a closed box: at most nine corners, in winding order.
struct ClippedTriangle {
    std::array<glm::dvec3, 10> corners;
    int count = 0;
    double area = 0;
    glm::dvec3 centroid{0};  // by area; the mean of the corners if there is no area
};
ClippedTriangle clip(const BoxTriangle& t, glm::dvec3 lo, glm::dvec3 hi);

}  // namespace mv
