#pragma once
// Sums over the surface below one node, from which the node is made: first from clipped triangles
// or a sample at the leaves, then from children (Scene -> SceneHierarchy).

#include <span>

#include "megaviews/hierarchy/scene_hierarchy.h"

namespace mv {

// A triangle's part inside a leaf.
struct Fragment {
    glm::dvec3 lo, hi, centroid;
    glm::dvec3 faceNormal;  // unit
    double area;
};

struct SurfaceSums {
    glm::dvec3 lo{1e300}, hi{-1e300};
    double area = 0;
    double weight = 0;       // area, but never zero
    glm::dvec3 centroid{0};  // times weight
    glm::dvec3 plane{0};     // face normals times weight, flipped to the largest part's side
    bool flat = true;        // no part leans more than 60 degrees from `plane`
    bool planar = false;     // leaves only: no part is off one plane by a quarter of VPLs' lift

    static SurfaceSums ofFragments(std::span<const Fragment> fragments);
    static SurfaceSums ofChildren(std::span<const SurfaceSums> children);
    SceneNode node(std::uint32_t level, std::uint32_t children) const;
};

// A root, without a surface of its own, over other nodes.
SceneNode rootOver(std::span<const SceneNode> children, std::uint32_t packed);

}  // namespace mv
