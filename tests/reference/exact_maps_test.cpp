// Exact maps against distances to the walls of a room, and the reference traversal's maps against
// exact ones.

#include "megaviews/references/exact_maps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/hierarchy/view_hierarchy.h"
#include "megaviews/methods/megaviews/traversal.h"
#include "megaviews/scene/load_scene.h"
#include "reference/reference_scenes.h"

namespace mv {
namespace {

using glm::dvec3;
using testing::Lit;

// Distance from inside a box to its walls.
double boxDepth(dvec3 low, dvec3 high, dvec3 from, dvec3 direction) {
    double depth = 1e300;
    for (int k = 0; k < 3; ++k) {
        const double wall = direction[k] > 0 ? high[k] : low[k];
        if (direction[k] != 0) depth = std::min(depth, (wall - from[k]) / direction[k]);
    }
    return depth;
}

// However many views and texels there are, nobody waits long for them to be given up.
TEST(ExactMaps, AreGivenUpBetweenSmallBlocks) {
    const Lit room(testing::whiteRoom().finish());
    const EmbreeScene embree(room.bvh);
    for (const std::size_t count : {0u, 1u, 700u}) {
        const std::vector<vec3> positions(count, vec3(0.5f));
        std::vector<float> said;
        const ExactMaps maps =
            exactMaps(embree, positions, 32, false,
                      [&](std::string_view, float share) { said.push_back(share); });
        ASSERT_FALSE(said.empty());
        EXPECT_EQ(said.back(), 1);
        for (std::size_t i = 1; i < said.size(); ++i) {
            const float texels = (said[i] - said[i - 1]) * static_cast<float>(maps.depth.size());
            EXPECT_GT(texels, 0);
            EXPECT_LT(texels, 17000);
        }
        std::size_t calls = 0;
        EXPECT_THROW(exactMaps(embree, positions, 32, false,
                               [&](std::string_view, float) {
                                   ++calls;
                                   throw Cancelled();
                               }),
                     Cancelled);
        EXPECT_EQ(calls, 1u);
    }
}

TEST(ExactMaps, MeasureTheWallsOfARoom) {
    const Lit room(testing::whiteRoom().finish());
    const EmbreeScene embree(room.bvh);
    const SceneBounds bounds = sceneBounds(room.scene);
    std::vector<vec3> positions = {{0.5f, 0.5f, 0.5f}, {0.2f, 0.4f, 0.6f}, {0.7f, 0.3f, 0.1f}};
    positions.push_back(bounds.min + 1e-4f);  // in a corner
    for (const int res : {8, 16, 64}) {
        const ExactMaps maps = exactMaps(embree, positions, res, true);
        const auto r = static_cast<uint>(res);
        ASSERT_EQ(maps.depth.size(), positions.size() * mapTexels(r));
        double worst = 0;
        int wider = 0;
        for (std::size_t m = 0; m < positions.size(); ++m) {
            for (uint k = 0; k < mapTexels(r); ++k) {
                const std::size_t at = m * mapTexels(r) + k;
                if (!texelReachable(k, r)) {
                    ASSERT_EQ(maps.depth[at], std::numeric_limits<float>::infinity());
                    continue;
                }
                const auto depthAt = [&](dvec3 d) {
                    return boxDepth(dvec3(bounds.min), dvec3(bounds.max), dvec3(positions[m]),
                                    glm::normalize(d));
                };
                worst = std::max(worst,
                                 std::abs(double{maps.depth[at]} - depthAt(dvec3(texelRay(k, r)))));
                // The range is that of the 25 rays, found here by angles.
                const vec2 c = texelCenter(k, r);
                double nearest = 1e300, farthest = 0;
                for (int j = 0; j < 5; ++j) {
                    for (int i = 0; i < 5; ++i) {
                        const double u = double{c.x} + (i - 2) * 0.4 / res;
                        const double v = double{c.y} + (j - 2) * 0.4 / res;
                        const double angle = 2 * std::atan(std::hypot(u, v));
                        const double around = std::atan2(v, u);
                        const double depth = depthAt(dvec3((k < r * r ? 1 : -1) * std::cos(angle),
                                                           std::sin(angle) * std::cos(around),
                                                           std::sin(angle) * std::sin(around)));
                        nearest = std::min(nearest, depth);
                        farthest = std::max(farthest, depth);
                    }
                }
                ASSERT_NEAR(maps.nearest[at], nearest, 1e-6) << "texel " << k;
                ASSERT_NEAR(maps.farthest[at], farthest, 1e-6) << "texel " << k;
                ASSERT_LE(maps.nearest[at], maps.depth[at]);
                ASSERT_GE(maps.farthest[at], maps.depth[at]);
                wider += maps.farthest[at] > 1.001f * maps.nearest[at];
            }
        }
        EXPECT_LT(worst, 1e-6) << res;
        EXPECT_GT(wider, res * res);
    }
}

// Eight rays at a time meet what single ones meet.
TEST(ExactMaps, EightRaysAreEightSingleOnes) {
    const Lit room(testing::whiteRoom().finish());
    const EmbreeScene embree(room.bvh);
    const vec3 origin(0.3f, 0.4f, 0.6f);
    for (const std::size_t count : {0u, 1u, 8u, 13u}) {
        std::vector<vec3> directions;
        for (std::size_t i = 0; i < count; ++i) {
            const float angle = static_cast<float>(i);
            directions.emplace_back(std::cos(angle) * 0.8f, std::sin(angle) * 0.8f, 0.6f);
        }
        std::vector<float> depths(count);
        embree.closestDepths(origin, directions, depths);
        for (std::size_t i = 0; i < count; ++i) {
            const auto hit = embree.intersect(origin, directions[i], 0, kInfinity);
            ASSERT_TRUE(hit);
            EXPECT_NEAR(depths[i], hit->t, 1e-6f);
        }
    }
}

TEST(ExactMaps, LeaveSkyAndMasksOpen) {
    testing::RoomBuilder half;
    Material screen;
    screen.alphaCutoff = 0.5f;
    screen.baseTexture = half.texture(1, 1, {255, 255, 255, 0});  // transparent everywhere
    const int wall = half.material(vec3(0.5f)), glass = half.material(screen);
    half.quad({0, 0, 0}, {0, 4, 0}, {0, 0, 4}, wall);   // at x = 0
    half.quad({1, 0, 0}, {0, 4, 0}, {0, 0, 4}, glass);  // before it
    const Lit scene(half.finish());
    const EmbreeScene embree(scene.bvh);
    const vec3 view = scene.scene.root.rootFromWorld({2, 2, 2});
    const ExactMaps maps = exactMaps(embree, std::vector<vec3>{view}, 16, false);
    EXPECT_TRUE(maps.nearest.empty() && maps.farthest.empty());
    const double toWall = 2 / scene.scene.root.edge;
    int open = 0, hits = 0;
    for (uint k = 0; k < mapTexels(16); ++k) {
        if (!texelReachable(k, 16)) continue;
        const dvec3 d = glm::normalize(dvec3(texelRay(k, 16)));
        const double t = toWall / -d.x;
        const bool seen = d.x < 0 && std::abs(t * d.y) < toWall && std::abs(t * d.z) < toWall;
        if (seen) {
            EXPECT_NEAR(maps.depth[k], t, 1e-6);
        } else {
            EXPECT_EQ(maps.depth[k], std::numeric_limits<float>::infinity());
        }
        ++(seen ? hits : open);
    }
    EXPECT_GT(hits, 20);
    EXPECT_GT(open, 200);
    // A texel on the wall's outline: its farthest ray leaves the scene.
    const vec3 aside = scene.scene.root.rootFromWorld({2, 1.6, 2.3});
    const ExactMaps ranges = exactMaps(embree, std::vector<vec3>{aside}, 16, true);
    int outline = 0, within = 0;
    for (uint k = 0; k < mapTexels(16); ++k) {
        const bool sky = std::isinf(ranges.farthest[k]), closed = !std::isinf(ranges.nearest[k]);
        EXPECT_TRUE(sky || closed);
        outline += sky && closed;
        within += sky && !std::isinf(ranges.depth[k]);
    }
    EXPECT_GT(within, 10);
    EXPECT_GT(outline, within);
    EXPECT_LT(outline, 100);
}

TEST(ExactMaps, OfNothing) {
    const Lit empty{testing::RoomBuilder().finish()};
    const EmbreeScene embree(empty.bvh);
    EXPECT_TRUE(exactMaps(embree, {}, 16, true).depth.empty());
    for (const float d : exactMaps(embree, std::vector<vec3>{vec3(0.5f)}, 8, true).farthest) {
        EXPECT_EQ(d, std::numeric_limits<float>::infinity());
    }
}

TEST(ExactMaps, DoNotDependOnThreadsAndCanBeCancelled) {
    const Lit lit(testing::furnishedRoom(3, testing::panel));
    std::vector<vec3> positions;
    for (const Receiver& r : testing::receiversInside(1, 40, 0.1f)) positions.push_back(r.position);
    const auto make = [&](std::size_t count) {
        const testing::Threads threads(count);
        const EmbreeScene embree(lit.bvh);
        return exactMaps(embree, positions, 16, true);
    };
    const ExactMaps one = make(1), two = make(2);
    EXPECT_EQ(one.depth, two.depth);
    EXPECT_EQ(one.nearest, two.nearest);
    EXPECT_EQ(one.farthest, two.farthest);
    const EmbreeScene embree(lit.bvh);
    EXPECT_THROW(exactMaps(embree, positions, 16, false,
                           [](std::string_view, float share) {
                               if (share > 0.3f) throw Cancelled();
                           }),
                 Cancelled);
}

// The traversal's maps from the same centres: most texels agree, and finer octrees agree better.
TEST(ExactMaps, AreWhatTheTraversalApproximates) {
    const Lit lit(loadScene("builtin:cornell"));
    const EmbreeScene embree(lit.bvh);
    const ViewSet set = lit.trace(96, 2);
    double previous = 1;
    for (const int levels : {6, 8, 10}) {
        const SceneHierarchy scene = SceneHierarchy::build(lit.scene, lit.bvh, levels);
        const ViewHierarchy views = ViewHierarchy::build(set.views, {.levels = levels});
        const TraversalResult found =
            traverse(scene.nodes, views, {.rules = kCorrectedRules, .maps = {16}});
        const ExactMaps exact = exactMaps(embree, found.leafMaps.centers, 16, false);
        ASSERT_EQ(exact.depth.size(), found.leafMaps.texels.size());
        int counted = 0, off = 0;
        for (std::uint32_t leaf = 0; leaf < views.sortedViews.size(); ++leaf) {
            const View& v = views.sortedViews[leaf];
            const std::uint32_t map = views.mapOfNode[views.leafOfView[leaf]];
            for (uint k = 0; k < mapTexels(16); ++k) {
                const vec3 d = texelDirection(k, 16);
                // What the view lights, a texel away from its own plane.
                if (!texelReachable(k, 16)) continue;
                if (dot3(d, vec3(v.normalX, v.normalY, v.normalZ)) < 0.2f) continue;
                const std::size_t at = std::size_t{map} * mapTexels(16) + k;
                const uint bits = found.leafMaps.texels[at];
                const float depth = bits == kNone ? 1e30f : uintBitsToFloat(bits);
                ++counted;
                off += std::abs(depth - exact.depth[at]) > 0.1f * exact.depth[at];
            }
        }
        const double share = static_cast<double>(off) / counted;
        RecordProperty("off_share_" + std::to_string(levels), std::to_string(share));
        std::printf("levels %d: %.2f %% of %d texels off by more than 10 %%\n", levels, 100 * share,
                    counted);
        EXPECT_GT(counted, 10000);
        EXPECT_LT(share, previous);
        previous = share;
    }
    EXPECT_LT(previous, 0.1);
}

}  // namespace
}  // namespace mv
