#pragma once
// The part of the scene octree that an animation moves (Scene -> SceneHierarchy): an octree over
// what moves, built once in the pose in which its surface is largest, that hangs below the root
// beside what stands. Its leaves remember their pieces of triangles; for another pose these are
// carried along, and boxes, centroids and planes follow from the leaves up, as [HREB11 §4] refits
// its tree. So nodes keep their numbers, and nothing has to be voxelised again; what is given up is
// that leaves are cubes: where a surface turns, its boxes overlap.

#include <cstdint>
#include <vector>

#include "megaviews/hierarchy/surface_sums.h"

namespace mv {

// A piece of a triangle inside a leaf, as it was cut.
struct MovingPiece {
    std::uint32_t triangle = 0;
    std::uint32_t firstCorner = 0, corners = 0;  // into MovingSurface::corners
    float coverage = 1;
};

struct MovingSurface {
    std::vector<std::uint32_t> begin;   // into the hierarchy's nodes, by level: the first that move
    std::vector<std::uint32_t> pieces;  // of each leaf, the first; one more than leaves
    std::vector<MovingPiece> all;
    std::vector<glm::vec2> corners;  // barycentric weights of the 2nd and 3rd corner

    // Sums over one leaf's surface, as the scene stands.
    SurfaceSums sumsOf(const Scene& scene, std::size_t leaf) const;
};

// Leaves of the moving part at most, about: a finer tree would cost more each frame than all else.
inline constexpr double kMostMovingLeaves = 1 << 17;

}  // namespace mv
