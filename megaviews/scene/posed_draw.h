#pragma once
// A primitive at one place and time: morphed, skinned, moved to the world in double, then to the
// root cube in float as a Scene has it. Serves the first stage, file -> Scene, and what moves.

#include <optional>
#include <vector>

#include "megaviews/scene/rig.h"

namespace mv {

struct PosedVertices {
    std::vector<glm::dvec3> positions;  // world
    std::vector<glm::dvec3> normals;    // not normalised; empty: flat
    std::vector<bool> mirrored;  // skins: the vertex's matrix turns triangles over; may be empty
    bool allMirrored = false;    // the node's matrix does
    bool turnsOver(glm::uvec3 triangle) const {
        return mirrored.empty() ? allMirrored : mirrored[triangle.x];
    }
};

// Joints are taken to be in range.
PosedVertices pose(const Draw& draw, bool withNormals);

// Bounds the triangles' corners; empty if none of them can be drawn.
struct WorldBox {
    glm::dvec3 min{1e300}, max{-1e300};
    bool empty() const { return !(min.x <= max.x); }
    void add(glm::dvec3 p) { min = glm::min(min, p), max = glm::max(max, p); }
    void add(const WorldBox& b) { min = glm::min(min, b.min), max = glm::max(max, b.max); }
};
WorldBox worldBox(const Draw& draw);
double worldArea(const Draw& draw);  // of the triangles

// What one draw adds to a scene.
struct ScenePiece {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec4> colors;
    std::vector<glm::vec2> uvs, emissiveUvs;
    std::vector<glm::uvec3> triangles;
    std::size_t notFinite = 0, flat = 0, badNormals = 0;
};
// moves: every triangle stays, also one that has no area at this time, so that vertices and
// triangles are the same at all times; what leaves the root cube is held at its faces.
ScenePiece makePiece(const Draw& draw, const RootCube& root, bool moves);

// Determinant times inverse transpose: keeps normals perpendicular, exists for singular matrices.
glm::dmat3 cofactors(const glm::dmat3& m);

// Renumbers the triangles' vertices without gaps; returns which of them are left, ascending.
std::vector<std::uint32_t> dropUnusedVertices(std::vector<glm::uvec3>& triangles,
                                              std::size_t vertices);

}  // namespace mv
