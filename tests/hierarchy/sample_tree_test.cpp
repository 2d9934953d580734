// The binary tree over surface samples: even samples, complete trees, bounds that hold all samples
// below in every pose, and nothing else that moves.

#include "megaviews/hierarchy/sample_tree.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <span>

#include "hierarchy/test_scenes.h"
#include "megaviews/hierarchy/moving_surface.h"
#include "megaviews/scene/load_scene.h"
#include "megaviews/scene/rigged_scene.h"
#include "shaders/shared/pair.glsl"

namespace mv {
namespace {

constexpr int kTreeLevels = 7;
constexpr double kTreeTimes[] = {0, 1.3, 4, 7.7, 9, 11.9};

struct Built {
    Scene scene;
    TriangleBvh bvh;
    SceneHierarchy hierarchy;
    explicit Built(Scene from, int levels = kTreeLevels)
        : scene(std::move(from)),
          bvh(TriangleBvh::build(scene)),
          hierarchy(buildSampleTree(scene, bvh, levels)) {}
    void pose(double timeS) {
        poseScene(scene, timeS);
        bvh.refit();
        hierarchy.refit(scene);
    }
};
std::unique_ptr<Built> builtin(const char* name) {
    return std::make_unique<Built>(makeBuiltin(name, {}));
}

template <typename T>
bool sameBytes(std::span<const T> a, std::span<const T> b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

// Calls visit(node, point) for each sample below each node; leaves are in the order of their
// samples, from left to right.
template <typename Visit>
void forSamplesBelow(const SceneHierarchy& h, Visit&& visit) {
    std::uint32_t point = 0;
    std::vector<std::uint32_t> way;
    const auto descend = [&](const auto& self, std::uint32_t node) -> void {
        way.push_back(node);
        const std::uint32_t children = h.nodes[node].children;
        if (children == 0) {
            for (const std::uint32_t above : way) visit(above, h.samples->points[point]);
            ++point;
        }
        for (std::uint32_t k = 0; k < childCountOf(children); ++k)
            self(self, firstChildOf(children) + k);
        way.pop_back();
    };
    descend(descend, 0);
    EXPECT_EQ(point, h.samples->points.size());
}

void expectBounds(const Built& built) {
    const SceneHierarchy& h = built.hierarchy;
    const SceneNodes spheres = h.nodesUnder(kPublishedRules);
    ASSERT_EQ(spheres.size(), h.nodes.size());
    double outsideBox = -1, outsideSphere = -1;
    forSamplesBelow(h, [&](std::uint32_t node, const TreeSample& sample) {
        const glm::dvec3 p = positionOf(built.scene, sample);
        const glm::dvec3 off =
            glm::abs(p - glm::dvec3(boxCenter(h.nodes[node]))) - glm::dvec3(boxHalf(h.nodes[node]));
        outsideBox = std::max({outsideBox, off.x, off.y, off.z});
        const SceneNode& s = spheres[node];
        outsideSphere = std::max(outsideSphere, glm::length(p - glm::dvec3(boxCenter(s))) -
                                                    glm::length(glm::dvec3(boxHalf(s))));
    });
    EXPECT_LE(outsideBox, 1e-7);  // samples are carried in double, boxes kept in float
    EXPECT_LE(outsideSphere, 1e-7);
    // Bounds hold those of children, whose discs reach beyond their samples.
    for (std::size_t i = 0; i < h.nodes.size(); ++i) {
        const std::uint32_t children = h.nodes[i].children;
        for (std::uint32_t k = 0; k < childCountOf(children); ++k) {
            const std::uint32_t c = firstChildOf(children) + k;
            const glm::dvec3 over =
                glm::abs(glm::dvec3(boxCenter(h.nodes[c])) - glm::dvec3(boxCenter(h.nodes[i]))) +
                glm::dvec3(boxHalf(h.nodes[c])) - glm::dvec3(boxHalf(h.nodes[i]));
            ASSERT_LE(std::max({over.x, over.y, over.z}), 2e-7) << i;
            ASSERT_LE(
                glm::length(glm::dvec3(boxCenter(spheres[c])) - glm::dvec3(boxCenter(spheres[i]))) +
                    glm::length(glm::dvec3(boxHalf(spheres[c]))),
                glm::length(glm::dvec3(boxHalf(spheres[i]))) + 1e-6)
                << i;
        }
    }
}

TEST(SampleTree, BoundsHoldAllSamplesBelow) {
    for (const char* name : {"builtin:cornell", "builtin:atrium"}) {
        SCOPED_TRACE(name);
        expectBounds(*builtin(name));
    }
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
        SCOPED_TRACE(seed);
        expectBounds(Built(test::randomTriangles(300, seed)));
    }
}

TEST(SampleTree, BoundsHoldAllSamplesInEveryPose) {
    const auto door = builtin("builtin:door");
    ASSERT_TRUE(door->hierarchy.moving);
    for (const double timeS : kTreeTimes) {
        SCOPED_TRACE(timeS);
        door->pose(timeS);
        expectBounds(*door);
    }
}

// Trees of what stands and what moves are complete, and hang below one root.
TEST(SampleTree, IsComplete) {
    for (const char* name : {"builtin:cornell", "builtin:door"}) {
        SCOPED_TRACE(name);
        const auto built = builtin(name);
        const SceneHierarchy& h = built->hierarchy;
        const std::size_t standing = h.samples->standing;
        const std::size_t moving = h.samples->points.size() - standing;
        EXPECT_TRUE(std::has_single_bit(standing));
        EXPECT_EQ(moving > 0, h.moving != nullptr);
        EXPECT_TRUE(moving == 0 || std::has_single_bit(moving));
        EXPECT_EQ(h.nodes.size(), 2 * (standing + moving) - 1);
        EXPECT_EQ(h.leafCount(), standing + moving);
        ASSERT_EQ(h.levelBegin.size(), static_cast<std::size_t>(h.levels) + 1);
        ASSERT_EQ(h.levelBegin.back(), h.nodes.size());
        ASSERT_EQ(h.areas.size(), h.nodes.size());
        // Every node but the root is a child once, a level below its parent, in order.
        std::uint32_t next = 1;
        for (std::size_t level = 0; level + 1 < h.levelBegin.size(); ++level) {
            for (std::uint32_t i = h.levelBegin[level]; i < h.levelBegin[level + 1]; ++i) {
                ASSERT_EQ(h.nodes[i].level, level);
                const std::uint32_t children = h.nodes[i].children;
                if (children == 0) continue;
                ASSERT_EQ(childCountOf(children), 2u);
                ASSERT_EQ(firstChildOf(children), next);
                next += 2;
            }
            ASSERT_TRUE(next == h.nodes.size() || next == h.levelBegin[level + 2] ||
                        level + 2 >= h.levelBegin.size());
        }
        EXPECT_EQ(next, h.nodes.size());
    }
}

// Samples for the surface of each triangle are as many as its area asks for, but for what strata
// leave over at either end, and together they stand for all of it.
TEST(SampleTree, SamplesAreEven) {
    const Scene scene = test::randomTriangles(60, 9);
    const TriangleBvh bvh = TriangleBvh::build(scene);
    constexpr std::uint32_t kCount = 1 << 14;
    const std::vector<TreeSample> points =
        sampleSurface(scene, bvh, 0, scene.triangles.size(), kCount);
    ASSERT_EQ(points.size(), kCount);
    std::vector<double> areas(scene.triangles.size()), found(scene.triangles.size());
    double all = 0, standsFor = 0;
    for (std::size_t t = 0; t < areas.size(); ++t) {
        const glm::uvec3 c = scene.triangles[t];
        const glm::dvec3 a(scene.positions[c.x]);
        areas[t] = 0.5 * glm::length(glm::cross(glm::dvec3(scene.positions[c.y]) - a,
                                                glm::dvec3(scene.positions[c.z]) - a));
        all += areas[t];
    }
    for (const TreeSample& p : points) {
        EXPECT_GE(p.s, 0);
        EXPECT_GE(p.t, 0);
        EXPECT_LE(p.s + p.t, 1 + 1e-6);
        ++found[p.triangle];
        standsFor += double{p.share} * areas[p.triangle];
    }
    EXPECT_NEAR(standsFor, all, 1e-4 * all);
    for (std::size_t t = 0; t < areas.size(); ++t) {
        EXPECT_NEAR(found[t], areas[t] / all * kCount, 1.01) << t;
    }
    // Within a triangle too: of the sixteenths of the largest, each has its share, less than what
    // random points would be off by.
    const auto largest =
        static_cast<std::uint32_t>(std::max_element(areas.begin(), areas.end()) - areas.begin());
    std::map<std::array<int, 3>, int> cells;
    for (const TreeSample& p : points) {
        if (p.triangle != largest) continue;
        const float u = 1 - p.s - p.t;
        ++cells[{static_cast<int>(4 * p.s), static_cast<int>(4 * p.t), static_cast<int>(4 * u)}];
    }
    ASSERT_EQ(cells.size(), 16u);
    for (const auto& [cell, count] : cells) {
        const double want = found[largest] / 16;
        EXPECT_NEAR(count, want, 0.5 * std::sqrt(want)) << cell[0] << cell[1] << cell[2];
    }
}

// Discs leave few holes, hardly any where triangles are larger than discs: points of the surface
// lie in the box of some leaf.
TEST(SampleTree, LeavesCoverTheSurface) {
    for (const auto& [name, most] : std::map<const char*, int>{
             {"builtin:cornell", 100}, {"builtin:door", 400}, {"builtin:atrium", 700}}) {
        SCOPED_TRACE(name);
        const auto built = builtin(name);
        const SceneHierarchy& h = built->hierarchy;
        const auto reached = [&](const auto& self, std::uint32_t node, glm::dvec3 p) -> bool {
            const SceneNode& n = h.nodes[node];
            const glm::dvec3 off = glm::abs(p - glm::dvec3(boxCenter(n))) - glm::dvec3(boxHalf(n));
            if (std::max({off.x, off.y, off.z}) > 1e-6) return false;
            if (n.children == 0) return true;
            return self(self, firstChildOf(n.children), p) ||
                   self(self, firstChildOf(n.children) + 1, p);
        };
        const std::vector<TreeSample> asked =
            sampleSurface(built->scene, built->bvh, 0, built->scene.triangles.size(), 5003);
        const auto missed = std::count_if(asked.begin(), asked.end(), [&](const TreeSample& p) {
            return !reached(reached, 0, positionOf(built->scene, p));
        });
        EXPECT_LT(missed, most) << "of " << asked.size();
        EXPECT_GT(h.leafEdge(), 0);
    }
}

TEST(SampleTree, MasksGetNoSamples) {
    Scene scene;
    test::addQuad(scene, {0.1f, 0.1f, 0.5f}, {0.9f, 0.1f, 0.5f}, {0.9f, 0.9f, 0.5f},
                  {0.1f, 0.9f, 0.5f});
    scene.materials[0].alphaCutoff = 0.5f;
    // Opaque along one edge, a hole from the middle on.
    scene.colors.resize(scene.positions.size());
    for (std::size_t i = 0; i < scene.colors.size(); ++i) {
        scene.colors[i] = glm::vec4(1, 1, 1, scene.positions[i].x < 0.5f ? 1 : 0);
    }
    const Built built(std::move(scene), 6);
    double area = 0;
    for (const TreeSample& p : built.hierarchy.samples->points) {
        EXPECT_LE(positionOf(built.scene, p).x, 0.5 + 1e-6);
    }
    area = double{built.hierarchy.areas[0]};
    EXPECT_NEAR(area, 0.32, 0.01);
    EXPECT_TRUE(std::has_single_bit(built.hierarchy.samples->points.size()));
}

TEST(SampleTree, NodesKeepTheirPlacesAndWhatStandsItsBytes) {
    const auto door = builtin("builtin:door");
    const SceneHierarchy before = door->hierarchy;
    door->pose(4);
    const SceneHierarchy& after = door->hierarchy;
    EXPECT_EQ(after.levelBegin, before.levelBegin);
    ASSERT_EQ(after.nodes.size(), before.nodes.size());
    std::size_t moved = 0;
    for (std::size_t level = 1; level + 1 < after.levelBegin.size(); ++level) {
        const bool any = level < after.moving->begin.size();
        for (std::uint32_t i = after.levelBegin[level]; i < after.levelBegin[level + 1]; ++i) {
            EXPECT_EQ(after.nodes[i].children, before.nodes[i].children);
            const bool stands = !any || i < after.moving->begin[level];
            const bool same =
                std::memcmp(&after.nodes[i], &before.nodes[i], sizeof(SceneNode)) == 0;
            EXPECT_TRUE(same || !stands) << "level " << level << " node " << i;
            moved += !same;
        }
    }
    EXPECT_GT(moved, 50u);
}

TEST(SampleTree, DependsOnThePoseAloneAndOnNoThreads) {
    const auto wandering = builtin("builtin:door");
    for (const double timeS : kTreeTimes) wandering->pose(timeS);
    wandering->pose(2.5);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const auto fresh = builtin("builtin:door");
    fresh->pose(2.5);
    EXPECT_TRUE(sameBytes<SceneNode>(wandering->hierarchy.nodes, fresh->hierarchy.nodes));
    EXPECT_TRUE(sameBytes<float>(wandering->hierarchy.areas, fresh->hierarchy.areas));
}

TEST(SampleTree, EveryLevelHasFourTimesTheSamples) {
    const Scene scene = makeBuiltin("builtin:cornell", {});
    const TriangleBvh bvh = TriangleBvh::build(scene);
    std::size_t before = 0;
    for (int levels = 1; levels <= 8; ++levels) {
        const SceneHierarchy h = buildSampleTree(scene, bvh, levels);
        const std::size_t samples = h.samples->points.size();
        if (before > 4) {
            EXPECT_EQ(samples, 4 * before);
        }
        before = samples;
        // About as many as the octree has leaves.
        if (levels < 5) continue;
        const auto leaves =
            static_cast<double>(SceneHierarchy::build(scene, bvh, levels).leafCount());
        EXPECT_LT(std::abs(std::log2(static_cast<double>(samples) / leaves)), 1.0);
    }
}

TEST(SampleTree, AwkwardScenes) {
    const Built empty{Scene{}};
    EXPECT_EQ(empty.hierarchy.levels, 0);
    EXPECT_TRUE(empty.hierarchy.nodes.empty());
    EXPECT_TRUE(empty.hierarchy.nodesUnder(kPublishedRules).empty());
    Scene sliver;
    test::addTriangle(sliver, {0.5f, 0.5f, 0.5f}, {0.6f, 0.5f, 0.5f}, {0.7f, 0.5f, 0.5f});
    EXPECT_TRUE(Built(std::move(sliver)).hierarchy.nodes.empty());
    Scene speck;
    test::addTriangle(speck, {0.5f, 0.5f, 0.5f}, {0.501f, 0.5f, 0.5f}, {0.5f, 0.501f, 0.5f});
    const Built one(std::move(speck), 3);
    EXPECT_EQ(one.hierarchy.levels, 1);
    EXPECT_EQ(one.hierarchy.nodes.size(), 1u);
    expectBounds(one);
}

}  // namespace
}  // namespace mv
