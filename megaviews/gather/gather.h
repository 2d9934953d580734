#pragma once
// The gather's reference: the sum over all views of one receiver, and the hierarchical culling of
// views that cannot light it [Kol19 §5.1]. Formulas in shaders/shared/gather.glsl.

#include <cstdint>
#include <vector>

#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/hierarchy/view_hierarchy.h"
#include "megaviews/traversal/traversal.h"

namespace mv {

struct Receiver {
    glm::vec3 position;  // root-cube units
    glm::vec3 normal;    // unit
};
struct GatherReferenceOptions {
    float clampDistance = 0.01f;  // root-cube units
    float worldEdge = 1;          // world length of the root cube
    Rules rules = Rules::corrected;
};
// Irradiance-like sum E (everything but albedo/pi) over all sorted views. maps may be null: no
// visibility.
glm::dvec3 gatherAll(const Receiver& receiver, const ViewHierarchy& views, const ViewMaps* maps,
                     const GatherReferenceOptions& options);

// View nodes kept for one receiver node (both at most at `level`): a set of disjoint nodes that
// covers every view which can light any point and normal of the receiver node.
std::vector<std::uint32_t> keptViewNodes(const SceneHierarchy& scene, std::uint32_t sceneNode,
                                         const ViewHierarchy& views, int level);

}  // namespace mv
