// The part of the octree that an animation moves, refitted for one pose after another: it holds the
// surface wherever that goes, keeps its nodes, and leaves alone what stands.

#include "megaviews/hierarchy/moving_surface.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/scene/load_scene.h"
#include "megaviews/scene/rigged_scene.h"

namespace mv {
namespace {

constexpr int kLevels = 7;
constexpr double kTimes[] = {0, 1.3, 4, 7.7, 9, 11.9};

// Shut, opening and open doors, a swinging lamp, turning boards; 5 objects move.
struct Door {
    Scene scene = makeBuiltin("builtin:door", {});
    TriangleBvh bvh = TriangleBvh::build(scene);
    SceneHierarchy hierarchy = SceneHierarchy::build(scene, bvh, kLevels);
    Door() { hierarchy.joinMoving(scene, bvh, kLevels); }
    void pose(double timeS) {
        poseScene(scene, timeS);
        bvh.refit();
        hierarchy.refit(scene);
    }
};

bool sameNode(const SceneNode& a, const SceneNode& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

bool holds(const SceneNode& n, glm::dvec3 p) {
    constexpr double kRounding = 1e-6;
    const glm::dvec3 d = glm::abs(p - glm::dvec3(n.centerX, n.centerY, n.centerZ)) -
                         glm::dvec3(n.halfX, n.halfY, n.halfZ);
    return std::max({d.x, d.y, d.z}) <= kRounding;
}

// Whether a chain of boxes from the root down to a leaf holds the point.
bool reached(const SceneHierarchy& h, std::uint32_t node, glm::dvec3 p) {
    const SceneNode& n = h.nodes[node];
    if (!holds(n, p)) return false;
    if (n.children == 0) return true;
    for (std::uint32_t k = 0; k < childCountOf(n.children); ++k) {
        if (reached(h, firstChildOf(n.children) + k, p)) return true;
    }
    return false;
}

TEST(MovingSurface, EveryPoseLiesInsideItsBoxes) {
    Door door;
    ASSERT_TRUE(door.hierarchy.moving);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const double timeS : kTimes) {
        SCOPED_TRACE(timeS);
        door.pose(timeS);
        std::size_t lost = 0;
        double area = 0;
        for (std::size_t t = 0; t < door.scene.triangles.size(); ++t) {
            const glm::uvec3 c = door.scene.triangles[t];
            const glm::dvec3 a(door.scene.positions[c.x]);
            const glm::dvec3 b(door.scene.positions[c.y]), d(door.scene.positions[c.z]);
            area += 0.5 * glm::length(glm::cross(b - a, d - a));
            if (t < door.scene.moving->triangle && t % 16 != 0) continue;
            for (int i = 0; i < 8; ++i) {
                double u = unit(random), v = unit(random);
                if (u + v > 1) u = 1 - u, v = 1 - v;
                lost += !reached(door.hierarchy, 0, a + u * (b - a) + v * (d - a));
            }
        }
        EXPECT_EQ(lost, 0u);
        // All of the surface, once.
        double sum = 0;
        for (std::size_t i = door.hierarchy.levelBegin[kLevels - 1];
             i < door.hierarchy.nodes.size(); ++i) {
            sum += double{door.hierarchy.areas[i]};
        }
        EXPECT_NEAR(sum, area, 1e-4 * area);
    }
}

TEST(MovingSurface, NodesKeepTheirPlacesAndWhatStandsItsBytes) {
    Door door;
    const SceneHierarchy before = door.hierarchy;
    door.pose(4);
    const SceneHierarchy& after = door.hierarchy;
    ASSERT_EQ(after.nodes.size(), before.nodes.size());
    EXPECT_EQ(after.levelBegin, before.levelBegin);
    EXPECT_EQ(after.mortonKeys, before.mortonKeys);
    std::size_t moved = 0;
    for (int level = 1; level < kLevels; ++level) {
        const auto l = static_cast<std::size_t>(level);
        for (std::uint32_t i = after.levelBegin[l]; i < after.levelBegin[l + 1]; ++i) {
            EXPECT_EQ(after.nodes[i].children, before.nodes[i].children);
            const bool stands = i < after.moving->begin[l];
            const bool same = sameNode(after.nodes[i], before.nodes[i]);
            EXPECT_TRUE(same || !stands) << "level " << level << " node " << i;
            moved += !stands && !same;
        }
    }
    EXPECT_GT(moved, 100u);
}

TEST(MovingSurface, DependsOnThePoseAlone) {
    Door wandering, fresh;
    for (const double timeS : kTimes) wandering.pose(timeS);
    wandering.pose(2.5);
    fresh.pose(2.5);
    ASSERT_EQ(wandering.hierarchy.nodes.size(), fresh.hierarchy.nodes.size());
    EXPECT_EQ(std::memcmp(wandering.hierarchy.nodes.data(), fresh.hierarchy.nodes.data(),
                          fresh.hierarchy.nodes.size() * sizeof(SceneNode)),
              0);
    EXPECT_EQ(std::memcmp(wandering.bvh.nodes.data(), fresh.bvh.nodes.data(),
                          fresh.bvh.nodes.size() * sizeof(BvhNode)),
              0);
}

TEST(MovingSurface, ASceneThatStandsHasNone) {
    const Scene scene = makeBuiltin("builtin:cornell", {});
    const TriangleBvh bvh = TriangleBvh::build(scene);
    SceneHierarchy hierarchy = SceneHierarchy::build(scene, bvh, 5);
    const SceneNodes before = hierarchy.nodes;
    hierarchy.joinMoving(scene, bvh, 5);
    hierarchy.refit(scene);
    EXPECT_FALSE(hierarchy.moving);
    EXPECT_FALSE(bvh.moving);
    ASSERT_EQ(hierarchy.nodes.size(), before.size());
    EXPECT_EQ(std::memcmp(hierarchy.nodes.data(), before.data(), before.size() * sizeof(SceneNode)),
              0);
}

}  // namespace
}  // namespace mv
