#include "megaviews/hierarchy/scene_hierarchy.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>
#include <set>

#include "hierarchy/test_scenes.h"
#include "megaviews/core/error.h"
#include "shaders/shared/morton.glsl"
#include "shaders/shared/pair.glsl"
#include "shaders/shared/surface.glsl"

namespace mv {
namespace {

using test::angle;

using test::addQuad;
using test::addTriangle;
using test::randomTriangles;

SceneHierarchy buildTree(const Scene& scene, int levels) {
    const TriangleBvh bvh = TriangleBvh::build(scene);
    return SceneHierarchy::build(scene, bvh, levels);
}

bool boxHolds(const SceneNode& n, glm::dvec3 p, double slack = 0) {
    const glm::dvec3 d = glm::abs(p - glm::dvec3(boxCenter(n))) - glm::dvec3(boxHalf(n));
    return std::max({d.x, d.y, d.z}) <= slack;
}

// The textbook test, written independently of the voxeliser: signed gap between the triangle and
// the box along all 13 axes; > 0 apart, < 0 overlapping by that much, near 0 touching.
double separation(const std::array<glm::dvec3, 3>& t, glm::dvec3 center, double half) {
    std::vector<glm::dvec3> axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const glm::dvec3 e[3] = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
    axes.push_back(glm::cross(e[0], e[1]));
    for (int k = 0; k < 3; ++k)
        for (const glm::dvec3& edge : e)
            axes.push_back(glm::cross(axes[static_cast<std::size_t>(k)], edge));
    double gap = -1e300;
    for (glm::dvec3 axis : axes) {
        const double l = glm::length(axis);
        if (l < 1e-12) continue;
        axis /= l;
        double lo = 1e300, hi = -1e300;
        for (const glm::dvec3& p : t) {
            const double x = glm::dot(axis, p - center);
            lo = std::min(lo, x);
            hi = std::max(hi, x);
        }
        const double r = half * (std::abs(axis.x) + std::abs(axis.y) + std::abs(axis.z));
        gap = std::max({gap, lo - r, -r - hi});
    }
    return gap;
}

std::array<glm::dvec3, 3> cornersOf(const Scene& s, std::size_t triangle) {
    const glm::uvec3 c = s.triangles[triangle];
    return {glm::dvec3(s.positions[c.x]), glm::dvec3(s.positions[c.y]),
            glm::dvec3(s.positions[c.z])};
}
double areaOf(const std::array<glm::dvec3, 3>& t) {
    return 0.5 * glm::length(glm::cross(t[1] - t[0], t[2] - t[0]));
}

// Structure that every tree has, whatever its scene.
void expectTree(const SceneHierarchy& h, int levels) {
    ASSERT_EQ(h.levels, levels);
    ASSERT_EQ(h.levelBegin.size(), static_cast<std::size_t>(levels) + 1);
    ASSERT_EQ(h.nodes.size(), h.mortonKeys.size());
    ASSERT_EQ(h.nodes.size(), h.areas.size());
    ASSERT_EQ(h.levelBegin.front(), 0u);
    ASSERT_EQ(h.levelBegin.back(), h.nodes.size());
    for (std::uint32_t l = 0; l < static_cast<std::uint32_t>(levels); ++l) {
        std::uint32_t nextChild = h.levelBegin[l + 1];
        for (std::uint32_t i = h.levelBegin[l]; i < h.levelBegin[l + 1]; ++i) {
            const SceneNode& n = h.nodes[i];
            ASSERT_EQ(n.level, l);
            ASSERT_LT(h.mortonKeys[i], 1ull << (3 * l));
            ASSERT_TRUE(i == h.levelBegin[l] || h.mortonKeys[i - 1] < h.mortonKeys[i]);
            ASSERT_TRUE(boxHolds(n, centroidOf(n)));
            ASSERT_TRUE(glm::all(glm::lessThanEqual(
                glm::abs(boxCenter(n) - cellCenter(h.mortonKeys[i], l)) + boxHalf(n),
                glm::vec3(cellHalf(l) + 2e-7f))))
                << "box sticks out of its voxel, node " << i;
            if (l + 1 == static_cast<std::uint32_t>(levels)) {
                ASSERT_EQ(n.children, 0u);
                continue;
            }
            ASSERT_EQ(firstChildOf(n.children), nextChild);
            const std::uint32_t count = childCountOf(n.children);
            ASSERT_GE(count, 1u);
            ASSERT_LE(count, 8u);
            nextChild += count;
            double area = 0;
            glm::dvec3 lo(1e9), hi(-1e9);
            for (std::uint32_t c = nextChild - count; c < nextChild; ++c) {
                ASSERT_EQ(h.mortonKeys[c] >> 3, h.mortonKeys[i]);
                area += h.areas[c];
                lo = glm::min(lo,
                              glm::dvec3(boxCenter(h.nodes[c])) - glm::dvec3(boxHalf(h.nodes[c])));
                hi = glm::max(hi,
                              glm::dvec3(boxCenter(h.nodes[c])) + glm::dvec3(boxHalf(h.nodes[c])));
            }
            // Tight: the union of the children, but for the outward rounding of both.
            ASSERT_LT(glm::length(0.5 * (lo + hi) - glm::dvec3(boxCenter(n))), 1e-6);
            ASSERT_LT(glm::length(0.5 * (hi - lo) - glm::dvec3(boxHalf(n))), 1e-6);
            ASSERT_NEAR(area, h.areas[i], 1e-5 * area + 1e-12);
        }
        ASSERT_TRUE(l + 1 == static_cast<std::uint32_t>(levels) ||
                    nextChild == h.levelBegin[l + 2]);
    }
}

TEST(SceneHierarchy, emptySceneGivesAnEmptyTree) {
    Scene scene;
    scene.materials.emplace_back();
    const SceneHierarchy h = buildTree(scene, 11);
    EXPECT_EQ(h.levels, 0);
    EXPECT_TRUE(h.nodes.empty());
    EXPECT_EQ(h.leafCount(), 0u);
    EXPECT_TRUE(h.nodesUnder(kPublishedRules).empty());
}

TEST(SceneHierarchy, trianglesWithoutAreaAreNotSurface) {
    Scene scene;
    addTriangle(scene, {0.1f, 0.1f, 0.1f}, {0.5f, 0.5f, 0.5f}, {0.9f, 0.9f, 0.9f});
    addTriangle(scene, {0.3f, 0.1f, 0.1f}, {0.3f, 0.1f, 0.1f}, {0.3f, 0.1f, 0.1f});
    EXPECT_EQ(buildTree(scene, 6).levels, 0);
    addTriangle(scene, {0.1f, 0.1f, 0.1f}, {0.11f, 0.1f, 0.1f}, {0.1f, 0.11f, 0.1f});
    EXPECT_EQ(buildTree(scene, 6).leafCount(), 1u);
}

TEST(SceneHierarchy, oneTriangleAtEveryDepth) {
    Scene scene;
    addTriangle(scene, {0.1f, 0.2f, 0.3f}, {0.8f, 0.25f, 0.4f}, {0.3f, 0.9f, 0.7f});
    const double area = areaOf(cornersOf(scene, 0));
    for (int levels = 1; levels <= 11; ++levels) {
        SCOPED_TRACE(levels);
        const SceneHierarchy h = buildTree(scene, levels);
        expectTree(h, levels);
        EXPECT_NEAR(h.areas[0], area, 1e-6);
        const glm::dvec3 mean =
            (cornersOf(scene, 0)[0] + cornersOf(scene, 0)[1] + cornersOf(scene, 0)[2]) / 3.0;
        EXPECT_LT(glm::length(glm::dvec3(centroidOf(h.nodes[0])) - mean), 1e-6);
        for (const SceneNode& n : h.nodes) {
            ASSERT_TRUE(surfaceUsable(n.surface));
            ASSERT_GT(std::abs(dot3(surfaceNormal(n.surface), scene.normals[0])), 0.999999f);
        }
    }
}

// Every voxel of a coarse grid against every triangle. Overlap by more than rounding must be in
// the tree, a gap must not; voxels that are merely touched may be either.
TEST(SceneHierarchy, leavesAreTheVoxelsThatTrianglesOverlap) {
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
        SCOPED_TRACE(seed);
        const Scene scene = randomTriangles(seed == 0 ? 1 : 25, seed);
        const int levels = 5;
        const SceneHierarchy h = buildTree(scene, levels);
        expectTree(h, levels);
        const std::set<std::uint32_t> leaves(h.mortonKeys.begin() + h.levelBegin[4],
                                             h.mortonKeys.end());
        std::size_t touched = 0;
        for (std::uint32_t key = 0; key < 4096; ++key) {
            double gap = 1e300;
            for (std::size_t t = 0; t < scene.triangles.size(); ++t)
                gap = std::min(gap, separation(cornersOf(scene, t), glm::dvec3(cellCenter(key, 4)),
                                               cellHalf(4)));
            if (std::abs(gap) < 1e-9) {
                ++touched;
                continue;
            }
            ASSERT_EQ(leaves.count(key), gap < 0 ? 1u : 0u) << "voxel " << key << " gap " << gap;
        }
        // Faces on grid planes touch two layers of voxels, and only they.
        EXPECT_LT(touched, 1500u);
    }
}

TEST(SceneHierarchy, everySurfacePointIsInTheBoxOfItsLeaf) {
    for (std::uint32_t seed = 10; seed < 14; ++seed) {
        SCOPED_TRACE(seed);
        const Scene scene = randomTriangles(60, seed);
        const SceneHierarchy h = buildTree(scene, 7);
        expectTree(h, 7);
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(0, 1);
        for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
            const auto c = cornersOf(scene, t);
            if (areaOf(c) == 0) continue;
            for (int i = 0; i < 200; ++i) {
                double u = unit(random), v = unit(random);
                if (i < 3) u = i == 1, v = i == 2;  // the corners themselves
                if (u + v > 1) u = 1 - u, v = 1 - v;
                const glm::dvec3 p = c[0] * (1 - u - v) + c[1] * u + c[2] * v;
                // Down the tree through boxes that hold the point: one path must reach a leaf.
                std::vector<std::uint32_t> stack = {0};
                bool found = false;
                while (!stack.empty() && !found) {
                    const SceneNode& n = h.nodes[stack.back()];
                    stack.pop_back();
                    if (!boxHolds(n, p, 1e-12)) continue;
                    found = n.children == 0;
                    for (std::uint32_t k = 0; k < childCountOf(n.children); ++k)
                        stack.push_back(firstChildOf(n.children) + k);
                }
                ASSERT_TRUE(found) << "triangle " << t << " at " << u << ' ' << v;
            }
        }
    }
}

TEST(SceneHierarchy, areasOfEveryLevelAddUpToTheScene) {
    for (std::uint32_t seed = 20; seed < 24; ++seed) {
        const Scene scene = randomTriangles(100, seed);
        double area = 0;
        for (std::size_t t = 0; t < scene.triangles.size(); ++t)
            area += areaOf(cornersOf(scene, t));
        const SceneHierarchy h = buildTree(scene, 6);
        for (std::size_t l = 0; l < 6; ++l) {
            double sum = 0;
            for (std::uint32_t i = h.levelBegin[l]; i < h.levelBegin[l + 1]; ++i) sum += h.areas[i];
            EXPECT_NEAR(sum, area, 1e-5 * area) << "seed " << seed << " level " << l;
        }
    }
}

// A wall in a grid plane belongs to one layer of voxels and keeps a box of no thickness.
TEST(SceneHierarchy, wallsOnGridPlanesAreOneVoxelThickAndFlat) {
    Scene scene;
    addQuad(scene, {0.25f, 0.125f, 0.125f}, {0.25f, 0.875f, 0.125f}, {0.25f, 0.875f, 0.875f},
            {0.25f, 0.125f, 0.875f});
    const SceneHierarchy h = buildTree(scene, 5);
    expectTree(h, 5);
    EXPECT_EQ(h.leafCount(), 12u * 12u);
    for (std::size_t i = 0; i < h.nodes.size(); ++i) {
        EXPECT_EQ(h.nodes[i].centerX, 0.25f);
        EXPECT_EQ(h.nodes[i].halfX, 0.0f);
        EXPECT_EQ(h.nodes[i].centroidX, 0.25f);
        EXPECT_EQ(surfaceNormal(h.nodes[i].surface), glm::vec3(1, 0, 0));
    }
    const SceneNode& leaf = h.nodes[h.levelBegin[4]];
    EXPECT_EQ(mortonDecode(h.mortonKeys[h.levelBegin[4]]).x, 4u);
    EXPECT_EQ(leaf.halfY, 1.0f / 32);
}

// Both sides of a thin wall: normals cancel, the plane does not.
TEST(SceneHierarchy, thinWallKeepsItsPlane) {
    Scene scene;
    const float x0 = 0.3f, x1 = 0.3001f;
    addQuad(scene, {x0, 0.1f, 0.1f}, {x0, 0.9f, 0.1f}, {x0, 0.9f, 0.9f}, {x0, 0.1f, 0.9f});
    addQuad(scene, {x1, 0.1f, 0.9f}, {x1, 0.9f, 0.9f}, {x1, 0.9f, 0.1f}, {x1, 0.1f, 0.1f});
    const SceneHierarchy h = buildTree(scene, 4);
    for (std::size_t i = 0; i < h.nodes.size(); ++i) {
        EXPECT_TRUE(surfaceUsable(h.nodes[i].surface));
        EXPECT_EQ(std::abs(surfaceNormal(h.nodes[i].surface).x), 1.0f);
    }
}

// Leaves say whether their surface is one plane.
TEST(SceneHierarchy, leavesKnowPlanes) {
    const auto planarLeaves = [](const Scene& scene, int levels) {
        const SceneHierarchy h = buildTree(scene, levels);
        std::uint64_t planar = 0;
        for (std::uint32_t i = h.levelBegin[h.levelBegin.size() - 2]; i < h.nodes.size(); ++i)
            planar += surfacePlanar(h.nodes[i].surface);
        return std::pair(planar, h.leafCount());
    };
    Scene tilted;
    addQuad(tilted, {0.1f, 0.2f, 0.3f}, {0.8f, 0.25f, 0.35f}, {0.8f, 0.75f, 0.85f},
            {0.1f, 0.7f, 0.8f});
    const auto flat = planarLeaves(tilted, 6);
    EXPECT_EQ(flat.first, flat.second);
    // Bent by a degree along its diagonal: not where both parts are.
    tilted.positions[2] += glm::vec3(0, 0.02f, 0);
    const auto bent = planarLeaves(tilted, 6);
    EXPECT_LT(bent.first, bent.second);
    EXPECT_GT(bent.first, 0u);
}

// Triangles no wider than the rounding of their corners have no surface to hide anything with.
TEST(SceneHierarchy, trianglesOfRoundingAloneAreLeftOut) {
    const auto leaves = [](float width) {
        Scene scene;
        addTriangle(scene, {0.1f, 0.2f, 0.3f}, {0.9f, 0.8f, 0.6f}, {0.9f, 0.8f + width, 0.6f});
        return buildTree(scene, 5).leafCount();
    };
    EXPECT_EQ(leaves(0), 0u);
    EXPECT_EQ(leaves(1.2e-7f), 0u);
    EXPECT_GT(leaves(1e-6f), 10u);
}

TEST(SceneHierarchy, spreadOutSurfaceFillsItsBox) {
    Scene scene;
    // A sharp fin: two faces at 20 degrees and its flat foot at nearly right angles to both.
    addTriangle(scene, {0.50f, 0.50f, 0.50f}, {0.51f, 0.53f, 0.50f}, {0.50f, 0.50f, 0.53f});
    addTriangle(scene, {0.50f, 0.50f, 0.50f}, {0.53f, 0.50f, 0.50f}, {0.50f, 0.50f, 0.53f});
    const SceneHierarchy h = buildTree(scene, 3);
    ASSERT_EQ(h.leafCount(), 1u);
    EXPECT_FALSE(surfaceUsable(h.nodes.back().surface) &&
                 std::abs(dot3(surfaceNormal(h.nodes.back().surface), scene.normals[0])) < 0.5f);
}

// The right half is cut away by the mask.
Scene maskedQuad() {
    Scene scene;
    addQuad(scene, {0.1f, 0.1f, 0.5f}, {0.9f, 0.1f, 0.5f}, {0.9f, 0.9f, 0.5f}, {0.1f, 0.9f, 0.5f});
    scene.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    Image image;
    image.width = 64;
    image.height = 2;
    for (int i = 0; i < 128; ++i) {
        const bool left = i % 64 < 32;
        for (const int c : {255, 0, 0, left ? 255 : 0})
            image.rgba.push_back(static_cast<std::uint8_t>(c));
    }
    scene.images.push_back(image);
    scene.textures.push_back({.image = 0, .nearest = true});
    scene.materials[0].baseTexture = 0;
    scene.materials[0].alphaCutoff = 0.5f;
    return scene;
}

TEST(SceneHierarchy, surfaceThatTheMaskCutsAwayIsNotVoxelised) {
    const Scene scene = maskedQuad();
    const SceneHierarchy h = buildTree(scene, 7);
    expectTree(h, 7);
    double area = 0;
    for (std::uint32_t i = h.levelBegin[6]; i < h.levelBegin[7]; ++i) {
        EXPECT_LT(h.nodes[i].centerX, 0.52f);
        area += h.areas[i];
    }
    EXPECT_NEAR(area, 0.32, 0.02);
    Scene opaque = scene;
    opaque.materials[0].alphaCutoff = 0;
    EXPECT_NEAR(buildTree(opaque, 7).areas[0], 0.64, 1e-5);
    Scene gone = scene;
    gone.materials[0].baseColor.a = 0.25f;
    EXPECT_EQ(buildTree(gone, 7).levels, 0);
}

TEST(SceneHierarchy, publishedRulesSeeTheVoxelsOfTheSameTree) {
    const Scene scene = randomTriangles(30, 5);
    const SceneHierarchy h = buildTree(scene, 6);
    const SceneNodes voxels = h.nodesUnder(kPublishedRules);
    ASSERT_EQ(voxels.size(), h.nodes.size());
    for (std::size_t i = 0; i < voxels.size(); ++i) {
        EXPECT_EQ(voxels[i].children, h.nodes[i].children);
        EXPECT_EQ(voxels[i].level, h.nodes[i].level);
        EXPECT_EQ(voxels[i].surface, h.nodes[i].surface);
        EXPECT_EQ(boxCenter(voxels[i]), cellCenter(h.mortonKeys[i], h.nodes[i].level));
        EXPECT_EQ(centroidOf(voxels[i]), boxCenter(voxels[i]));
        EXPECT_EQ(voxels[i].halfX, cellHalf(h.nodes[i].level));
        EXPECT_TRUE(boxHolds(voxels[i], centroidOf(h.nodes[i])));
    }
    // One of both alone.
    const SceneNodes boxes = h.nodesUnder(kRuleBoxes);
    const SceneNodes centroids = h.nodesUnder(kRuleCentroid);
    for (std::size_t i = 0; i < voxels.size(); ++i) {
        EXPECT_EQ(boxCenter(boxes[i]), boxCenter(h.nodes[i]));
        EXPECT_EQ(centroidOf(boxes[i]), boxCenter(h.nodes[i]));
        EXPECT_EQ(boxCenter(centroids[i]), boxCenter(voxels[i]));
        EXPECT_EQ(centroidOf(centroids[i]), centroidOf(h.nodes[i]));
    }
}

bool sameBytes(const auto& a, const auto& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

TEST(SceneHierarchy, anyNumberOfThreadsGivesTheSameBytes) {
    const Scene scene = randomTriangles(1500, 77);
    const auto withThreads = [&](std::size_t n) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, n);
        return buildTree(scene, 8);
    };
    const SceneHierarchy one = withThreads(1), two = withThreads(2), more = withThreads(7);
    for (const SceneHierarchy* h : {&two, &more}) {
        EXPECT_TRUE(sameBytes(one.nodes, h->nodes));
        EXPECT_TRUE(sameBytes(one.areas, h->areas));
        EXPECT_TRUE(sameBytes(one.mortonKeys, h->mortonKeys));
        EXPECT_EQ(one.levelBegin, h->levelBegin);
    }
}

TEST(SceneHierarchy, reportsProgressAndCanBeAbandoned) {
    const Scene scene = randomTriangles(2000, 3);
    const TriangleBvh bvh = TriangleBvh::build(scene);
    std::atomic<int> calls{0};
    std::atomic<float> furthest{0};
    SceneHierarchy::build(scene, bvh, 7, [&](std::string_view stage, float fraction) {
        EXPECT_FALSE(stage.empty());
        EXPECT_GE(fraction, 0);
        EXPECT_LE(fraction, 1);
        ++calls;
        if (fraction >= 1) furthest = fraction;
    });
    EXPECT_GE(calls, 5);
    EXPECT_LE(calls, 100);
    EXPECT_EQ(furthest, 1);
    EXPECT_THROW(SceneHierarchy::build(scene, bvh, 7,
                                       [](std::string_view, float fraction) {
                                           if (fraction > 0.3f) throw Cancelled();
                                       }),
                 Cancelled);
}

TEST(Surface, normalsSurvivePacking) {
    std::mt19937 random(1);
    std::normal_distribution<float> gauss(0, 1);
    for (int i = 0; i < 20000; ++i) {
        const glm::vec3 n = glm::normalize(glm::vec3(gauss(random), gauss(random), gauss(random)));
        const std::uint32_t packed = packSurface(n, true);
        ASSERT_TRUE(surfaceUsable(packed));
        ASSERT_LT(angle(n, surfaceNormal(packed)), 2e-4) << n.x << ' ' << n.y << ' ' << n.z;
    }
    for (int k = 0; k < 6; ++k) {
        glm::vec3 n(0);
        n[k / 2] = k % 2 ? -1.0f : 1.0f;
        EXPECT_EQ(surfaceNormal(packSurface(n, true)), n);
    }
    EXPECT_FALSE(surfaceUsable(packSurface({0, 0, 1}, false)));
    EXPECT_FALSE(surfaceUsable(packSurface({0, 0, 0}, true)));
}

}  // namespace
}  // namespace mv
