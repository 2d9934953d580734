// VPLs on the CPU: slots, energy, places, identity.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>

#include "shaders/shared/importance.glsl"
#include "views/rooms.h"

namespace mv {
namespace {

using testing::fluxOf;
using testing::furnishedRoom;
using testing::Lit;
using testing::normalOf;
using testing::positionOf;
using testing::RoomBuilder;
using testing::whiteRoom;

RoomBuilder lampRoom(float albedo = 1) {
    RoomBuilder room = whiteRoom(albedo);
    room.light(LightType::point, {1, 1.2, 2}, {0, -1, 0}, {3, 2, 1});
    return room;
}
RoomBuilder panelRoom(float albedo = 1) {
    RoomBuilder room = whiteRoom(albedo);
    room.quad({1, 2.5, 1}, {1, 0, 0}, {0, 0, 1}, room.material(glm::vec3(albedo), {3, 2, 1}));
    return room;
}

bool sameBytes(const View& a, const View& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// ---------------------------------------------------------------- slots

TEST(VplSlots, PathsFillTheSlotsWhateverTheNumbers) {
    const Lit lit(lampRoom(0.5f).finish());
    for (const int bounces : {1, 2, 3, 4, 7}) {
        for (const std::uint64_t count : {1u, 2u, 3u, 5u, 7u, 8u, 9u, 63u, 64u, 65u, 1000u}) {
            const ViewSet set = lit.trace(count, bounces);
            ASSERT_EQ(set.views.size(), count);
            EXPECT_EQ(set.alive(), count) << "a closed room loses no path";
            const auto b = static_cast<std::uint32_t>(bounces);
            for (std::uint32_t slot = 0; slot < count; ++slot) {
                EXPECT_EQ(set.views[slot].slot, slot);
                EXPECT_EQ(set.views[slot].bounce, slot % b + 1);
                EXPECT_EQ(set.views[slot].flags, kViewHemisphere);
            }
            const VplSetup setup = makeVplSetup(lit.emitters, {count, bounces, 0});
            EXPECT_EQ(setup.paths, (count + b - 1) / b);
            EXPECT_EQ(setup.surfaceSlots, 0u);
        }
    }
}

TEST(VplSlots, AQuarterRoundedUpLiesOnEmitters) {
    const Lit lit(panelRoom(0.5f).finish());
    for (const std::uint64_t count : {1u, 2u, 3u, 4u, 5u, 9u, 100u}) {
        const ViewSet set = lit.trace(count, 4);
        ASSERT_EQ(set.views.size(), count);
        const std::uint64_t onEmitters = (count + 3) / 4;
        for (std::uint32_t slot = 0; slot < count; ++slot) {
            const View& v = set.views[slot];
            EXPECT_EQ(v.slot, slot);
            const auto k = static_cast<std::uint32_t>(slot - onEmitters);
            EXPECT_EQ(v.bounce, slot < onEmitters ? 0u : k % 4 + 1);
        }
    }
}

TEST(VplSlots, NoViewsNoLightsNoTriangles) {
    EXPECT_TRUE(Lit(lampRoom().finish()).trace(0, 4).views.empty());
    const Lit dark(whiteRoom().finish());
    const ViewSet set = dark.trace(9, 2);
    EXPECT_EQ(set.views.size(), 9u);
    EXPECT_EQ(set.alive(), 0u);
    RoomBuilder nothing;
    nothing.light(LightType::directional, {0, 0, 0}, {0, -1, 0}, {1, 1, 1});
    const ViewSet none = Lit(nothing.finish()).trace(9, 2);
    EXPECT_EQ(none.views.size(), 9u);
    EXPECT_EQ(none.alive(), 0u);
}

TEST(VplSlots, DeadOnesAreAllZero) {
    const Lit lit(furnishedRoom(1, testing::everything));
    const ViewSet set = lit.trace(2000, 4);
    EXPECT_GT(set.alive(), 500u);
    EXPECT_LT(set.alive(), 2000u);
    const VplSetup setup = makeVplSetup(lit.emitters, {2000, 4, 0});
    bool died = false;
    for (std::uint32_t slot = 0; slot < 2000; ++slot) {
        const View& v = set.views[slot];
        if (slot >= setup.surfaceSlots && (slot - setup.surfaceSlots) % 4 == 0) died = false;
        if (v.flags == kViewDead) {
            EXPECT_TRUE(sameBytes(v, View{}));
            died = slot >= setup.surfaceSlots;
        } else {
            EXPECT_EQ(v.slot, slot);
            EXPECT_FALSE(died) << "a path that ended went on";
        }
    }
}

// ---------------------------------------------------------------- energy

// Sum of the flux that arrives with each bounce; bounce 0 is what emitters send.
std::vector<glm::dvec3> fluxPerBounce(const ViewSet& set, int bounces) {
    std::vector<glm::dvec3> sums(static_cast<std::size_t>(bounces) + 1, glm::dvec3(0));
    for (const View& v : set.views) {
        if (v.flags != kViewDead) sums[v.bounce] += fluxOf(v);
    }
    return sums;
}

TEST(VplEnergy, AClosedRoomKeepsWhatItsWallsDoNotAbsorb) {
    for (const float albedo : {1.0f, 0.5f}) {
        const Lit lamp(lampRoom(albedo).finish());
        const glm::dvec3 emitted(lamp.emitters.fluxW());
        const std::vector<glm::dvec3> sums = fluxPerBounce(lamp.trace(4000, 4), 4);
        for (std::size_t b = 1; b <= 4; ++b) {
            const double left = std::pow(static_cast<double>(albedo), static_cast<double>(b));
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(sums[b][c], emitted[c] * left, 2e-5 * emitted[c]);
        }
    }
}

TEST(VplEnergy, PanelsGiveTheirFluxToBounceZeroAndAgainToPaths) {
    const Lit lit(panelRoom().finish());
    const glm::dvec3 emitted(lit.emitters.fluxW());
    const std::vector<glm::dvec3> sums = fluxPerBounce(lit.trace(8000, 3), 3);
    for (std::size_t b = 0; b <= 3; ++b) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(sums[b][c], emitted[c], 1e-4 * emitted[c]) << b;
    }
}

TEST(VplEnergy, ManyLightsSumUpWhateverTheirShares) {
    RoomBuilder room = panelRoom();
    room.light(LightType::point, {1, 1, 1}, {0, -1, 0}, {10, 0, 0});
    room.light(LightType::point, {3, 1, 1}, {0, -1, 0}, {0, 0.1f, 0});
    room.light(LightType::spot, {2, 1, 4}, {0.3, -1, 0.1}, {0, 0, 4}, 0.1, 0.6);
    const Lit lit(room.finish());
    const glm::dvec3 emitted(lit.emitters.fluxW());
    const std::uint64_t paths = 60000;
    const std::vector<glm::dvec3> sums = fluxPerBounce(lit.trace(paths * 4 / 3, 1), 1);
    // Which light a path takes is random: the standard error of a share p is below 1/sqrt(4 paths)
    // of its own flux over p.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sums[1][c], emitted[c], 0.06 * emitted[c]) << c;
}

TEST(VplEnergy, ASunLightsTheCrossSectionThatFacesIt) {
    RoomBuilder room;
    room.box({0, 0, 0}, {2, 1, 3}, room.material(glm::vec3(1)));
    room.light(LightType::directional, {0, 0, 0}, {0, -1, 0}, {7, 7, 7});
    const Lit lit(room.finish());
    const ViewSet set = lit.trace(200000, 1);
    const double share = static_cast<double>(set.alive()) / 200000;
    const double expected = 6.0 / (3.14159265358979 * (4 + 1 + 9) / 4);
    EXPECT_NEAR(share, expected, 5 * std::sqrt(expected * (1 - expected) / 200000));
    EXPECT_NEAR(fluxPerBounce(set, 1)[1].x, 7 * 6.0, 7 * 6 * 0.01);
    for (const View& v : set.views) {
        ASSERT_TRUE(v.flags == kViewDead || v.normalY == 1.0f);
    }
}

// ---------------------------------------------------------------- places and normals

TEST(VplPlace, LiesAFiftiethOfALeafOffItsSurface) {
    const Lit lit(furnishedRoom(2, testing::point | testing::spot));
    int alive = 0;
    for (const View& v : lit.trace(4000, 4).views) {
        if (v.flags == kViewDead) continue;
        ++alive;
        const glm::dvec3 p = positionOf(v), n = normalOf(v);
        EXPECT_NEAR(glm::length(n), 1, 1e-5);
        // Straight back along the normal (surfaces are flat here) the wall is one offset away.
        const auto hit = lit.bvh.intersect(glm::vec3(p), glm::vec3(-n), 0, 1);
        ASSERT_TRUE(hit.has_value());
        EXPECT_NEAR(static_cast<double>(hit->t), 0.02 / 1024, 3e-7);
    }
    EXPECT_GT(alive, 1000);
}

TEST(VplPlace, EmittersAreSampledUniformlyOnTheirFronts) {
    RoomBuilder room;
    room.quad({1, 2, 1}, {3, 0, 0}, {0, 0, 1}, room.material(glm::vec3(1), {1, 1, 1}));
    const Lit lit(room.finish());
    std::array<double, 12> counts{};
    const ViewSet set = lit.trace(48000, 1);
    for (std::uint32_t i = 0; i < 12000; ++i) {
        const View& v = set.views[i];
        ASSERT_EQ(v.bounce, 0u);
        ASSERT_EQ(v.normalY, -1.0f);  // u x v
        const glm::dvec3 p = lit.scene.root.worldFromRoot(glm::vec3(positionOf(v)));
        const int column = static_cast<int>(std::clamp((p.x - 1) / 3 * 6, 0.0, 5.0));
        const int row = static_cast<int>(std::clamp((p.z - 1) * 2, 0.0, 1.0));
        counts[static_cast<std::size_t>(row * 6 + column)] += 1;
    }
    for (const double c : counts) EXPECT_NEAR(c, 1000, 5 * std::sqrt(1000.0));
}

// Far more evenly than random points, which would differ by 32 a cell of 1024 and by 8 of 64; also
// those of them that are kept, and for any seed.
TEST(VplPlace, PointsOnEmittersAreSpreadEvenlyAndSoAreThoseThatAreKept) {
    for (const uint seed : {0u, 1u, 77u}) {
        std::array<double, 16> all{}, kept{};
        double total = 0;
        for (uint slot = 0; slot < 16384; ++slot) {
            const vec4 r = lampNumbers(seed, slot);
            for (const float x : {r.x, r.y, r.z, r.w}) {
                ASSERT_GE(x, 0);
                ASSERT_LT(x, 1);
            }
            const std::size_t cell = std::size_t(r.y * 4) * 4 + std::size_t(r.z * 4);
            const bool keeps = keepsCandidate(seed, slot, 0, 1.0f / 16);
            all[cell] += 1;
            kept[cell] += keeps;
            total += keeps;
        }
        EXPECT_NEAR(total, 1024, 5);
        double off = 0, offKept = 0;
        for (std::size_t cell = 0; cell < 16; ++cell) {
            off += std::pow(all[cell] - 1024, 2) / 16;
            offKept += std::pow(kept[cell] - 64, 2) / 16;
        }
        EXPECT_LT(std::sqrt(off), 8) << seed;
        EXPECT_LT(std::sqrt(offKept), 4) << seed;
    }
}

TEST(VplPlace, DoubleSidedEmittersShineFromBothSides) {
    RoomBuilder room;
    Material m;
    m.emission = {1, 1, 1};
    m.doubleSided = true;
    room.quad({1, 2, 1}, {3, 0, 0}, {0, 0, 1}, room.material(m));
    const Lit lit(room.finish());
    const ViewSet set = lit.trace(16000, 1);
    int up = 0;
    glm::dvec3 sum(0);
    for (std::uint32_t i = 0; i < 4000; ++i) {
        up += set.views[i].normalY > 0;
        sum += fluxOf(set.views[i]);
    }
    EXPECT_NEAR(up, 2000, 5 * std::sqrt(1000.0));
    EXPECT_NEAR(sum.x, 2 * 3.14159265 * 3, 1e-3);
    EXPECT_EQ(set.alive(), 4000u) << "what leaves a lone panel meets nothing";
}

TEST(VplPlace, BentNormalsStayOnTheSideTheRayCameFromAndLightStaysInside) {
    RoomBuilder room = lampRoom();
    Scene scene = room.finish();
    // Vertex normals that disagree with the walls by up to 80 degrees, some turned inside out.
    for (std::size_t i = 0; i < scene.normals.size(); ++i) {
        const vec4 r = random4(17, static_cast<uint>(i), 0, 0);
        const glm::vec3 bent = scene.normals[i] + 3.0f * (glm::vec3(r.x, r.y, r.z) - 0.5f);
        scene.normals[i] = glm::normalize(bent) * (r.w < 0.3f ? -1.0f : 1.0f);
    }
    const Lit lit(std::move(scene));
    const ViewSet set = lit.trace(8000, 8);
    EXPECT_EQ(set.alive(), 8000u) << "no path may leave a closed room";
    const glm::dvec3 low(lit.scene.root.rootFromWorld({0, 0, 0}));
    const glm::dvec3 high(lit.scene.root.rootFromWorld({4, 3, 5}));
    for (const View& v : set.views) {
        const glm::dvec3 p = positionOf(v), n = normalOf(v);
        // The wall it lies on is the nearest one.
        double nearest = 1;
        glm::dvec3 wall(0);
        for (int axis = 0; axis < 3; ++axis) {
            for (const double side : {1.0, -1.0}) {
                const double d = side > 0 ? p[axis] - low[axis] : high[axis] - p[axis];
                ASSERT_GT(d, 0) << "outside the room";
                if (d < nearest) {
                    nearest = d;
                    wall = glm::dvec3(0);
                    wall[axis] = side;
                }
            }
        }
        // In corners two walls are equally near.
        EXPECT_TRUE(nearest > 3e-5 || glm::dot(n, wall) >= -1e-5) << glm::dot(n, wall);
    }
}

TEST(VplPlace, TransparentMasksLetPathsThrough) {
    RoomBuilder room = whiteRoom(0.5f);
    Material glass;
    glass.baseTexture = room.texture(1, 1, {255, 255, 255, 0});
    glass.alphaCutoff = 0.5f;
    room.light(LightType::spot, {2, 1.5, 1}, {0, 0, 1}, {1, 1, 1}, 0.1, 0.2);
    room.quad({0, 0, 2}, {4, 0, 0}, {0, 3, 0}, room.material(glass));
    const Lit lit(room.finish());
    for (const View& v : lit.trace(500, 1).views) {
        const glm::dvec3 p = lit.scene.root.worldFromRoot(glm::vec3(positionOf(v)));
        EXPECT_NEAR(p.z, 5, 1e-3);
    }
}

// ---------------------------------------------------------------- identity

TEST(VplIdentity, IsTheSameForAnyNumberOfThreads) {
    const Lit lit(furnishedRoom(3, testing::everything));
    const ViewSet parallel = lit.trace(5000, 4);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const ViewSet serial = lit.trace(5000, 4);
    for (std::size_t i = 0; i < 5000; ++i) {
        ASSERT_TRUE(sameBytes(parallel.views[i], serial.views[i])) << i;
    }
}

TEST(VplIdentity, SeedsDiffer) {
    const Lit lit(lampRoom(0.5f).finish());
    const ViewSet a = lit.trace(100, 1, 0), b = lit.trace(100, 1, 1);
    int same = 0;
    for (std::size_t i = 0; i < 100; ++i) same += positionOf(a.views[i]) == positionOf(b.views[i]);
    EXPECT_EQ(same, 0);
}

TEST(VplIdentity, MorePathsKeepTheFirstInPlace) {
    const Lit lit(furnishedRoom(4, testing::point | testing::spot | testing::sun));
    const ViewSet few = lit.trace(400, 4), many = lit.trace(4000, 4);
    for (std::size_t i = 0; i < 400; ++i) {
        EXPECT_EQ(positionOf(few.views[i]), positionOf(many.views[i]));
        EXPECT_EQ(few.views[i].flags, many.views[i].flags);
    }
}

TEST(VplIdentity, ASmallMotionOfTheLightMovesMostVplsLittle) {
    const auto lit = [](double x) {
        RoomBuilder room = whiteRoom(0.7f);
        room.box({1, 0, 1}, {2, 1, 2}, 0);
        room.light(LightType::point, {1 + x, 1.6, 2.5}, {0, -1, 0}, {3, 2, 1});
        return room.finish();
    };
    const Lit before(lit(0)), after(lit(0.001));
    const ViewSet a = before.trace(4000, 4), b = after.trace(4000, 4);
    int near = 0;
    for (std::size_t i = 0; i < 4000; ++i) {
        near += glm::length(positionOf(a.views[i]) - positionOf(b.views[i])) < 0.01;
    }
    EXPECT_GT(near, 3800);
}

}  // namespace
}  // namespace mv
