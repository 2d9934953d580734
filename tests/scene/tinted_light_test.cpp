// What is clear keeps some of the light that passes it: once a pane, once a body.

#include <gtest/gtest.h>

#include "megaviews/scene/closed_surfaces.h"
#include "megaviews/scene/triangle_bvh.h"
#include "views/rooms.h"

namespace mv {
namespace {

using testing::RoomBuilder;

const glm::vec3 kColour(0.81f, 0.25f, 0.04f);

Material glass() {
    Material m;
    m.baseColor = glm::vec4(kColour, 1);
    m.transmission = 1;
    return m;
}

struct Tinted {
    explicit Tinted(RoomBuilder& room)
        : scene(room.finish()), bvh(TriangleBvh::build(scene)), data(bvh.data(true)) {}
    // From one place in the world to another.
    glm::vec3 passed(glm::dvec3 from, glm::dvec3 to) const {
        const glm::vec3 a = scene.root.rootFromWorld(from), b = scene.root.rootFromWorld(to);
        return bvhPassed(data, a, b - a, 0, 1);
    }
    Scene scene;
    TriangleBvh bvh;
    BvhData data;
};

void expectNear(glm::vec3 value, glm::vec3 expected) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(value[i], expected[i], 1e-6f) << i;
}

TEST(TintedLight, APaneAndABodyTintOnce) {
    RoomBuilder room;
    room.quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, room.material(glass()));
    room.box({2, 1, 0}, {3, 2, 1}, room.material(glass()));
    room.quad({4, 1, 0}, {1, 0, 0}, {0, 0, 1}, room.material(glm::vec3(1)));
    const Tinted tinted(room);
    EXPECT_EQ(closedMaterials(tinted.scene), (std::vector<bool>{false, true, false}));
    for (const bool up : {false, true}) {
        const auto along = [&](double x) {
            const glm::dvec3 below(x, 0, 0.3), above(x, 3, 0.3);
            return up ? tinted.passed(below, above) : tinted.passed(above, below);
        };
        expectNear(along(0.4), kColour);
        expectNear(along(2.4), kColour);
        expectNear(along(3.5), glm::vec3(1));
        expectNear(along(4.4), glm::vec3(0));
    }
    // From inside the body: half of it.
    expectNear(tinted.passed({2.4, 1.5, 0.3}, {2.4, 3, 0.3}), glm::sqrt(kColour));
    // Through all that stands in a row.
    expectNear(tinted.passed({-1, 0.9, 0.3}, {3.9, 1.292, 0.3}), kColour * kColour);
}

TEST(TintedLight, LambertMaterialsLetAllThrough) {
    RoomBuilder room;
    room.quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, room.material(glass()));
    const Tinted tinted(room);
    const glm::vec3 below = tinted.scene.root.rootFromWorld({0.4, 0, 0.3});
    const glm::vec3 above = tinted.scene.root.rootFromWorld({0.4, 2, 0.3});
    expectNear(bvhPassed(tinted.bvh.data(false), below, above - below, 0, 1), glm::vec3(1));
}

TEST(TintedLight, WhatBlendsCoversByItsAlphaAndGlossKeepsItsShare) {
    RoomBuilder room;
    Material veil;
    veil.blends = true;
    veil.alphaCutoff = 0.5f;
    veil.baseColor = {1, 0, 0, 0.25f};
    room.quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, room.material(veil));
    Material glossy = glass();
    glossy.specular = 0.04f;
    const int varnished = room.material(glossy);
    room.quad({2, 1, 0}, {1, 0, 0}, {0, 0, 1}, varnished);
    // Glass that is there by a third: the rest of the light passes beside it.
    Material part = glass();
    part.blends = true;
    part.baseColor.a = 1.0f / 3;
    room.quad({4, 1, 0}, {1, 0, 0}, {0, 0, 1}, room.material(part));
    Material filled = glass();
    filled.thickness = 2;
    filled.absorption = {0, 0.5f, 1};
    room.box({6, 1, 0}, {7, 2, 1}, room.material(filled));
    const Tinted tinted(room);
    const auto along = [&](double x) { return tinted.passed({x, 0, 0.3}, {x, 3, 0.3}); };
    expectNear(along(0.4), glm::vec3(0.75f));
    const float layer = tinted.bvh.materials[static_cast<std::size_t>(varnished)].layer;
    EXPECT_GT(layer, 0.01f);
    expectNear(along(2.4), kColour * (1 - layer));
    expectNear(along(4.4), (kColour + 2.0f) / 3.0f);
    expectNear(along(6.4), kColour * glm::exp(glm::vec3(0, -1, -2)));
}

// Large triangles stand in many leaves of the hierarchy; a ray that meets several of them is tinted
// once all the same.
TEST(TintedLight, OnceWhereverTheHierarchyHoldsIt) {
    RoomBuilder room;
    const int pane = room.material(glass()), stone = room.material(glm::vec3(1));
    room.quad({-10, 1, -10}, {20, 0.3, 0.1}, {0, 0.2, 20}, pane);
    for (int i = 0; i < 400; ++i) {
        const double x = i % 20 - 10, z = i / 20 - 10;
        room.quad({x, 0, z}, {0.1, 0, 0}, {0, 0, 0.1}, stone);
    }
    const Tinted tinted(room);
    for (int i = 0; i < 400; ++i) {
        const double x = i % 20 - 9.5, z = i / 20 - 9.5;
        expectNear(tinted.passed({x, 0.1, z}, {x + 0.3, 3, z - 0.2}), kColour);
    }
}

}  // namespace
}  // namespace mv
