// What shines, how much, and how paths are shared out among it.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "megaviews/core/error.h"
#include "views/rooms.h"

namespace mv {
namespace {

using testing::Lit;
using testing::RoomBuilder;
using testing::whiteRoom;

void expectFlux(glm::dvec3 expected, glm::dvec3 actual, double relative) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(actual[i], expected[i], relative * expected[i]);
}

TEST(Emitters, PunctualLightsSendTheFluxOfTheirType) {
    RoomBuilder room = whiteRoom();
    room.light(LightType::point, {1, 1, 1}, {0, -1, 0}, {1, 2, 3});
    room.light(LightType::spot, {2, 2, 2}, {0, -1, 0}, {3, 2, 1}, 0.2, 0.5);
    room.light(LightType::directional, {0, 0, 0}, {1, -1, 0}, {5, 6, 7});
    const Lit lit(room.finish(), 2.0);
    ASSERT_EQ(lit.emitters.lights.size(), 3u);
    const auto flux = [&](std::size_t i) {
        const LightRecord& r = lit.emitters.lights[i];
        return glm::dvec3(r.fluxR, r.fluxG, r.fluxB);
    };
    expectFlux(2.0 * 4 * std::numbers::pi * glm::dvec3(1, 2, 3), flux(0), 1e-6);
    const double ci = std::cos(0.2), co = std::cos(0.5);
    expectFlux(2.0 * 2 * std::numbers::pi * (1 - ci + (ci - co) / 3) * glm::dvec3(3, 2, 1), flux(1),
               1e-5);
    // The disc across the bounding sphere of 4 x 3 x 5 m.
    expectFlux(2.0 * std::numbers::pi * (16 + 9 + 25) / 4.0 * glm::dvec3(5, 6, 7), flux(2), 1e-5);
    EXPECT_EQ(lit.emitters.lights[1].intensityR, 6.0f);
    EXPECT_NEAR(lit.emitters.lights[2].directionX, std::sqrt(0.5), 1e-6);
    const glm::vec3 place = lit.scene.root.rootFromWorld({1, 1, 1});
    EXPECT_EQ(lit.emitters.lights[0].positionY, place.y);
}

TEST(Emitters, SurfacesSendPiTimesAreaTimesRadianceFromEverySide) {
    RoomBuilder room = whiteRoom();
    Material twoSided;
    twoSided.emission = {1, 2, 4};
    twoSided.doubleSided = true;
    Material unlit;
    unlit.baseColor = {0.5f, 0.25f, 1, 1};
    unlit.unlit = true;
    room.quad({1, 1, 1}, {0.5, 0, 0}, {0, 0, 2}, room.material(glm::vec3(1), {3, 2, 1}));
    room.quad({1, 2, 1}, {0.5, 0, 0}, {0, 0, 2}, room.material(twoSided));
    room.quad({3, 2, 1}, {0.5, 0, 0}, {0, 0, 2}, room.material(unlit));
    const Lit lit(room.finish(), 3.0);
    EXPECT_EQ(lit.emitters.emissiveCount(), 6u);
    const glm::dvec3 radiance =
        glm::dvec3(3, 2, 1) + 2.0 * glm::dvec3(1, 2, 4) + glm::dvec3(0.5, 0.25, 1);
    expectFlux(3.0 * std::numbers::pi * radiance, lit.emitters.fluxW(), 1e-5);
}

TEST(Emitters, ATexturedSurfaceSendsTheMeanOfItsTexture) {
    RoomBuilder room = whiteRoom();
    Material lamp;
    lamp.emission = {2, 2, 2};
    // 32 x 32 texels, a quarter of them white, black along every border: interpolation keeps the
    // mean, and the whole quad is one repeat.
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < 32 * 32; ++i) {
        const bool white = i % 32 >= 8 && i % 32 < 24 && i / 32 >= 8 && i / 32 < 24;
        const std::uint8_t c = white ? 255 : 0;
        rgba.insert(rgba.end(), {c, c, c, 255});
    }
    lamp.emissiveTexture = room.texture(32, 32, rgba);
    room.quad({1, 1, 1}, {1, 0, 0}, {0, 0, 1}, room.material(lamp));
    const Lit lit(room.finish());
    expectFlux(glm::dvec3(std::numbers::pi * 2 / 4), lit.emitters.fluxW(), 0.03);
    EXPECT_EQ(lit.emitters.emissiveCount(), 2u);
}

// A tube in an eighth of a mask; a spot in a texture that repeats; a dial in a dark wall: whatever
// shines has a share, however little of a triangle it is. What cannot shine has none.
TEST(Emitters, WhatShinesInPlacesHasItsShare) {
    const auto texture = [](int size, auto&& isLit, bool inAlpha) {
        std::vector<std::uint8_t> rgba;
        for (int i = 0; i < size * size; ++i) {
            const auto c = static_cast<std::uint8_t>(isLit(i % size, i / size) ? 255 : 0);
            const auto colour = inAlpha ? std::uint8_t{255} : c;
            rgba.insert(rgba.end(), {colour, colour, colour, inAlpha ? c : std::uint8_t{255}});
        }
        return rgba;
    };
    const auto flux = [&](int repeats, int size, auto&& isLit, bool inAlpha) {
        RoomBuilder room = whiteRoom();
        Material lamp;
        lamp.emission = {1, 1, 1};
        const int image = room.texture(size, size, texture(size, isLit, inAlpha));
        (inAlpha ? lamp.baseTexture : lamp.emissiveTexture) = image;
        lamp.alphaCutoff = inAlpha ? 0.5f : 0;
        room.quad({1, 1, 1}, {1, 0, 0}, {0, 0, 1}, room.material(lamp));
        Scene scene = room.finish();
        for (std::size_t i = scene.uvs.size() - 4; i < scene.uvs.size(); ++i) {
            scene.uvs[i] *= repeats;
        }
        scene.emissiveUvs = scene.uvs;
        const Lit lit(std::move(scene));
        return std::pair(lit.emitters.fluxW().x / std::numbers::pi, lit.emitters.emissiveCount());
    };
    const auto tube = [](int, int y) { return y >= 28 && y < 36; };
    const auto spot = [](int x, int y) { return x >= 3 && x < 5 && y >= 3 && y < 5; };
    const auto expectShare = [](const auto& found, double share) {
        EXPECT_NEAR(found.first, share, 0.15 * share);
        EXPECT_EQ(found.second, 2u);
    };
    expectShare(flux(1, 64, tube, true), 0.125);
    expectShare(flux(64, 8, spot, false), 1.0 / 16);
    const auto dial = flux(
        1, 256, [](int x, int y) { return x == 200 && y == 30; }, false);
    EXPECT_GT(dial.first, 0);
    EXPECT_LT(dial.first, 0.001);
    EXPECT_GE(dial.second, 1u);
    EXPECT_EQ(flux(
                  1, 256, [](int, int) { return false; }, false)
                  .second,
              0u);
}

TEST(Emitters, SharesAreExactMultiplesThatEndAtOne) {
    RoomBuilder room = whiteRoom();
    room.light(LightType::point, {1, 1, 1}, {0, -1, 0}, {1e-12f, 0, 0});  // hardly anything
    room.light(LightType::point, {1, 1, 1}, {0, -1, 0}, {0, 0, 0});       // nothing
    room.light(LightType::point, {1, 1, 1}, {0, -1, 0}, {1, 1, 1});
    room.light(LightType::point, {1, 1, 1}, {0, -1, 0}, {3, 3, 3});
    room.light(LightType::spot, {1, 1, 1}, {0, -1, 0}, {3, 3, 3}, 0, 0);  // no cone
    const Lit lit(room.finish());
    const std::vector<LightRecord>& lights = lit.emitters.lights;
    EXPECT_EQ(lights[0].cumulative, 1.0f / 16777216.0f);
    EXPECT_EQ(lights[1].cumulative, lights[0].cumulative);
    EXPECT_NEAR(lights[2].cumulative, 0.25, 1e-6);
    EXPECT_EQ(lights[3].cumulative, 1.0f);
    EXPECT_EQ(lights[4].cumulative, 1.0f);
    for (const LightRecord& r : lights) {
        EXPECT_EQ(r.cumulative * 16777216.0f, std::floor(r.cumulative * 16777216.0f));
    }
}

TEST(Emitters, EmissiveTrianglesShareByPowerInTheScenesOrder) {
    RoomBuilder room = whiteRoom();
    const int strong = room.material(glm::vec3(1), {8, 8, 8});
    const int weak = room.material(glm::vec3(1), {1, 1, 1});
    for (int i = 0; i < 5; ++i) {
        room.quad({0.5 * i, 1, 1}, {0.1, 0, 0}, {0, 0, 0.1 * (i + 1)}, i % 2 ? weak : strong);
    }
    const Lit lit(room.finish());
    const auto& triangles = lit.emitters.surfaces->triangles;
    ASSERT_EQ(triangles.size(), 10u);
    EXPECT_EQ(triangles.back().cumulative, 1.0f);
    double before = 0, total = 8 * (1 + 3 + 5) + 2 + 4;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const std::size_t quad = i / 2;
        const double power = static_cast<double>(quad + 1) * (quad % 2 ? 1 : 8) / 2;
        EXPECT_NEAR(triangles[i].probability, power / total, 1e-6) << i;
        EXPECT_EQ(static_cast<double>(triangles[i].cumulative) - before,
                  static_cast<double>(triangles[i].probability));
        before = static_cast<double>(triangles[i].cumulative);
        EXPECT_NEAR(triangles[i].areaM2, 0.005 * static_cast<double>(quad + 1), 1e-6);
        if (i > 0) {
            EXPECT_LT(lit.bvh.triangles[triangles[i - 1].bvhSlot].triangle,
                      lit.bvh.triangles[triangles[i].bvhSlot].triangle);
        }
    }
}

TEST(Emitters, NothingShinesInAnEmptyOrUnlitScene) {
    const Lit dark(whiteRoom().finish());
    EXPECT_TRUE(dark.emitters.empty());
    const Lit nothing{RoomBuilder().finish()};
    EXPECT_TRUE(nothing.emitters.empty());
    RoomBuilder room = whiteRoom();
    room.light(LightType::point, {1, 1, 1}, {0, -1, 0}, {1, 1, 1});
    const Scene scene = room.finish();
    const TriangleBvh bvh = TriangleBvh::build(scene);
    EXPECT_FALSE(makeEmitters(scene, bvh, {}).empty());
    EXPECT_TRUE(makeEmitters(scene, bvh, {.scale = 0}).empty());
}

TEST(Emitters, LightsArePlacedElsewhere) {
    RoomBuilder room = whiteRoom();
    room.light(LightType::spot, {1, 1, 1}, {0, -1, 0}, {1, 2, 3});
    room.light(LightType::point, {0.5, 1, 1}, {0, -1, 0}, {1, 1, 1});
    const Lit lit(room.finish());
    const auto with = [&](const std::vector<LightPlacement>& placements) {
        return makeEmitters(lit.scene, lit.bvh, {.placements = placements});
    };
    const Emitters placed =
        with({{0, {{0.5, 1.5, 0.25}}, {{0, 0, -3}}, {}, {}}, {1, {}, {{1, 0, 0}}, {}, {}}});
    const glm::vec3 expected = lit.scene.root.rootFromWorld({0.5, 1.5, 0.25});
    const LightRecord& spot = placed.lights[0];
    EXPECT_EQ(glm::vec3(spot.positionX, spot.positionY, spot.positionZ), expected);
    EXPECT_EQ(glm::vec3(spot.directionX, spot.directionY, spot.directionZ), glm::vec3(0, 0, -1));
    EXPECT_EQ(spot.fluxR, lit.emitters.lights[0].fluxR);
    EXPECT_EQ(placed.lights[1].positionX, lit.emitters.lights[1].positionX);
    EXPECT_EQ(placed.lights[1].directionX, 1.0f);
    EXPECT_THROW(with({{2, {{0, 0, 0}}, {}, {}, {}}}), Error);

    // Of another colour, with another cone, and out: fluxes follow.
    const Emitters changed =
        with({{0, {}, {}, {{4, 0, 0}}, {{30, 60}}}, {1, {}, {}, {{0, 0, 0}}, {}}});
    const double whole = 2 * 3.14159265358979 * (1 - std::cos(3.14159265358979 / 3));
    EXPECT_LT(changed.lights[0].fluxR, 4 * whole);
    EXPECT_GT(changed.lights[0].fluxR, 2 * whole);
    EXPECT_EQ(changed.lights[0].fluxG, 0);
    EXPECT_NEAR(changed.lights[0].cosOuter, 0.5f, 1e-6f);
    EXPECT_EQ(changed.lights[1].fluxR, 0);
    EXPECT_FALSE(changed.empty());
    EXPECT_TRUE(with({{0, {}, {}, {{0, 0, 0}}, {}}, {1, {}, {}, {{0, 0, 0}}, {}}}).empty());
}

}  // namespace
}  // namespace mv
