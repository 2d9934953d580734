#pragma once
// ManyLoDs' scene hierarchy (Scene -> SceneHierarchy) [HREB11 §4]: uniform samples of the surface
// under a complete binary tree of bounds. It has the form of the octree, so whatever descends the
// one descends the other, on CPU and GPU. A sample lies on a triangle by barycentric coordinates:
// where that moves it is carried along, and bounds follow from the leaves up, level by level. The
// tree itself is never built again.
//
// Where it departs from the paper: a leaf is not a ball but the disc of surface that its sample
// stands for, so that nodes can tell planes and boxes; under the published rules nodes are balls.
// What moves has a tree of its own beside that of what stands, below a common root.

#include <cstdint>
#include <vector>

#include "megaviews/core/progress.h"
#include "megaviews/hierarchy/scene_hierarchy.h"

namespace mv {

// A sample on a triangle, at a + s (b - a) + t (c - a).
struct TreeSample {
    std::uint32_t triangle;
    float s, t;
    float share;  // of the triangle's area; of many small triangles it is more than 1
};

struct SampleTree {
    std::vector<TreeSample> points;  // of the leaves, in their order; what moves comes last
    std::uint32_t standing = 0;      // of what stands; the numbers of both are powers of two or 0
    float leafRadius = 0;            // of the largest disc, root-cube units
};

// Radius of a sample's disc over that of a disc of as much surface as it stands for. With 1.25 the
// leaves' boxes leave a hundredth of a plane uncovered, with 1 a tenth; larger discs hide more of
// what lies beyond an edge.
inline constexpr double kDiscScale = 1.25;

// Samples at most of what stands.
inline constexpr double kMostSamples = 1 << 21;

// Samples of the triangles [firstTriangle, endTriangle), even by area as the scene stands: `count`
// of them, or none where there is no surface. Stratified along the triangles in Morton order and,
// on each, of low discrepancy. Holes of alpha masks get none. Deterministic.
std::vector<TreeSample> sampleSurface(const Scene& scene, const TriangleBvh& bvh,
                                      std::size_t firstTriangle, std::size_t endTriangle,
                                      std::uint32_t count);

// Where a sample lies as the scene stands, root-cube units.
glm::dvec3 positionOf(const Scene& scene, const TreeSample& point);

// The tree over the scene as it stands, what moves included. levels in 1..11: of the octree that
// has about as many leaves. The number of samples follows: area times |x| + |y| + |z| of its
// normal, which is how many cells a plane meets, over a leaf's edge squared, to the nearest power
// of two.
SceneHierarchy buildSampleTree(const Scene& scene, const TriangleBvh& bvh, int levels,
                               const Progress& progress = {});

// After poseScene(): samples, boxes and planes of what moves, and the root. SceneHierarchy::refit()
// calls it.
void refitSampleTree(SceneHierarchy& hierarchy, const Scene& scene);

// Nodes for the published rules: each a cube whose bounding ball is the node's bounding sphere,
// which is that of its children's [HREB11 §4].
SceneNodes sphereNodes(const SceneHierarchy& hierarchy);

}  // namespace mv
