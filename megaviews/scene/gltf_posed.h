#pragma once
// A primitive in the pose of one node: morphed, skinned, moved to the world, all in double. Serves
// the first stage, file -> Scene.

#include <optional>
#include <vector>

#include "megaviews/scene/gltf_primitive.h"

namespace mv {

// One primitive at one place.
struct Draw {
    const Primitive* primitive = nullptr;
    glm::dmat4 worldFromModel{1};
    const std::vector<glm::dmat4>* joints = nullptr;    // skin: world from bind pose, a joint each
    const std::vector<double>* morphWeights = nullptr;  // null: none
};

struct PosedVertices {
    std::vector<glm::dvec3> positions;  // world
    std::vector<glm::dvec3> normals;    // not normalised; empty: flat
    std::vector<bool> mirrored;  // skins: the vertex's matrix turns triangles over; may be empty
    bool allMirrored = false;    // the node's matrix does
    bool turnsOver(glm::uvec3 triangle) const {
        return mirrored.empty() ? allMirrored : mirrored[triangle.x];
    }
};

PosedVertices pose(const Draw& draw, bool withNormals, const GltfReport& report);

// Determinant times inverse transpose: keeps normals perpendicular, exists for singular matrices.
glm::dmat3 cofactors(const glm::dmat3& m);

}  // namespace mv
