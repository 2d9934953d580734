#pragma once
// The tree that stands for the scene (Scene -> SceneHierarchy). Here an octree over the surface:
// conservative voxelisation with exact triangle-box tests at the leaf level, parents bottom-up
// [Kol19 §3.1]; sample_tree.h has a binary tree in the same form. Built once a scene. Levels count
// from the root = 0; "11 levels" means leaves at level 10, a 1024^3 grid.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "megaviews/core/large_vector.h"
#include "megaviews/core/progress.h"
#include "megaviews/scene/scene.h"
#include "megaviews/scene/triangle_bvh.h"
#include "shaders/shared/rules.glsl"

namespace mv {

struct MovingSurface;  // moving_surface.h
struct SampleTree;     // sample_tree.h

using SceneNodes = LargeVector<SceneNode>;

struct SceneHierarchy {
    int levels = 0;                         // 1..11, of a binary tree 1..24; 0 for an empty scene
    SceneNodes nodes;                       // level by level, Morton order within a level
    LargeVector<std::uint32_t> mortonKeys;  // of each node of an octree, 3 bits a level
    std::vector<std::uint32_t> levelBegin;  // levels + 1 entries into nodes
    LargeVector<float> areas;               // surface inside each node, root-cube units squared
    // What the animation moves: the last nodes of each level. Null: nothing does.
    std::shared_ptr<const MovingSurface> moving;
    std::shared_ptr<const SampleTree> samples;  // of a binary tree; null: an octree

    std::uint64_t leafCount() const;
    float leafEdge() const;  // about, root-cube units
    // The same tree as rules see it: without kRuleBoxes boxes are voxels, without kRuleCentroid
    // centroids the boxes' centres. What moves has left its voxels: a cube about its box stands for
    // one. Of a binary tree: sphereNodes().
    SceneNodes nodesUnder(uint rules) const;
    // The same without a copy of nodes that the rules leave as they are: those of others are made
    // in `made`, unless they are there already.
    std::span<const SceneNode> nodesUnder(uint rules, SceneNodes& made) const;

    // levels in 1..11. An empty scene gives an empty hierarchy. Deterministic for any number of
    // threads. Throws Error(ExitCode::impossible) if the tree would exceed 2^28 nodes. Of what
    // stands; joinMoving() adds what moves.
    static SceneHierarchy build(const Scene& scene, const TriangleBvh& bvh, int levels,
                                const Progress& progress = {});
    // Adds the tree over what moves, built in the pose in which the scene stands, of at most as
    // many levels and kMostMovingLeaves leaves.
    void joinMoving(const Scene& scene, const TriangleBvh& bvh, int levels);
    // After poseScene(): the nodes of what moves, and the root.
    void refit(const Scene& scene);
};

// The hierarchy from the cache if it is there, else built and stored; then what moves is joined.
// The file is keyed by scene content and settings, written aside and renamed; the folder is kept
// below a size bound by removing the oldest. A cache that is broken or cannot be written is a
// warning, never an error. directory empty: no cache.
SceneHierarchy buildOrLoad(const Scene& scene, const TriangleBvh& bvh, int levels,
                           const std::filesystem::path& directory, const Progress& progress = {});
std::filesystem::path defaultCacheDirectory();  // $XDG_CACHE_HOME/megaviews or ~/.cache/megaviews

}  // namespace mv
