#pragma once
// Sums over the surface below one node, from which the node and its attributes are made: first from
// clipped triangles or a sample at the leaves, then from children (Scene -> SceneHierarchy).

#include <span>

#include "megaviews/hierarchy/scene_hierarchy.h"

namespace mv {

// A triangle's part inside a leaf.
struct Fragment {
    glm::dvec3 lo, hi, centroid;
    glm::dvec3 faceNormal;  // unit
    glm::dvec3 albedo, emission;
    double area;
    std::array<glm::vec3, 3> vertexNormals;
    bool doubleSided;
};

struct SurfaceSums {
    glm::dvec3 lo{1e300}, hi{-1e300};
    double area = 0;
    double weight = 0;                               // area, but never zero
    glm::dvec3 centroid{0}, albedo{0}, emission{0};  // times weight
    glm::dvec3 plane{0};    // face normals times weight, flipped to the largest part's side
    bool flat = true;       // no part leans more than 60 degrees from `plane`
    bool planar = false;    // leaves only: no part is off one plane by a quarter of VPLs' lift
    glm::dvec3 normals{0};  // vertex normals times weight
    double normalsWeight = 0;
    glm::vec3 axis{0, 0, 1};  // cone of the vertex normals
    float cosCone = 1, sinCone = 0;
    bool culls = true;  // false: the cone is useless

    static SurfaceSums ofFragments(std::span<const Fragment> fragments);
    static SurfaceSums ofChildren(std::span<const SurfaceSums> children);
    SceneNode node(std::uint32_t level, std::uint32_t children) const;
    SceneNodeAttributes attributes() const;
};

// A root, without a surface of its own, over other nodes.
SceneNode rootOver(std::span<const SceneNode> children, std::uint32_t packed);

}  // namespace mv
