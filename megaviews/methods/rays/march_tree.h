#pragma once
// The scene octree as shaders/shared/march.glsl walks it: depth first, 16 bytes a node, tight boxes
// and surface elements of the leaves (SceneHierarchy -> MarchTree). Serves the gather of method
// `rays`.

#include <cstdint>
#include <vector>

#include "megaviews/hierarchy/scene_hierarchy.h"
#include "shaders/shared/march.glsl"

namespace mv {

struct MarchTree {
    std::vector<glm::uvec4> nodes;  // see march.glsl; empty for an empty scene
    float leafEdge = 0;             // root-cube units

    static MarchTree build(const SceneHierarchy& scene);
    MarchNodes data() const;  // points into this

    // marchBlocked() without a limit of steps.
    bool blocked(glm::vec3 receiver, glm::vec3 normal, glm::vec3 view, glm::vec3 viewNormal) const;
};

}  // namespace mv
