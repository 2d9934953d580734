// Our rays and paths against Embree's: the twin shares no sampling, no rays and no precision with
// traceVpls, so what agrees is right.

#include "views/trace_vpls_reference.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "megaviews/scene/load_scene.h"
#include "views/rooms.h"

namespace mv {
namespace {

using testing::fluxOf;
using testing::furnishedRoom;
using testing::Lit;
using testing::normalOf;
using testing::positionOf;

// ---------------------------------------------------------------- single rays

TEST(EmbreeRays, FindTheSameSurfacesAsOurs) {
    for (std::uint32_t seed = 0; seed < 3; ++seed) {
        const Lit lit(furnishedRoom(seed, testing::panel));
        const EmbreeScene embree(lit.bvh);
        int hits = 0, disagreements = 0;
        for (uint i = 0; i < 20000; ++i) {
            const vec4 a = random4(seed, i, 0, 100), b = random4(seed, i, 0, 101);
            const vec3 origin(a.x, a.y, a.z);
            const vec3 direction = sphereDirection(b.x, b.y);
            const float tMax = i % 3 == 0 ? 0.3f : kInfinity;
            const auto ours = lit.bvh.intersect(origin, direction, 0, tMax);
            const auto theirs = embree.intersect(origin, direction, 0, tMax);
            EXPECT_EQ(ours.has_value(), lit.bvh.occluded(origin, direction, 0, tMax));
            EXPECT_EQ(theirs.has_value(), embree.occluded(origin, direction, 0, tMax));
            hits += ours.has_value();
            // Rays through an edge of a mask's texel or of a box may go either way.
            const bool agree = ours.has_value() == theirs.has_value() &&
                               (!ours || std::abs(ours->t - theirs->t) < 2e-6f * (1 + ours->t));
            disagreements += !agree;
            if (agree && ours && ours->triangle == theirs->triangle) {
                EXPECT_NEAR(ours->u, theirs->u, 1e-4);
                EXPECT_NEAR(ours->v, theirs->v, 1e-4);
                EXPECT_EQ(ours->slot, theirs->slot);
            }
        }
        EXPECT_GT(hits, 10000);
        EXPECT_LE(disagreements, 4) << "of 20000, seed " << seed;
    }
}

TEST(EmbreeRays, AnEmptySceneIsHitByNothing) {
    const Lit lit{testing::RoomBuilder().finish()};
    const EmbreeScene embree(lit.bvh);
    EXPECT_FALSE(embree.intersect({0.5f, 0.5f, 0.5f}, {0, 0, 1}, 0, 1e30f).has_value());
    EXPECT_FALSE(embree.occluded({0.5f, 0.5f, 0.5f}, {0, 0, 1}, 0, 1e30f));
}

// ---------------------------------------------------------------- paths

// What is compared of the VPLs of one bounce: sums of flux, and of flux times place, squared
// place and normal.
constexpr std::size_t kMoments = 12;
std::array<double, kMoments> momentsOf(const View& v) {
    if (v.flags == kViewDead) return {};
    const glm::dvec3 f = fluxOf(v), p = positionOf(v), n = normalOf(v);
    const double w = f.x + f.y + f.z;
    return {f.x,           f.y,           f.z,           w * p.x, w * p.y, w * p.z,
            w * p.x * p.x, w * p.y * p.y, w * p.z * p.z, w * n.x, w * n.y, w * n.z};
}

struct Mean {
    double mean = 0, standardError = 0;
};
// Over samples (paths, or bounce-0 VPLs) that are independent of each other.
Mean meanOf(const ViewSet& set, std::size_t first, std::size_t stride, std::size_t moment) {
    double sum = 0, squares = 0, n = 0;
    for (std::size_t slot = first; slot < set.views.size(); slot += stride) {
        const double x = momentsOf(set.views[slot])[moment];
        sum += x;
        squares += x * x;
        n += 1;
    }
    const double mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n)};
}

void compare(const Lit& lit, std::uint64_t count, int bounces) {
    const EmbreeScene embree(lit.bvh);
    const ViewSet ours = lit.trace(count, bounces, 1);
    const ViewSet theirs = traceVplsReference(embree, 0, -1, 1, {count, bounces, 1});
    const VplSetup setup = makeVplSetup(lit.emitters, {count, bounces, 1});
    const auto check = [&](const ViewSet& a, const ViewSet& b, std::size_t first,
                           std::size_t stride, const std::string& what) {
        for (std::size_t m = 0; m < kMoments; ++m) {
            const Mean x = meanOf(a, first, stride, m), y = meanOf(b, first, stride, m);
            const double sigma = std::hypot(x.standardError, y.standardError);
            // 5 sigma, and float rounding where there is no variance at all.
            EXPECT_NEAR(x.mean, y.mean, 5 * sigma + 2e-5 * std::abs(y.mean))
                << what << ", moment " << m << ", sigma " << sigma;
        }
    };
    if (setup.surfaceSlots > 0) {
        ViewSet a = ours, b = theirs;
        a.views.resize(setup.surfaceSlots);
        b.views.resize(setup.surfaceSlots);
        EXPECT_GT(a.alive(), 0u);
        check(a, b, 0, 1, "emitters");
    }
    const auto stride = static_cast<std::size_t>(bounces);
    for (std::size_t bounce = 0; bounce < stride; ++bounce) {
        check(ours, theirs, setup.surfaceSlots + bounce, stride,
              "bounce " + std::to_string(bounce + 1));
    }
    const double alive = static_cast<double>(ours.alive());
    EXPECT_GT(alive, 0.1 * static_cast<double>(count));
}

TEST(EmbreePaths, AgreeForEachKindOfLight) {
    std::uint32_t seed = 10;
    for (const int lighting : {testing::point, testing::spot, testing::sun, testing::panel}) {
        SCOPED_TRACE(lighting);
        compare(Lit(furnishedRoom(seed++, lighting)), 80000, 4);
    }
}

TEST(EmbreePaths, AgreeForAllLightsTogether) {
    compare(Lit(furnishedRoom(20, testing::everything)), 160000, 3);
}

TEST(EmbreePaths, AgreeWhereNormalsAreBent) {
    Scene scene = furnishedRoom(21, testing::point);
    for (std::size_t i = 0; i < scene.normals.size(); ++i) {
        const vec4 r = random4(23, static_cast<uint>(i), 0, 0);
        scene.normals[i] = glm::normalize(scene.normals[i] + vec3(r.x, r.y, r.z) - 0.5f);
    }
    compare(Lit(std::move(scene)), 80000, 4);
}

TEST(EmbreePaths, AgreeInTheCornellBox) { compare(Lit(loadScene("builtin:cornell")), 80000, 4); }

}  // namespace
}  // namespace mv
