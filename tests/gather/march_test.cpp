// The march of the scene octree: the walk against every leaf one by one, what blocks and what does
// not at walls of any thickness and slant, and what it says of whole rooms against triangles.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gather/random_views.h"
#include "hierarchy/test_scenes.h"
#include "megaviews/gather/gather.h"
#include "megaviews/methods/rays/march_tree.h"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/pair.glsl"
#include "shaders/shared/surface.glsl"

namespace mv {
namespace {

using test::direction;
using test::point;
using test::Rng;
using test::uniform;

SceneHierarchy treeOf(const Scene& scene, int levels) {
    const TriangleBvh bvh = TriangleBvh::build(scene);
    return SceneHierarchy::build(scene, bvh, levels);
}

// Blocked by any leaf of the hierarchy itself, in double precision; leaves and ways are larger
// (smaller) by `slack`, root-cube units.
bool anyLeafBlocks(const SceneHierarchy& scene, glm::dvec3 from, glm::dvec3 to, double slack) {
    const double leaf = 1.0 / (1 << (scene.levels - 1));
    const glm::dvec3 d = to - from;
    const double l = glm::length(d), gap = double{kMarchGap} * leaf / l;
    const double first = gap - slack / l, last = 1 - gap + slack / l;
    if (!(first < last)) return false;
    for (const SceneNode& node : scene.nodes) {
        if (node.children != 0) continue;
        const glm::dvec3 c(boxCenter(node)), h(boxHalf(node));
        const glm::dvec3 low = c - h - slack, high = c + h + slack;
        double enter = -1e300, leave = 1e300;
        for (int k = 0; k < 3; ++k) {
            const double inverse = 1 / (d[k] != 0 ? d[k] : 1e-30);
            const double a = (low[k] - from[k]) * inverse, b = (high[k] - from[k]) * inverse;
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        if (std::max(enter, first) > std::min(leave, last)) continue;
        if (!surfaceUsable(node.surface)) {
            if (enter > first && leave < last) return true;
            continue;
        }
        const glm::dvec3 n(surfaceNormal(node.surface));
        const double t = glm::dot(n, glm::dvec3(centroidOf(node)) - from) / glm::dot(n, d);
        const glm::dvec3 out = glm::abs(from + d * t - c) - h;
        const double margin = double{kMarchMargin} * glm::length(h) + slack;
        if (t > first && t < last && std::max({out.x, out.y, out.z}) <= margin) return true;
    }
    return false;
}

TEST(March, FindsWhatEveryLeafOneByOneFinds) {
    for (const int levels : {1, 2, 5, 7}) {
        const Scene scene = test::randomTriangles(60, 7 + static_cast<uint>(levels));
        const SceneHierarchy tree = treeOf(scene, levels);
        const MarchTree march = MarchTree::build(tree);
        ASSERT_EQ(march.nodes.size(), tree.nodes.size());
        Rng rng(5);
        int blocked = 0, free = 0, different = 0;
        for (int i = 0; i < 1500; ++i) {
            const vec3 a = point(rng), b = point(rng);
            const bool got = march.blocked(a, vec3(0), b, vec3(0));
            const bool expected = anyLeafBlocks(tree, a, b, 0);
            (got ? blocked : free) += 1;
            // Boxes and planes are rounded: only what is this near may differ.
            if (got != expected) {
                ++different;
                const double slack = 0.01 * double{march.leafEdge} + 2 / double{kMarchGrid};
                EXPECT_NE(anyLeafBlocks(tree, a, b, slack), anyLeafBlocks(tree, a, b, -slack))
                    << "levels " << levels << " ray " << i;
            }
        }
        EXPECT_LT(different, 30) << levels;
        if (levels >= 5) {
            EXPECT_GT(blocked, 50) << levels;
            EXPECT_GT(free, 200) << levels;
        }
    }
}

TEST(March, NothingIsInTheWayOfNothing) {
    const MarchTree empty = MarchTree::build(SceneHierarchy{});
    EXPECT_FALSE(empty.blocked({0.1f, 0.1f, 0.1f}, {0, 1, 0}, {0.9f, 0.9f, 0.9f}, {0, -1, 0}));
    // No way at all, and one shorter than the gaps at its ends.
    Scene scene;
    test::addTriangle(scene, {0.2f, 0.5f, 0.2f}, {0.8f, 0.5f, 0.2f}, {0.5f, 0.5f, 0.8f});
    const MarchTree march = MarchTree::build(treeOf(scene, 6));
    const vec3 p(0.5f, 0.5f, 0.4f);
    EXPECT_FALSE(march.blocked(p, vec3(0), p, vec3(0)));
    const vec3 d(0, 0.2f / 32, 0);
    EXPECT_FALSE(march.blocked(p - d, vec3(0), p + d, vec3(0)));
}

// A wall of one triangle pair through the middle of the cube, tilted; ends on either side of it.
TEST(March, AThinWallBlocksWhatCrossesItAndNothingElse) {
    for (int levels = 1; levels <= 11; levels += levels < 7 ? 1 : 2) {
        for (const vec3 n :
             {vec3(0, 1, 0), normalize(vec3(0.3f, 1, 0.2f)), normalize(vec3(-0.6f, 0.5f, 0.7f))}) {
            const vec3 u = normalize(cross(n, vec3(1, 0.1f, 0))), v = cross(n, u);
            const float reach = levels > 8 ? 0.05f : 0.3f;
            const vec3 c(0.503f);
            Scene scene;
            test::addQuad(scene, c - (u + v) * reach, c + (u - v) * reach, c + (u + v) * reach,
                          c + (v - u) * reach);
            const MarchTree march = MarchTree::build(treeOf(scene, levels));
            Rng rng(static_cast<unsigned>(levels));
            int tested = 0;
            for (int i = 0; i < 400; ++i) {
                const auto onWall = [&] {
                    return c + u * uniform(rng, -0.9f, 0.9f) * reach +
                           v * uniform(rng, -0.9f, 0.9f) * reach;
                };
                const vec3 a = onWall() + n * uniform(rng, 0.1f, 0.5f) * reach;
                const vec3 b = onWall() + n * uniform(rng, 0.1f, 0.5f) * reach;
                const vec3 below = b - n * (2 * dot(b - c, n));
                // From the wall itself along it and away from it; from above to above.
                const vec3 q = onWall();
                ASSERT_FALSE(march.blocked(q, n, onWall(), n)) << levels << " " << i;
                ASSERT_FALSE(march.blocked(q, n, b, vec3(0))) << levels << " " << i;
                ASSERT_FALSE(march.blocked(a, n, b, -n)) << levels << " " << i;
                // Through it, if neither end is so near that the octree cannot tell.
                if (0.1f * reach > 1.0f * march.leafEdge) {
                    ++tested;
                    ASSERT_TRUE(march.blocked(a, -n, below, n)) << levels << " " << i;
                }
            }
            if (levels >= 7) {
                EXPECT_GT(tested, 300);
            }
        }
    }
}

// A view just behind the wall that the receiver stands on, and a receiver whose own wall has a
// back.
TEST(March, AWallHidesTheViewBehindIt) {
    Scene scene;
    for (const float y : {0.5f, 0.53f}) {  // a wall two leaves thick, seen from below
        test::addQuad(scene, {0.1f, y, 0.1f}, {0.9f, y, 0.1f}, {0.9f, y, 0.9f}, {0.1f, y, 0.9f});
    }
    const MarchTree march = MarchTree::build(treeOf(scene, 7));
    const vec3 receiver(0.4f, 0.5f, 0.4f), down(0, -1, 0), up(0, 1, 0);
    EXPECT_TRUE(march.blocked({0.4f, 0.2f, 0.4f}, up, {0.5f, 0.5301f, 0.5f}, up));
    EXPECT_TRUE(march.blocked(receiver, down, {0.5f, 0.9f, 0.5f}, down));
    EXPECT_FALSE(march.blocked(receiver, down, {0.5f, 0.2f, 0.5f}, up));
}

// A plane across the middle of its leaf: what counts begins a gap before the end of the way.
TEST(March, KnowsWhereInItsLeafAPlaneStands) {
    constexpr int kLevels = 5;
    constexpr float kLeaf = 1.0f / 16;
    const vec3 center = vec3(8.5f) * kLeaf, n = normalize(vec3(1, 0, 1));
    const vec3 u = vec3(1, 0, -1) * (0.4f * kLeaf), v = vec3(0, 0.4f * kLeaf, 0);
    Scene scene;
    test::addQuad(scene, center - u - v, center + u - v, center + u + v, center - u + v);
    const MarchTree march = MarchTree::build(treeOf(scene, kLevels));
    ASSERT_EQ(march.leafEdge, kLeaf);
    // Heights are kept in steps of 1 / 127 of what the plane can reach: 0.0045 leaves here.
    for (const vec3 side : {n, -n}) {
        const vec3 from = center - side * (4 * kLeaf);
        const auto to = [&](float leaves) { return center + side * (leaves * kLeaf); };
        EXPECT_FALSE(march.blocked(from, vec3(0), to(kMarchGap - 0.003f), vec3(0)));
        EXPECT_TRUE(march.blocked(from, vec3(0), to(kMarchGap + 0.003f), vec3(0)));
    }
}

// Ways along an axis, in the very plane of a box's lower side: no 0 / 0.
TEST(March, WaysInTheSidesOfBoxesMeetThem) {
    Scene scene;
    test::addQuad(scene, {0, 0.5f, 0}, {1, 0.5f, 0}, {1, 0.5f, 1}, {0, 0.5f, 1});
    const MarchTree march = MarchTree::build(treeOf(scene, 5));
    for (const vec3 middle : {vec3(0, 0.5f, 0), vec3(0.5f, 0.5f, 0), vec3(0, 0.5f, 0.5f)}) {
        for (const vec3 offset : {vec3(0, 0.3f, 0), vec3(0, -0.3f, 0)}) {
            EXPECT_TRUE(march.blocked(middle - offset, vec3(0), middle + offset, vec3(0)))
                << middle.x << " " << middle.z;
        }
    }
}

TEST(March, GivesUpAtItsLimitAndSaysSo) {
    Scene scene;
    test::addQuad(scene, {0.2f, 0.6f, 0.2f}, {0.8f, 0.6f, 0.2f}, {0.8f, 0.6f, 0.8f},
                  {0.2f, 0.6f, 0.8f});
    const MarchTree march = MarchTree::build(treeOf(scene, 8));
    const vec3 from(0.5f, 0.4f, 0.5f), to(0.5f, 0.9f, 0.5f);
    uint steps = 0;
    EXPECT_FALSE(marchBlocked(march.data(), from, vec3(0), to, vec3(0), 2, steps));
    EXPECT_EQ(steps, 3u);
    EXPECT_TRUE(marchBlocked(march.data(), from, vec3(0), to, vec3(0), 500, steps));
    EXPECT_LE(steps, 500u);
}

// What an alpha mask cuts away is no surface and hides nothing.
TEST(March, MaskedSurfaceHidesNothing) {
    Scene scene;
    test::addQuad(scene, {0.2f, 0.5f, 0.2f}, {0.8f, 0.5f, 0.2f}, {0.8f, 0.5f, 0.8f},
                  {0.2f, 0.5f, 0.8f});
    test::addQuad(scene, {0.2f, 0.1f, 0.2f}, {0.8f, 0.1f, 0.2f}, {0.8f, 0.1f, 0.8f},
                  {0.2f, 0.1f, 0.8f});
    scene.materials.emplace_back();
    scene.triangleMaterials[0] = scene.triangleMaterials[1] = 1;
    const vec3 from(0.5f, 0.3f, 0.5f), to(0.4f, 0.9f, 0.5f);
    EXPECT_TRUE(MarchTree::build(treeOf(scene, 6)).blocked(from, vec3(0), to, vec3(0)));
    scene.materials[1].alphaCutoff = 0.5f;
    scene.materials[1].baseColor.w = 0.25f;
    EXPECT_FALSE(MarchTree::build(treeOf(scene, 6)).blocked(from, vec3(0), to, vec3(0)));
}

// A room with a block: light that leaks and light that is lost, of all that triangles let through.
TEST(March, AgreesWithTrianglesUpToTheLeaves) {
    Scene scene;
    const auto box = [&](vec3 lo, vec3 hi) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const float at : {lo[axis], hi[axis]}) {
                vec3 corner[4];
                for (int i = 0; i < 4; ++i) {
                    corner[i][axis] = at;
                    corner[i][(axis + 1) % 3] = (i == 1 || i == 2 ? hi : lo)[(axis + 1) % 3];
                    corner[i][(axis + 2) % 3] = (i >= 2 ? hi : lo)[(axis + 2) % 3];
                }
                test::addQuad(scene, corner[0], corner[1], corner[2], corner[3]);
            }
        }
    };
    box(vec3(0.11f), vec3(0.89f));
    box({0.4f, 0.11f, 0.35f}, {0.6f, 0.5f, 0.55f});
    const TriangleBvh bvh = TriangleBvh::build(scene);
    double errorBefore = 1;
    for (const int levels : {6, 8}) {
        const MarchTree march = MarchTree::build(SceneHierarchy::build(scene, bvh, levels));
        Rng rng(3);
        double lit = 0, dark = 0, leaked = 0, lost = 0;
        for (int i = 0; i < 20000; ++i) {
            const auto onSurface = [&](vec3& n) {
                const vec3 from(0.3f, 0.7f, 0.7f), d = direction(rng);
                const auto hit = bvh.intersect(from, d, 0, 10);
                n = scene.normals[scene.triangles[hit->triangle].x];
                if (dot(n, d) > 0) n = -n;
                return from + d * hit->t;
            };
            vec3 np(0), nq(0);
            const vec3 p = onSurface(np);
            vec3 q = onSurface(nq);
            q += nq * 2e-5f;
            const double term = double{gatherTerm(q - p, np, nq, false, 0.01f, 0)};
            if (!(term > 0)) continue;
            const vec3 lifted = p + np * 2e-5f;
            const bool blocked = bvh.occluded(lifted, q - lifted, 0, 1);
            const bool got = march.blocked(p, np, q, nq);
            (blocked ? dark : lit) += term;
            if (blocked && !got) leaked += term;
            if (!blocked && got) lost += term;
        }
        EXPECT_GT(dark, 0.01 * lit);  // there is something to find
        // What is lost is lost in corners, whose leaves are boxes.
        EXPECT_LT(leaked, 0.002 * lit);
        EXPECT_LT(lost, (levels == 6 ? 0.03 : 0.01) * lit);
        EXPECT_LT((leaked + lost) / lit, 0.5 * errorBefore);
        errorBefore = (leaked + lost) / lit;
    }
}

}  // namespace
}  // namespace mv
