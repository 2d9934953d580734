#pragma once
// Small scenes and views made of surface samples, for tests of the traversal on either processor:
// octrees with tight boxes and surface planes, without triangles, files or voxelisation.

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/hierarchy/view_hierarchy.h"
#include "megaviews/settings/settings.h"
#include "shaders/shared/types.glsl"

namespace mv::testing {

// A patch of surface: centre, two half edges, normal = their cross product.
struct Patch {
    vec3 center{0}, du{0}, dv{0};
};

struct SyntheticScene {
    SceneNodes nodes;  // as the corrected rules see them; level by level, root first
    std::array<SceneNodes, kNodeTables> tables;  // by sceneTable()
    std::vector<std::uint32_t> levelBegin;
    std::vector<Patch> patches;
    int levels = 0;
    std::vector<std::uint32_t> leaves() const;
};
inline constexpr uint kBothRules[] = {kCorrectedRules, kPublishedRules};
// The published rules with one correction more each, the last but one before all; then each alone.
inline std::vector<uint> rulesBetween() {
    std::vector<uint> all;
    for (uint i = 1; i < kRuleCount; ++i) all.push_back((1u << i) - 1);
    for (uint i = 1; i < kRuleCount; ++i) all.push_back(1u << i);
    return all;
}
inline const SceneNodes& nodesOf(const SyntheticScene& scene, uint rules) {
    return scene.tables[sceneTable(rules)];
}

// The octree over the patches, each cut to the voxel its centre lies in.
SyntheticScene makeScene(const std::vector<Patch>& patches, int levels);

// A closed room with a row of columns, a sloping roof panel and a wavy curtain.
SyntheticScene makeRoom(int levels);
// `count` unconnected thin fibres: small nodes with much space between them.
SyntheticScene makeFibres(int levels, int count, std::uint32_t seed);
SyntheticScene makeEmptyScene();

// Views a 50th of a leaf above random patches, looking along their normals.
std::vector<View> viewsOnSurfaces(const SyntheticScene& scene, std::size_t count,
                                  std::uint32_t seed);
std::vector<View> particlesInside(std::size_t count, std::uint32_t seed);
// Views whose decisions are of all kinds, near their thresholds too: `count` on surfaces, and a
// quarter as many in the air.
std::vector<View> viewsOfAllKinds(const SyntheticScene& scene, std::size_t count,
                                  std::uint32_t seed);
// Each view goes a way of its own, up to `far`, and turns by up to `far` radians.
void moveViews(std::vector<View>& views, float far, std::mt19937& random);
// The subtree of the root's last child as the part that moves: by level its first node.
std::vector<std::uint32_t> lastSubtree(const SyntheticScene& scene);
// Shifts that subtree, and lets its boxes grow or shrink.
void moveSubtree(const SyntheticScene& scene, const std::vector<std::uint32_t>& begin,
                 std::mt19937& random, SceneNodes& nodes);
View makeView(vec3 position, vec3 normal, std::uint32_t slot, bool omnidirectional = false);

// One level of views: every view a node without parents.
inline ViewHierarchy flat(const std::vector<View>& views) {
    return ViewHierarchy::build(views, {.levels = 1, .flat = true});
}

// Distance along the unit ray to the box around `center`; negative if it is missed.
double rayBox(glm::dvec3 ray, glm::dvec3 center, glm::dvec3 half);

// Uniform in the unit ball's surface.
vec3 randomDirection(std::mt19937& random);
float randomIn(std::mt19937& random, float low, float high);

}  // namespace mv::testing
