#pragma once
// What a hierarchy of triangles is built of: boxes around triangles, or around pieces of those that
// fill their box poorly, so that rays meet fewer boxes for nothing.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "megaviews/scene/scene.h"

namespace mv {

// Of points in root-cube units; empty until one is added.
struct PieceBox {
    glm::vec3 min{kInfinity}, max{-kInfinity};
    void add(glm::vec3 p) {
        min = glm::min(min, p);
        max = glm::max(max, p);
    }
    void add(const PieceBox& b) {
        min = glm::min(min, b.min);
        max = glm::max(max, b.max);
    }
    bool isEmpty() const { return glm::any(glm::greaterThan(min, max)); }
    float halfArea() const {
        const glm::vec3 e = max - min;
        return isEmpty() ? 0.0f : e.x * e.y + e.y * e.z + e.z * e.x;
    }
};

struct TrianglePiece {
    PieceBox box;  // of what the piece has of the triangle, good to rounding
    std::uint32_t triangle = 0;
    glm::vec3 centre() const { return 0.5f * (box.min + box.max); }
};

// Pieces of the triangles in [first, end), in their order; together they cover each of them.
// share: so many more pieces than triangles there may be, as a share of these; 0 leaves all whole.
// Cuts go where boxes hold most of nothing, along the planes of an octree over the root cube, which
// many triangles have in common [Karras and Aila 2013, section 4]. The same for any number of
// threads.
std::vector<TrianglePiece> trianglePieces(const Scene& scene, std::size_t first, std::size_t end,
                                          float share);

}  // namespace mv
