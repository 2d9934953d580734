// The triangle BVH against the definition (every triangle, in double), and its own promises:
// leaf size, depth, bounds, determinism, no leaks between neighbours, alpha masks.

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstring>
#include <functional>

#include "megaviews/scene/load_scene.h"
#include "megaviews/scene/rigged_scene.h"
#include "scene/bvh_test_scene.h"

namespace mv {
namespace {

using testing::exactHit;
using testing::ExactHit;
using testing::Random;
using testing::randomSoup;
using testing::soupScene;

std::string show(glm::vec3 v) {
    char text[96];
    std::snprintf(text, sizeof text, "(%.9g, %.9g, %.9g)", static_cast<double>(v.x),
                  static_cast<double>(v.y), static_cast<double>(v.z));
    return text;
}

// A hit must be one by the definition up to rounding, nothing clearly nearer may exist, and a
// miss must not pass clearly inside any triangle.
void expectAgrees(const Scene& scene, const TriangleBvh& bvh, glm::vec3 o, glm::vec3 d, float tMin,
                  float tMax) {
    SCOPED_TRACE("origin " + show(o) + " direction " + show(d) + " t " + std::to_string(tMin) +
                 " .. " + std::to_string(tMax));
    constexpr double kT = 2e-5, kInside = 1e-4;
    auto hit = bvh.intersect(o, d, tMin, tMax);
    EXPECT_EQ(bvh.occluded(o, d, tMin, tMax), hit.has_value());
    double limit = hit ? static_cast<double>(hit->t) : static_cast<double>(tMax);
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        ExactHit e = exactHit(scene, i, o, d);
        if (e.parallel || e.inside < kInside) continue;
        bool nearer = e.t > static_cast<double>(tMin) + kT && e.t < limit - kT;
        // Grazing triangles: t itself is uncertain.
        glm::uvec3 corner = scene.triangles[i];
        glm::vec3 n = normalizeOr(cross3(scene.positions[corner.y] - scene.positions[corner.x],
                                         scene.positions[corner.z] - scene.positions[corner.x]),
                                  d);
        if (std::abs(dot3(n, d)) < 0.02f) continue;
        EXPECT_FALSE(nearer) << "triangle " << i << " at " << e.t << " inside " << e.inside
                             << (hit ? ", reported " + std::to_string(hit->t) : ", nothing found");
    }
    if (!hit) return;
    EXPECT_GT(hit->t, tMin);
    EXPECT_LT(hit->t, tMax);
    EXPECT_GE(hit->u, 0);
    EXPECT_GE(hit->v, 0);
    EXPECT_LE(hit->u + hit->v, 1.00001f);
    ASSERT_LT(hit->slot, bvh.triangles.size());
    EXPECT_EQ(bvh.triangles[hit->slot].triangle, hit->triangle);
    BvhSurface s = bvh.surface(*hit);
    glm::vec3 onRay = o + d * hit->t;
    glm::vec3 onTriangle(s.positionX, s.positionY, s.positionZ);
    glm::vec3 n(s.geometricX, s.geometricY, s.geometricZ);
    float slope = std::max(std::abs(dot3(n, d)), 1e-3f);
    EXPECT_LT(length3(onRay - onTriangle), 5e-6f / slope + 5e-6f) << "slope " << slope;
}

using Box = std::pair<glm::vec3, glm::vec3>;

// Every point of every triangle lies in a leaf that holds it, and in all boxes on the way there.
void expectSound(const TriangleBvh& bvh, const Scene& scene) {
    const std::size_t triangles = scene.triangles.size();
    const auto more = static_cast<std::size_t>(kBvhPieces * static_cast<float>(triangles));
    ASSERT_GE(bvh.triangles.size(), triangles);
    ASSERT_LE(bvh.triangles.size(), triangles + more);
    std::vector<std::vector<Box>> homes(triangles);  // what its leaves lie in
    std::vector<int> reached(bvh.nodes.size(), 0), used(bvh.triangles.size(), 0);
    const auto planes = [](const BvhNode& n, int k) {
        const auto at = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
            const glm::uvec3 steps(x >> (8 * k) & 255u, y >> (8 * k) & 255u, z >> (8 * k) & 255u);
            return glm::vec3(n.originX, n.originY, n.originZ) +
                   glm::vec3(n.scaleX, n.scaleY, n.scaleZ) * glm::vec3(steps);
        };
        return Box(at(n.lowX, n.lowY, n.lowZ), at(n.highX, n.highY, n.highZ));
    };
    // waiting: children that may wait in a walk when it comes here. inside: all boxes above.
    const std::function<void(std::uint32_t, int, Box)> walk = [&](std::uint32_t node, int waiting,
                                                                  Box inside) {
        ASSERT_LT(node, bvh.nodes.size());
        ++reached[node];
        const BvhNode& n = bvh.nodes[node];
        const std::uint32_t children[] = {n.child0, n.child1, n.child2, n.child3};
        waiting += 3 - static_cast<int>(std::ranges::count(children, kNone));
        EXPECT_LT(waiting, kBvhStack);
        for (int k = 0; k < 4; ++k) {
            if (children[k] == kNone) continue;
            const std::uint32_t first = children[k] >> 3, count = children[k] & 7;
            EXPECT_LE(count, kBvhLeafTriangles);
            const Box own = planes(n, k);
            const Box box(glm::max(inside.first, own.first), glm::min(inside.second, own.second));
            if (count == 0) walk(first, waiting, box);
            for (std::uint32_t i = first; i < first + count; ++i) {
                ++used.at(i);
                homes[bvh.triangles[i].triangle].push_back(box);
            }
        }
    };
    if (!bvh.nodes.empty()) walk(0, 0, {glm::vec3(-kInfinity), glm::vec3(kInfinity)});
    EXPECT_TRUE(std::ranges::all_of(used, [](int k) { return k == 1; }));
    EXPECT_TRUE(std::ranges::all_of(reached, [](int k) { return k == 1; }));

    Random random(9);
    Box all(glm::vec3(kInfinity), glm::vec3(-kInfinity));
    for (std::size_t t = 0; t < triangles; ++t) {
        const glm::uvec3 c = scene.triangles[t];
        const glm::vec3 corners[] = {scene.positions[c.x], scene.positions[c.y],
                                     scene.positions[c.z]};
        for (int i = 0; i < 12; ++i) {
            const float u = random.uniform(), v = random.uniform() * (1 - u);
            const glm::vec3 p =
                i < 3 ? corners[i] : corners[0] * (1 - u - v) + corners[1] * u + corners[2] * v;
            all = {glm::min(all.first, p), glm::max(all.second, p)};
            EXPECT_TRUE(std::ranges::any_of(homes[t],
                                            [&](const Box& home) {
                                                return glm::all(
                                                           glm::lessThanEqual(home.first, p)) &&
                                                       glm::all(glm::lessThanEqual(p, home.second));
                                            }))
                << "triangle " << t << " at " << show(p);
        }
    }
    if (triangles == 0) return;
    const glm::vec3 center = 0.5f * (all.first + all.second);
    const float radius = 0.5f * glm::length(all.second - all.first);
    if (bvh.moving) {  // the ball holds all poses
        EXPECT_LE(glm::length(center - bvh.center) + radius, bvh.radius * 1.75f);
    } else {
        EXPECT_LE(glm::length(center - bvh.center), 1e-6f);
        EXPECT_NEAR(radius, bvh.radius, 1e-6f);
    }
}

TEST(TriangleBvh, AgreesWithEveryTriangleOnRandomSoups) {
    Random random(1);
    for (auto [count, size] : {std::pair{1, 0.5f},
                               {2, 0.5f},
                               {3, 0.8f},
                               {4, 0.3f},
                               {5, 0.3f},
                               {17, 0.4f},
                               {200, 0.2f},
                               {3000, 0.05f}}) {
        Scene scene = soupScene(randomSoup(random, static_cast<std::size_t>(count), size));
        TriangleBvh bvh = TriangleBvh::build(scene);
        expectSound(bvh, scene);
        for (int i = 0; i < 300; ++i) {
            glm::vec3 o = i % 2 ? random.point() : glm::vec3(0.5f) + 1.5f * random.direction();
            glm::vec3 target = random.point();
            if (i % 3 == 0) {  // at a triangle, so that small soups are hit too
                glm::uvec3 c = scene.triangles[random.index(scene.triangles.size())];
                target =
                    (scene.positions[c.x] + scene.positions[c.y] + scene.positions[c.z]) / 3.0f;
            }
            glm::vec3 d = normalizeOr(target - o, glm::vec3(1, 0, 0));
            float tMin = i % 5 == 0 ? random.uniform(0, 0.3f) : 0.0f;
            float tMax = i % 7 == 0 ? random.uniform(0.3f, 1.0f) : kInfinity;
            expectAgrees(scene, bvh, o, d, tMin, tMax);
        }
    }
}

TEST(TriangleBvh, AgreesForDirectionsWithZeroAndTinyComponents) {
    Random random(2);
    Scene scene = soupScene(randomSoup(random, 500, 0.3f));
    TriangleBvh bvh = TriangleBvh::build(scene);
    for (int i = 0; i < 600; ++i) {
        glm::vec3 o = random.point();
        glm::vec3 d = random.direction();
        d[i % 3] = i % 4 == 0 ? 1e-30f : 0.0f;
        if (i % 2) d[(i + 1) % 3] = -0.0f;
        d = normalizeOr(d, glm::vec3(0, 0, 1));
        expectAgrees(scene, bvh, o, d, 0, kInfinity);
    }
}

TEST(TriangleBvh, DirectionNeedNotBeUnit) {
    Random random(3);
    Scene scene = soupScene(randomSoup(random, 300, 0.3f));
    TriangleBvh bvh = TriangleBvh::build(scene);
    int hits = 0;
    for (int i = 0; i < 300; ++i) {
        glm::vec3 o = random.point(), d = random.direction();
        auto one = bvh.intersect(o, d, 0, kInfinity);
        auto four = bvh.intersect(o, 4.0f * d, 0, kInfinity);
        ASSERT_EQ(one.has_value(), four.has_value()) << show(o) << show(d);
        if (!one) continue;
        ++hits;
        EXPECT_EQ(one->triangle, four->triangle) << show(o) << show(d);
        EXPECT_NEAR(one->t, 4 * four->t, 1e-6);
    }
    EXPECT_GT(hits, 100);
}

TEST(TriangleBvh, EmptySceneIsNeverHit) {
    Scene scene = soupScene({});
    TriangleBvh bvh = TriangleBvh::build(scene);
    EXPECT_TRUE(bvh.nodes.empty());
    EXPECT_FALSE(bvh.intersect(glm::vec3(0.5f), glm::vec3(1, 0, 0), 0, kInfinity));
    EXPECT_FALSE(bvh.occluded(glm::vec3(0.5f), glm::vec3(1, 0, 0), 0, kInfinity));
}

TEST(TriangleBvh, DegenerateAndCoincidentTrianglesAreHarmless) {
    std::vector<glm::vec3> corners;
    glm::vec3 a(0.25f, 0.25f, 0.5f), b(0.75f, 0.25f, 0.5f), c(0.25f, 0.75f, 0.5f);
    for (int i = 0; i < 100; ++i) {
        corners.insert(corners.end(), {a, a, a});                     // a point
        corners.insert(corners.end(), {a, b, glm::mix(a, b, 0.5f)});  // a line
        corners.insert(corners.end(), {a, b, c});                     // the same one again
    }
    Scene scene = soupScene(corners);
    TriangleBvh bvh = TriangleBvh::build(scene);
    expectSound(bvh, scene);
    auto hit = bvh.intersect({0.35f, 0.35f, 0}, {0, 0, 1}, 0, kInfinity);
    ASSERT_TRUE(hit);
    EXPECT_FLOAT_EQ(hit->t, 0.5f);
    EXPECT_EQ(hit->triangle, 2u) << "of equal distances the lowest index wins";
    EXPECT_FALSE(bvh.intersect({0.7f, 0.7f, 0}, {0, 0, 1}, 0, kInfinity));
    EXPECT_FALSE(bvh.intersect({0.35f, 0.35f, 0}, {0, 0, 1}, 0.5f, kInfinity)) << "tMin is open";
    EXPECT_FALSE(bvh.intersect({0.35f, 0.35f, 0}, {0, 0, 1}, 0, 0.5f)) << "tMax is open";
}

// Sizes that shrink geometrically make SAH peel one triangle a level: the depth bound must hold.
TEST(TriangleBvh, DepthIsBoundedForAdversarialSizes) {
    std::vector<glm::vec3> corners;
    float scale = 1;
    for (int i = 0; i < 2000; ++i) {
        glm::vec3 p(scale * (1 + 1e-3f * static_cast<float>(i % 20)));
        corners.insert(corners.end(),
                       {p, p + glm::vec3(0.1f * scale, 0, 0), p + glm::vec3(0, 0.1f * scale, 0)});
        if (i % 20 == 19) scale *= 0.75f;
    }
    Scene scene = soupScene(corners);
    expectSound(TriangleBvh::build(scene), scene);
}

// A closed sphere of a million-fold corner sharing: rays from inside at corners, edges and
// anywhere never leave. One leak would be a failure of the shared-edge rule.
TEST(TriangleBvh, NothingSlipsBetweenNeighbours) {
    Scene scene;
    scene.materials.push_back({});
    constexpr int kRings = 40, kSegments = 64;
    auto vertex = [](int ring, int segment) {
        return static_cast<std::uint32_t>(ring * kSegments + segment % kSegments);
    };
    for (int r = 0; r <= kRings; ++r)
        for (int s = 0; s < kSegments; ++s) {
            float theta = kPi * static_cast<float>(r) / kRings;
            float phi = 2 * kPi * static_cast<float>(s) / kSegments;
            float sinTheta = r == 0 || r == kRings ? 0.0f : std::sin(theta);
            glm::vec3 n(sinTheta * std::cos(phi), std::cos(theta), sinTheta * std::sin(phi));
            scene.positions.push_back(glm::vec3(0.5f) + 0.37f * n);
            scene.normals.push_back(n);
        }
    for (int r = 0; r < kRings; ++r)
        for (int s = 0; s < kSegments; ++s) {
            scene.triangles.push_back({vertex(r, s), vertex(r, s + 1), vertex(r + 1, s)});
            scene.triangles.push_back({vertex(r, s + 1), vertex(r + 1, s + 1), vertex(r + 1, s)});
        }
    scene.triangleMaterials.assign(scene.triangles.size(), 0);
    TriangleBvh bvh = TriangleBvh::build(scene);
    expectSound(bvh, scene);
    Random random(4);
    for (int i = 0; i < 60000; ++i) {
        glm::vec3 o = glm::vec3(0.5f) + 0.3f * (random.point() - 0.5f);
        if (i % 8 == 0) o = glm::vec3(0.5f);
        glm::uvec3 c = scene.triangles[random.index(scene.triangles.size())];
        glm::vec3 p = scene.positions[c.x], q = scene.positions[c.y];
        glm::vec3 target = i % 3 == 0   ? p
                           : i % 3 == 1 ? glm::mix(p, q, random.uniform())
                                        : random.point() * 1.0f;
        glm::vec3 d = normalizeOr(target - o, glm::vec3(0, 1, 0));
        ASSERT_TRUE(bvh.intersect(o, d, 0, kInfinity)) << show(o) << " " << show(d);
    }
}

// Axis-aligned rays running exactly over the corners and edges of a flat grid, from above and
// with origins on the planes of the boxes.
TEST(TriangleBvh, GridCornersAndEdgesDoNotLeakForAxisAlignedRays) {
    constexpr int kN = 16;
    Scene scene;
    scene.materials.push_back({});
    for (int y = 0; y <= kN; ++y)
        for (int x = 0; x <= kN; ++x) {
            scene.positions.push_back(
                {static_cast<float>(x) / kN, 0.5f, static_cast<float>(y) / kN});
            scene.normals.push_back({0, 1, 0});
        }
    for (std::uint32_t y = 0; y < kN; ++y)
        for (std::uint32_t x = 0; x < kN; ++x) {
            std::uint32_t i = y * (kN + 1) + x;
            scene.triangles.push_back({i, i + kN + 1, i + 1});
            scene.triangles.push_back({i + 1, i + kN + 1, i + kN + 2});
        }
    scene.triangleMaterials.assign(scene.triangles.size(), 0);
    TriangleBvh bvh = TriangleBvh::build(scene);
    for (int y = 0; y <= 2 * kN; ++y)
        for (int x = 0; x <= 2 * kN; ++x) {
            glm::vec3 o(static_cast<float>(x) / (2 * kN), 1, static_cast<float>(y) / (2 * kN));
            EXPECT_TRUE(bvh.intersect(o, {0, -1, 0}, 0, kInfinity)) << show(o);
            o.y = 0;
            EXPECT_TRUE(bvh.intersect(o, {0, 1, 0}, 0, kInfinity)) << show(o);
        }
    EXPECT_FALSE(bvh.intersect({1.001f, 1, 0.5f}, {0, -1, 0}, 0, kInfinity));
}

TEST(TriangleBvh, AlphaMaskLetsRaysThrough) {
    // A quad at z = 0.5, uv = position, textured with alpha 255 left and 0 right; a wall behind it.
    Scene scene;
    scene.positions = {{0, 0, 0.5f}, {1, 0, 0.5f}, {1, 1, 0.5f}, {0, 1, 0.5f},
                       {0, 0, 1},    {1, 0, 1},    {1, 1, 1},    {0, 1, 1}};
    scene.normals.assign(8, glm::vec3(0, 0, -1));
    scene.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {1, 1}, {0, 1}};
    scene.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    scene.triangleMaterials = {1, 1, 0, 0};
    Image image{.name = "mask", .width = 4, .height = 4, .rgba = {}};
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            std::uint8_t alpha = x < 2 ? 255 : 0;
            image.rgba.insert(image.rgba.end(), {255, 0, 0, alpha});
        }
    scene.images.push_back(image);
    scene.textures.push_back({.image = 0, .wrapS = Wrap::clamp, .wrapT = Wrap::clamp});
    scene.materials.resize(2);
    scene.materials[1].baseTexture = 0;
    scene.materials[1].alphaCutoff = 0.5f;
    TriangleBvh bvh = TriangleBvh::build(scene);
    EXPECT_TRUE(bvh.flags & kBvhMasks);
    auto left = bvh.intersect({0.25f, 0.4f, 0}, {0, 0, 1}, 0, kInfinity);
    auto right = bvh.intersect({0.75f, 0.4f, 0}, {0, 0, 1}, 0, kInfinity);
    ASSERT_TRUE(left && right);
    EXPECT_FLOAT_EQ(left->t, 0.5f);
    EXPECT_FLOAT_EQ(right->t, 1.0f);
    EXPECT_TRUE(bvh.occluded({0.25f, 0.4f, 0}, {0, 0, 1}, 0, 0.9f));
    EXPECT_FALSE(bvh.occluded({0.75f, 0.4f, 0}, {0, 0, 1}, 0, 0.9f));
    BvhSurface s = bvh.surface(*left);
    EXPECT_NEAR(s.albedoR, 1, 1e-6);
    EXPECT_NEAR(s.albedoG, 0, 1e-6);
    EXPECT_EQ(s.material, 1u);

    scene.colors.assign(8, glm::vec4(1, 1, 1, 0.4f));  // vertex alpha counts too
    bvh = TriangleBvh::build(scene);
    EXPECT_FLOAT_EQ(bvh.intersect({0.25f, 0.4f, 0}, {0, 0, 1}, 0, kInfinity)->t, 1.0f);
}

TEST(TriangleBvh, SurfaceCombinesFactorsTexturesAndColours) {
    Scene scene = soupScene({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    scene.uvs = {{0, 0}, {1, 0}, {0, 1}};
    scene.emissiveUvs = {{0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f}};
    scene.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
    scene.images.push_back({.name = "grey", .width = 1, .height = 1, .rgba = {188, 188, 188, 255}});
    scene.textures.push_back({.image = 0});
    scene.materials[0] = {.name = "m",
                          .baseColor = {0.8f, 0.6f, 0.4f, 1},
                          .baseTexture = 0,
                          .emission = {2, 3, 4},
                          .emissiveTexture = 0};
    TriangleBvh bvh = TriangleBvh::build(scene);
    auto hit = bvh.intersect({0.25f, 0.5f, 1}, {0, 0, -1}, 0, kInfinity);
    ASSERT_TRUE(hit);
    EXPECT_FLOAT_EQ(hit->u, 0.25f);
    EXPECT_FLOAT_EQ(hit->v, 0.5f);
    BvhSurface s = bvh.surface(*hit);
    float grey = std::pow((188 / 255.0f + 0.055f) / 1.055f, 2.4f);
    EXPECT_NEAR(s.albedoR, 0.8f * 0.25f * grey, 1e-6);
    EXPECT_NEAR(s.albedoG, 0.6f * 0.25f * grey, 1e-6);
    EXPECT_NEAR(s.albedoB, 0.4f * 0.5f * grey, 1e-6);
    EXPECT_NEAR(s.emissionB, 4 * grey, 1e-5);
    EXPECT_FLOAT_EQ(s.geometricZ, 1);
    scene.materials[0].unlit = true;
    bvh = TriangleBvh::build(scene);
    s = bvh.surface(*hit);
    EXPECT_EQ(s.albedoR, 0);
    EXPECT_NEAR(s.emissionR, (2 + 0.8f * 0.25f) * grey, 1e-5);
}

TEST(TraceTextures, WrapsAndFiltersAsAsked) {
    Scene scene;
    Image image{
        .name = "ramp", .width = 2, .height = 1, .rgba = {0, 0, 0, 255, 255, 255, 255, 255}};
    scene.images.push_back(image);
    scene.textures = {{.image = 0, .wrapS = Wrap::repeat, .nearest = true},
                      {.image = 0, .wrapS = Wrap::clamp, .nearest = true},
                      {.image = 0, .wrapS = Wrap::mirror, .nearest = true},
                      {.image = 0, .wrapS = Wrap::clamp},
                      {.image = -1}};
    TriangleBvh bvh;
    bvh.textures = makeTraceTextures(scene);
    BvhData data;
    data.textures = bvh.textures.textures.data();
    data.texels = bvh.textures.texels.data();
    auto red = [&](std::uint32_t t, float u) { return sampleTraceTexture(data, t, {u, 0.5f}).x; };
    EXPECT_EQ(red(0, 0.25f), 0);
    EXPECT_EQ(red(0, 0.75f), 1);
    EXPECT_EQ(red(0, 1.25f), 0);
    EXPECT_EQ(red(0, -0.25f), 1);
    EXPECT_EQ(red(1, 1.25f), 1);
    EXPECT_EQ(red(1, -0.25f), 0);
    EXPECT_EQ(red(2, 1.25f), 1);
    EXPECT_EQ(red(2, 1.75f), 0);
    EXPECT_EQ(red(2, -0.25f), 0);
    EXPECT_FLOAT_EQ(red(3, 0.5f), 0.5f) << "halfway between texels, in linear colour";
    EXPECT_EQ(red(4, 0.5f), 1) << "no image: white";
    EXPECT_EQ(red(3, std::numeric_limits<float>::quiet_NaN()), 0) << "as uv 0";
}

TEST(TraceTextures, LargeImagesAreBoxFilteredInLinearColour) {
    Scene scene;
    int n = 2 * kTraceTextureSize + 1;
    Image image{.name = "checker", .width = n, .height = 3, .rgba = {}};
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < n; ++x) {
            std::uint8_t c = x % 2 ? 255 : 0;
            image.rgba.insert(image.rgba.end(), {c, c, c, 255});
        }
    scene.images.push_back(image);
    scene.textures.push_back({.image = 0});
    TraceTextures t = makeTraceTextures(scene);
    ASSERT_EQ(t.textures.size(), 1u);
    EXPECT_EQ(t.textures[0].width, static_cast<std::uint32_t>(kTraceTextureSize));
    EXPECT_EQ(t.textures[0].height, 3u);
    std::uint32_t texel = t.texels[t.textures[0].offset + 10] & 255;
    EXPECT_EQ(texel, 188u) << "half of linear white in sRGB";
    EXPECT_EQ(t.texels[t.textures[0].offset + 10] >> 24, 255u);
}

// Each triangle a hundredth nearer to a corner than the last: the tree is a chain, as deep as it
// may be, and a walk must still not let more children wait than there is room for.
TEST(TriangleBvh, ChainsLeaveRoomInAWalk) {
    std::vector<glm::vec3> corners;
    float x = 1.0f;
    for (int i = 0; i < 4000; ++i, x *= 0.99f) {
        const glm::vec3 at(x, x, x);
        corners.insert(corners.end(),
                       {at, at * glm::vec3(1, 1, 0.99f), at * glm::vec3(1, 0.99f, 1)});
    }
    const Scene scene = soupScene(corners);
    const TriangleBvh bvh = TriangleBvh::build(scene);
    expectSound(bvh, scene);
    Random random(11);
    for (int i = 0; i < 200; ++i) {
        const glm::vec3 o = random.point();
        expectAgrees(scene, bvh, o,
                     normalizeOr(corners[random.index(1000)] - o, glm::vec3(1, 0, 0)), 0,
                     kInfinity);
    }
}

// Large triangles across the box of a hundred small ones each: cut, a ray meets a few of them.
TEST(TriangleBvh, LargeTrianglesAreCutWhereTheyFillTheirBoxesPoorly) {
    Random random(12);
    std::vector<glm::vec3> corners = randomSoup(random, 4000, 0.02f);
    for (int i = 0; i < 100; ++i) {
        const float y = 0.01f * static_cast<float>(i);
        corners.insert(corners.end(), {{0, y, 0}, {1, 1 - y, 0.99f}, {0.99f, 1 - y, 1}});
    }
    const Scene scene = soupScene(corners);
    const TriangleBvh bvh = TriangleBvh::build(scene);
    expectSound(bvh, scene);
    std::size_t ofLarge = 0;
    for (const BvhTriangle& t : bvh.triangles) ofLarge += t.triangle >= 4000 ? 1 : 0;
    EXPECT_GT(ofLarge, 900u) << "of 1330 pieces and 100 triangles most";
    for (int i = 0; i < 100; ++i) {
        expectAgrees(scene, bvh, random.point(), random.direction(), 0, kInfinity);
    }
}

TEST(TriangleBvh, SameBytesForAnyNumberOfThreads) {
    Random random(5);
    Scene scene = soupScene(randomSoup(random, 120000, 0.01f));
    TriangleBvh many = TriangleBvh::build(scene);
    TriangleBvh one;
    {
        tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
        one = TriangleBvh::build(scene);
    }
    ASSERT_EQ(many.nodes.size(), one.nodes.size());
    ASSERT_EQ(many.triangles.size(), one.triangles.size());
    EXPECT_EQ(std::memcmp(many.nodes.data(), one.nodes.data(), many.nodes.size() * sizeof(BvhNode)),
              0);
    EXPECT_EQ(std::memcmp(many.triangles.data(), one.triangles.data(),
                          many.triangles.size() * sizeof(BvhTriangle)),
              0);
}

// Refitted, or rebuilt where refitting has made it poor, for one pose after another.
TEST(TriangleBvh, FollowsWhatMoves) {
    Scene scene = makeBuiltin("builtin:door", {});
    TriangleBvh bvh = TriangleBvh::build(scene);
    ASSERT_TRUE(bvh.moving);
    Random random(13);
    for (const double timeS : {0.0, 2.2, 4.0, 7.0, 9.2, 11.0}) {
        SCOPED_TRACE(timeS);
        poseScene(scene, timeS);
        bvh.refit();
        expectSound(bvh, scene);
        const TriangleBvh built = TriangleBvh::build(scene);
        for (int i = 0; i < 2000; ++i) {
            const glm::vec3 o =
                scene.moving->min + random.point() * (scene.moving->max - scene.moving->min);
            const glm::vec3 d = normalizeOr(random.point() - random.point(), glm::vec3(0, 1, 0));
            if (i < 20) expectAgrees(scene, bvh, o, d, 0, kInfinity);
            const auto hit = bvh.intersect(o, d, 0, kInfinity);
            const auto expected = built.intersect(o, d, 0, kInfinity);
            ASSERT_EQ(hit.has_value(), expected.has_value());
            if (hit) {
                EXPECT_EQ(hit->t, expected->t);
            }
        }
    }
}

// Where shading normals cancel, or a file has none, the face's own stands in.
// Rays that begin above a cup are of no use to the table under it.
TEST(TriangleBvh, RaysBeginNearWhatIsSmallOnALargeGround) {
    Random random(7);
    for (const float size : {1.0f, 0.3f, 0.1f, 4e-3f, 1e-4f}) {
        std::vector<glm::vec3> corners = randomSoup(random, 50, 0.2f);
        for (glm::vec3& p : corners) p = glm::vec3(0.5f) + size * (p - glm::vec3(0.5f));
        for (const glm::vec3& p :
             {glm::vec3(0, 0, 0), {1, 0, 0}, {1, 0, 1}, {0, 0, 0}, {1, 0, 1}, {0, 0, 1}}) {
            corners.push_back(p);
        }
        Scene scene = soupScene(corners);
        const auto lift = [&] { return bvhLift(TriangleBvh::build(scene).data()); };
        if (size > 0.02f) {
            EXPECT_EQ(lift(), kVplOffset) << size;
        } else {
            EXPECT_LT(lift(), std::max(kVplOffset * 128 * size, 2e-6f)) << size;
        }
        EXPECT_GT(lift(), 1e-6f);
        for (const float step : {3e-5f, 3e-4f}) {
            scene.positionStep = step;
            EXPECT_GE(lift(), step);
            EXPECT_LT(lift(), 2 * step);
        }
    }
}

TEST(BvhSurface, WithoutAShadingNormalHasTheFaces) {
    Scene scene = testing::soupScene({{0.2f, 0.5f, 0.2f}, {0.8f, 0.5f, 0.2f}, {0.2f, 0.5f, 0.8f}});
    const TriangleBvh bvh = TriangleBvh::build(scene);
    auto hit = bvh.intersect({0.35f, 0.9f, 0.35f}, {0, -1, 0}, 0, 10);
    ASSERT_TRUE(hit);
    hit->u = hit->v = 0.25f;  // weights whose sums are exact
    for (const bool zero : {true, false}) {
        scene.normals[0] = zero ? glm::vec3(0) : glm::vec3(0.5f, 0, 0);
        scene.normals[1] = zero ? glm::vec3(0) : glm::vec3(-1, 0, 0);
        scene.normals[2] = glm::vec3(0);
        const TriangleBvh again = TriangleBvh::build(scene);
        const BvhSurface s = again.surface(*hit);
        EXPECT_EQ(s.shadingX, 0) << zero;
        EXPECT_EQ(std::abs(s.shadingY), 1) << zero;
        EXPECT_EQ(s.shadingZ, 0) << zero;
        EXPECT_EQ(s.shadingY, s.geometricY) << zero;
    }
}

}  // namespace
}  // namespace mv
