// Texels and directions, where they lie, splatting, fusion and queries: shaders/shared/{paraboloid,
// map_store,splat,fuse}.glsl and megaviews/maps, against brute force.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "megaviews/maps/view_maps.h"
#include "shaders/shared/fuse.glsl"
#include "shaders/shared/map_store.glsl"
#include "shaders/shared/splat.glsl"
#include "support/map_queries.h"
#include "support/synthetic.h"

namespace mv {
namespace {

using glm::dvec3;
using testing::randomDirection;
using testing::randomIn;
using testing::rayBox;

constexpr uint kResolutions[] = {8, 16, 32, 64, 128, 256};

dvec3 rayOf(uint texel, uint res) { return glm::normalize(dvec3(texelRay(texel, res))); }

// ------------------------------------------------------------------ texels

TEST(ParaboloidTest, TexelsHoldTheirOwnCentres) {
    for (const uint res : kResolutions) {
        for (uint texel = 0; texel < mapTexels(res); ++texel) {
            const vec3 d = texelDirection(texel, res);
            ASSERT_NEAR(length3(d), 1.0f, 1e-6f);
            ASSERT_FLOAT_EQ(texelRayLength(texel, res), length3(texelRay(texel, res)));
            const vec2 c = texelCenter(texel, res);
            const bool inDisc = c.x * c.x + c.y * c.y < 1.0f;
            // A centre outside the disc is a direction of the other face.
            if (inDisc) {
                ASSERT_EQ(texelOfDirection(d, res), texel) << "R " << res;
            } else {
                ASSERT_NE(texelOfDirection(d, res) < res * res, texel < res * res) << "R " << res;
            }
        }
    }
}

TEST(ParaboloidTest, EveryDirectionFallsIntoAReachableTexelOfItsFootprint) {
    std::mt19937 random(1);
    for (const uint res : kResolutions) {
        int outside = 0;
        for (int i = 0; i < 40000; ++i) {
            vec3 d = randomDirection(random);
            if (i % 8 == 0) d.x *= 1e-3f;  // around the seam
            if (i % 997 == 0) d = vec3(0, d.y, d.z);
            const uint texel = texelOfDirection(d * randomIn(random, 0.001f, 1.7f), res);
            ASSERT_LT(texel, mapTexels(res));
            ASSERT_EQ(texel >= res * res, d.x < 0);
            ASSERT_TRUE(texelReachable(texel, res));
            const vec2 c = texelCenter(texel, res);
            outside += c.x * c.x + c.y * c.y > 1;
            // Half a texel's diagonal away at most; a texel spans 4 / (R (1 + rho^2)) radians.
            const double l = glm::length(dvec3(d));
            const double angle =
                std::acos(std::min(1.0, glm::dot(dvec3(d) / l, rayOf(texel, res))));
            ASSERT_LE(angle, 4.0 / res * 0.7072) << "R " << res;
        }
        EXPECT_GT(outside, 0) << "rim texels are reachable, R " << res;
    }
}

TEST(ParaboloidTest, KnownDirections) {
    const uint res = 16;
    EXPECT_EQ(texelOfDirection(vec3(1, 0, 0), res), (0u * res + 8) * res + 8);
    EXPECT_EQ(texelOfDirection(vec3(-2, 0, 0), res), (1u * res + 8) * res + 8);
    EXPECT_EQ(texelOfDirection(vec3(0, 1, 0), res), 8u * res + 15);  // u = 1: last column
    EXPECT_EQ(texelOfDirection(vec3(0, -1, 0), res), 8u * res + 0);  // u = -1
    EXPECT_EQ(texelOfDirection(vec3(0, 0, 1), res), 15u * res + 8);  // v = 1: last row
    EXPECT_EQ(texelOfDirection(vec3(0, 0, 0), res), 8u * res + 8);   // no direction: +x
    const float s = std::sqrt(0.5f);
    EXPECT_EQ(texelOfDirection(vec3(s, s, 0), res), 8u * res + uint((s / (1 + s) + 1) * 8));
}

TEST(ParaboloidTest, CornersAreUnreachable) {
    for (const uint res : kResolutions) {
        uint unreachable = 0;
        for (uint t = 0; t < mapTexels(res); ++t) unreachable += !texelReachable(t, res);
        // 1 - pi/4 of the area, less the rim.
        EXPECT_LT(unreachable, mapTexels(res) * 22 / 100);
        EXPECT_GT(unreachable, mapTexels(res) * 5 / 100);
        EXPECT_FALSE(texelReachable(0, res));
    }
}

TEST(MapStoreTest, EveryTexelHasAWordOfItsOwn) {
    const MapStore store{8};
    std::vector<uint> words(mapWords(store, 3), kNone);
    std::set<std::size_t> mipsUsed;
    for (uint map = 0; map < 3; ++map) {
        for (uint t = 0; t < mapTexels(8); ++t) {
            ASSERT_EQ(loadMapTexel(store, words, map, t), kNone);
            storeMapTexel(store, words, map, t, map * 1000 + t);
        }
        for (uint t = 0; t < mipTexels(8); ++t) mipsUsed.insert(mipWordOf(store, map, t));
    }
    lowerMapTexel(store, words, 1, 5, 7);
    lowerMapTexel(store, words, 1, 6, 7000);
    EXPECT_EQ(loadMapTexel(store, words, 1, 5), 7u);
    EXPECT_EQ(loadMapTexel(store, words, 1, 6), 1006u);
    EXPECT_EQ(mipsUsed.size(), mipWords(store, 3));
    EXPECT_EQ(*mipsUsed.rbegin() + 1, mipWords(store, 3));
}

TEST(MapStoreTest, PackedDepthsAreNear) {
    const MapStore store{8};
    EXPECT_EQ(packedWords(store, 3), mapWords(store, 3) / 2);
    std::vector<uint> words(packedWords(store, 3), 0);
    for (uint map = 0; map < 3; ++map) {
        for (uint t = 0; t < mapTexels(8); ++t) ++words.at(packedWordOf(store, map, t));
    }
    EXPECT_EQ(words, std::vector<uint>(words.size(), 2));

    EXPECT_EQ(packTexel(kNone), kPackedNone);
    EXPECT_EQ(unpackTexel(0x1234FFFFu, 6), kNone);
    EXPECT_EQ(unpackTexel(0xFFFF1234u, 7), kNone);
    uint last = 0;
    for (float depth = 1e-9f; depth < 3.999f; depth *= 1.0001f) {
        const uint steps = packTexel(floatBitsToUint(depth));
        const float got = uintBitsToFloat(unpackTexel(steps | 0x43210000u, 4));
        ASSERT_NEAR(got, depth, depth * 0x1p-12f) << depth;
        ASSERT_EQ(unpackTexel(steps << 16, 5), floatBitsToUint(got));
        ASSERT_GE(steps, last);  // nearer stays nearer
        ASSERT_LT(steps, kPackedNone);
        last = steps;
    }
    // Beyond what a root cube holds, and below what its leaves are.
    EXPECT_EQ(packTexel(floatBitsToUint(1e30f)), kPackedNone - 1);
    EXPECT_EQ(uintBitsToFloat(unpackTexel(packTexel(0), 0)), 0x1p-30f);
}

TEST(ParaboloidTest, CoarserLevelsAreLaidOutWithoutGaps) {
    for (const uint res : kResolutions) {
        uint next = 0;
        for (uint level = 1; (res >> level) > 0; ++level) {
            ASSERT_EQ(mipOffset(level, res), next);
            std::set<uint> used;
            for (uint t = 0; t < mapTexels(res); ++t) used.insert(mipTexelOf(t, level, res));
            ASSERT_EQ(used.size(), mapTexels(res >> level));
            ASSERT_EQ(*used.begin(), next);
            next += mapTexels(res >> level);
            ASSERT_EQ(*used.rbegin() + 1, next);
        }
        ASSERT_EQ(mipTexels(res), next);
    }
    EXPECT_EQ(mipTexelOf(texelOfDirection(vec3(-1, 0.3f, -0.4f), 32), 2, 32),
              mipOffset(2, 32) + texelOfDirection(vec3(-1, 0.3f, -0.4f), 8));
}

// ------------------------------------------------------------------ splats

struct MapOfOne {
    std::vector<uint> texels, mips;
    explicit MapOfOne(uint res) : texels(mapTexels(res), kNone), mips(mipTexels(res), kNone) {}
    SplatTarget target() { return {texels.data(), mips.data()}; }
};

struct SplatCase {
    SceneNode node{};
    vec3 view{0.5f, 0.4f, 0.6f};
    std::string text;
};
SplatCase randomSplat(std::mt19937& random, float smallest, float largest) {
    SplatCase c;
    const float l = std::pow(10.0f, randomIn(random, -3, 0));
    vec3 d = randomDirection(random);
    const auto kind = random() % 8;
    if (kind == 0) d = glm::normalize(vec3(d.x * 0.01f, d.y, d.z));  // at the seam
    if (kind == 1) d = vec3(d.x < 0 ? -1 : 1, 0, 0);                 // at a pole
    const float rs =
        l * std::pow(10.0f, randomIn(random, std::log10(smallest), std::log10(largest)));
    vec3 h(randomIn(random, 0, 1), randomIn(random, 0, 1), randomIn(random, 0, 1));
    if (random() % 4 == 0) h[static_cast<int>(random() % 3)] = 0;
    h *= rs / std::max(length3(h), 1e-6f);
    const vec3 center = c.view + d * l;
    c.node.centerX = center.x, c.node.centerY = center.y, c.node.centerZ = center.z;
    c.node.halfX = h.x, c.node.halfY = h.y, c.node.halfZ = h.z;
    const vec3 g = center + h * vec3(randomIn(random, -1, 1), randomIn(random, -1, 1),
                                     randomIn(random, -1, 1));
    c.node.centroidX = g.x, c.node.centroidY = g.y, c.node.centroidZ = g.z;
    c.node.surface = packSurface(randomDirection(random), random() % 4 != 0);
    char text[300];
    std::snprintf(text, sizeof text, "kind %d l %.9g d (%.9g %.9g %.9g) half (%.9g %.9g %.9g)",
                  static_cast<int>(kind), double(l), double(d.x), double(d.y), double(d.z),
                  double(h.x), double(h.y), double(h.z));
    c.text = text;
    return c;
}

TEST(SplatTest, ASurfaceThatIsNoPlaneCoversExactlyItsBox) {
    std::mt19937 random(2);
    std::uint64_t written = 0, seam = 0;
    for (int i = 0; i < 3000; ++i) {
        const uint res = kResolutions[random() % 3];
        SplatCase c = randomSplat(random, 0.002f, 0.98f);
        c.node.surface = 0;
        MapOfOne map(res);
        splatPair(c.node, c.view, kCorrectedRules, false, true, res, map.target());
        const dvec3 offset = dvec3(boxCenter(c.node)) - dvec3(c.view);
        const dvec3 h(boxHalf(c.node));
        const double grain = 1e-5 * glm::length(offset);
        const float depth = length3(minus3(centroidOf(c.node), c.view));
        bool faces[2] = {false, false};
        for (uint t = 0; t < mapTexels(res); ++t) {
            const bool hit = map.texels[t] != kNone;
            if (hit) {
                ASSERT_GE(rayBox(rayOf(t, res), offset, h + grain), 0) << c.text << " texel " << t;
                ASSERT_EQ(map.texels[t], floatBitsToUint(depth));
                faces[t / (res * res)] = true;
                ++written;
            } else if (glm::all(glm::greaterThan(h, dvec3(2 * grain)))) {
                ASSERT_LT(rayBox(rayOf(t, res), offset, h - grain), 0)
                    << c.text << " texel " << t << " R " << res;
            }
        }
        seam += faces[0] && faces[1];
    }
    EXPECT_GT(written, 10000u);
    EXPECT_GT(seam, 100u);  // balls at the seam touch both faces
}

class ElementTest : public ::testing::TestWithParam<bool> {};  // forced: a leaf pair
INSTANTIATE_TEST_SUITE_P(Pairs, ElementTest, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "forced" : "rendered"; });

TEST_P(ElementTest, IsMetWhereThePlaneIsInTheBox) {
    const bool forced = GetParam();
    const float margin = forced ? kLeafMargin : kNodeMargin;
    std::mt19937 random(3);
    std::uint64_t planes = 0, boxes = 0, planeMissed = 0;
    for (int i = 0; i < 3000; ++i) {
        const uint res = kResolutions[random() % 3];
        const SplatCase c = randomSplat(random, 0.02f, 0.98f);
        MapOfOne map(res);
        splatPair(c.node, c.view, kCorrectedRules, forced, true, res, map.target());
        const dvec3 offset = dvec3(boxCenter(c.node)) - dvec3(c.view);
        const dvec3 h(boxHalf(c.node)), g = dvec3(centroidOf(c.node)) - dvec3(c.view);
        const double l = glm::length(offset), radius = glm::length(h), grain = 1e-4 * l;
        const bool usable = surfaceUsable(c.node.surface);
        const dvec3 n(surfaceNormal(c.node.surface));
        for (uint t = 0; t < mapTexels(res); ++t) {
            const dvec3 ray = rayOf(t, res);
            const bool hit = map.texels[t] != kNone;
            const double got = hit ? static_cast<double>(uintBitsToFloat(map.texels[t])) : -1;
            if (hit && (!usable || !forced)) {
                ASSERT_GE(rayBox(ray, offset, h + grain), 0) << c.text;
            }
            if (!usable) {
                const double want = forced ? rayBox(ray, offset, h) : glm::length(g);
                if (hit && want >= 0) {
                    ASSERT_NEAR(got, want, 1e-3 * l) << c.text;
                    ++boxes;
                }
                continue;
            }
            const double slope = glm::dot(n, ray);
            if (std::abs(slope) < 1e-3) continue;  // nearly edge on: rounding decides
            const double want = glm::dot(n, g) / slope;
            const dvec3 outside = glm::abs(ray * want - offset) - h;
            const double beyond = std::max({outside.x, outside.y, outside.z});
            if (hit) {
                ASSERT_GT(want, 0) << c.text;
                ASSERT_NEAR(got, want, 1e-4 * l / std::abs(slope)) << c.text;
                ASSERT_LE(beyond, double(margin) * radius + grain / std::abs(slope)) << c.text;
                ++planes;
            } else {
                // Within the margin it may be left out: the ball bounds what is looked at.
                ASSERT_TRUE(want <= grain || beyond > -grain / std::abs(slope))
                    << c.text << " texel " << t << " R " << res;
                planeMissed += rayBox(ray, offset, h) >= 0;
            }
        }
    }
    EXPECT_GT(planes, 5000u);
    EXPECT_GT(boxes, 2000u);
    EXPECT_GT(planeMissed, 1000u);  // texels that the box would cover
}

TEST(SplatTest, NeighbouringElementsOfAWallLeaveNoHoles) {
    // A tiled plane in front of the view, none of its tiles parallel to an axis.
    const uint res = 32;
    const vec3 n = glm::normalize(vec3(1, 0.4f, -0.3f)), view(0.2f, 0.5f, 0.5f);
    std::vector<testing::Patch> patches;
    const vec3 a = glm::normalize(cross3(n, vec3(0, 0, 1))), b = cross3(n, a);
    for (int j = -60; j < 60; ++j) {
        for (int i = -60; i < 60; ++i) {
            const float s = 0.004f;
            const vec3 at = vec3(0.5f) + a * (s * (float(i) + 0.5f)) + b * (s * (float(j) + 0.5f));
            patches.push_back({at, a * (s / 2), b * (s / 2)});
        }
    }
    const auto scene = testing::makeScene(patches, 6);
    MapOfOne map(res);
    for (const std::uint32_t leaf : scene.leaves())
        splatPair(scene.nodes[leaf], view, kCorrectedRules, true, true, res, map.target());
    int covered = 0, holes = 0;
    for (uint t = 0; t < mapTexels(res); ++t) {
        const dvec3 ray = rayOf(t, res);
        const double slope = glm::dot(dvec3(n), ray);
        const double z = glm::dot(dvec3(n), dvec3(0.5) - dvec3(view)) / slope;
        const dvec3 p = ray * z + dvec3(view) - dvec3(0.5);
        const double u = glm::dot(p, dvec3(a)), v = glm::dot(p, dvec3(b));
        if (z < 0 || std::max(std::abs(u), std::abs(v)) > 0.22) continue;
        ++covered;
        if (map.texels[t] == kNone) {
            ++holes;
        } else {
            ASSERT_NEAR(static_cast<double>(uintBitsToFloat(map.texels[t])), z, 0.02 * z);
        }
    }
    EXPECT_GT(covered, 50);
    EXPECT_EQ(holes, 0) << "of " << covered;
}

TEST(SplatTest, PublishedWritesTheVoxelsCentreAlone) {
    std::mt19937 random(4);
    for (int i = 0; i < 2000; ++i) {
        SplatCase c = randomSplat(random, 0.01f, 0.9f);
        c.node.centroidX = c.node.centerX;
        c.node.centroidY = c.node.centerY;
        c.node.centroidZ = c.node.centerZ;
        const vec3 offset = minus3(boxCenter(c.node), c.view);
        for (const bool forced : {false, true}) {
            MapOfOne map(16);  // at 16 texels the paper fills nothing
            splatPair(c.node, c.view, kPublishedRules, forced, true, 16, map.target());
            std::size_t count = 0;
            for (const uint t : map.texels) count += t != kNone;
            for (const uint t : map.mips) count += t != kNone;
            ASSERT_EQ(count, 1u);
            ASSERT_EQ(map.texels[texelOfDirection(offset, 16)], floatBitsToUint(length3(offset)));
        }
    }
}

TEST(SplatTest, PublishedFillsTheLevelWhereTheNodeIsATexel) {
    std::mt19937 random(5);
    const uint res = 64;
    for (int i = 0; i < 3000; ++i) {
        const SplatCase c = randomSplat(random, 0.005f, 0.95f);
        const vec3 offset = minus3(boxCenter(c.node), c.view);
        const float rs = length3(boxHalf(c.node)), l = length3(offset);
        if (l <= rs) continue;
        const double d = static_cast<double>(
            diameterTexels(static_cast<float>(res), rs, l, sizeDivisorExact(offset, rs)));
        MapOfOne map(res);
        splatPair(c.node, c.view, kPublishedRules, true, true, res, map.target());
        int level = -1;
        for (const uint t : map.texels) level = t != kNone ? 0 : level;
        for (uint k = 1; (res >> k) > 0; ++k)
            for (uint t = mipOffset(k, res); t < mipOffset(k, res) + mapTexels(res >> k); ++t)
                if (map.mips[t] != kNone) level = static_cast<int>(k);
        ASSERT_GE(level, 0);
        const double size = d / std::pow(2.0, level);
        if (level < 6) {
            ASSERT_LE(size, 1 + 1e-5) << c.text;
        }
        if (level > 0) {
            ASSERT_GT(size, 0.5 - 1e-5) << c.text;
        }
    }
}

TEST(SplatTest, UnfilledLeafPairsArePoints) {
    std::mt19937 random(6);
    for (int i = 0; i < 500; ++i) {
        const SplatCase c = randomSplat(random, 0.1f, 0.9f);
        MapOfOne map(32);
        splatPair(c.node, c.view, kCorrectedRules, true, false, 32, map.target());
        const vec3 at = minus3(centroidOf(c.node), c.view);
        for (uint t = 0; t < mapTexels(32); ++t)
            ASSERT_EQ(map.texels[t],
                      t == texelOfDirection(at, 32) ? floatBitsToUint(length3(at)) : kNone);
    }
}

// ------------------------------------------------------------------ fusion and queries

TEST(FuseTest, RecentersTheSamePointToADisplacedCentre) {
    std::mt19937 random(7);
    for (int i = 0; i < 20000; ++i) {
        const uint res = kResolutions[random() % 6];
        const uint texel = static_cast<uint>(random() % mapTexels(res));
        const float z = randomIn(random, 0, 1.7f);
        const vec3 parent(randomIn(random, 0, 1), randomIn(random, 0, 1), randomIn(random, 0, 1));
        const vec3 child = parent + randomDirection(random) * randomIn(random, 0, 0.2f);
        const uint bits = recenterDepth(floatBitsToUint(z), texel, res, minus3(parent, child));
        const dvec3 point = dvec3(parent) + rayOf(texel, res) * static_cast<double>(z);
        ASSERT_NEAR(static_cast<double>(uintBitsToFloat(bits)), glm::length(point - dvec3(child)),
                    1e-6);
    }
    EXPECT_EQ(recenterDepth(kNone, 3, 16, vec3(0.1f)), kNone);
    const uint same = floatBitsToUint(0.5f);
    EXPECT_NEAR(uintBitsToFloat(recenterDepth(same, 100, 16, vec3(0))), 0.5f, 1e-6f);
}

// Three nodes in a line: root -> inner -> leaf, one view.
ViewHierarchy chain() {
    ViewHierarchy h = ViewHierarchy::build({testing::makeView(vec3(0.5f), vec3(1, 0, 0), 0)},
                                           {3, kPublishedRules});
    return h;
}

TEST(FuseTest, TakesTheNearerAndQueriesTheLastNotEmpty) {
    const ViewHierarchy views = chain();
    ASSERT_EQ(views.nodes.size(), 3u);
    const uint res = 8, size = mapTexels(res);
    std::vector<uint> texels(3 * size, kNone);
    const uint a = texelOfDirection(vec3(1, 0.1f, 0.1f), res);
    const uint b = texelOfDirection(vec3(-1, 0.1f, 0.1f), res);
    const uint c = texelOfDirection(vec3(1, 0.6f, -0.5f), res);
    texels[0 * size + a] = floatBitsToUint(0.3f);
    texels[2 * size + a] = floatBitsToUint(0.9f);  // farther, yet the last not empty
    texels[0 * size + b] = floatBitsToUint(0.3f);
    texels[1 * size + c] = floatBitsToUint(0.2f);
    const ViewMaps fused = fuseMaps(texels, views, int(res));
    ASSERT_EQ(fused.centers.size(), 1u);

    const auto moved = [&](double z, uint texel, uint from, uint to) {
        return glm::length(dvec3(boxCenter(views.nodes[from])) + rayOf(texel, res) * z -
                           dvec3(boxCenter(views.nodes[to])));
    };
    const auto fusedAt = [&](uint texel) {
        return queryFused(fused, 0, texelDirection(texel, res));
    };
    const auto unfusedAt = [&](uint texel, bool recentered) {
        return queryUnfused(texels, views, int(res), 0, texelDirection(texel, res), recentered);
    };
    // From level to level when fused, at once when queried unfused.
    EXPECT_NEAR(fusedAt(a), std::min(0.9, moved(moved(0.3, a, 0, 1), a, 1, 2)), 1e-5);
    EXPECT_NEAR(fusedAt(b), moved(moved(0.3, b, 0, 1), b, 1, 2), 1e-5);
    EXPECT_NEAR(fusedAt(c), moved(0.2, c, 1, 2), 1e-5);
    EXPECT_EQ(unfusedAt(a, true), 0.9f);
    EXPECT_NEAR(unfusedAt(b, true), moved(0.3, b, 0, 2), 1e-5);
    EXPECT_EQ(unfusedAt(b, false), 0.3f);
    EXPECT_NEAR(unfusedAt(c, true), moved(0.2, c, 1, 2), 1e-5);
    const uint nothing = texelOfDirection(vec3(0, 0, 1), res);
    EXPECT_TRUE(std::isinf(unfusedAt(nothing, true)));
    EXPECT_TRUE(std::isinf(queryFused(fused, 0, vec3(0, 0, 1))));
}

TEST(FuseTest, PushFillsOnlyEmptyTexelsWithTheFinestLevel) {
    ViewMaps maps;
    maps.mapRes = 32;
    maps.centers = {vec3(0), vec3(0)};
    maps.texels.assign(2 * mapTexels(32), kNone);
    std::vector<uint> mips(2 * mipTexels(32), kNone);
    const uint texel = texelOfDirection(vec3(1, 0.2f, 0.3f), 32);
    uint* second = mips.data() + mipTexels(32);
    second[mipTexelOf(texel, 3, 32)] = 30;
    second[mipTexelOf(texel, 2, 32)] = 20;
    maps.texels[mapTexels(32) + texel] = 7;
    pushMips(mips, maps);
    int sevens = 0, twenties = 0, thirties = 0, others = 0;
    for (std::size_t t = 0; t < maps.texels.size(); ++t) {
        const uint bits = maps.texels[t];
        if (bits == kNone) continue;
        if (t < mapTexels(32)) ++others;
        sevens += bits == 7;
        twenties += bits == 20;
        thirties += bits == 30;
    }
    EXPECT_EQ(others, 0);
    EXPECT_EQ(sevens, 1);
    EXPECT_EQ(twenties, 15);
    EXPECT_EQ(thirties, 48);
}

}  // namespace
}  // namespace mv
