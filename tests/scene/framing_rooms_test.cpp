// Rooms within walls that are thick: seen from within where light gets to, and lit there.

#include <gtest/gtest.h>

#include "megaviews/scene/framing_probe.h"
#include "scene/framing_scenes.h"

namespace mv {
namespace {

using builtin::MeshBuilder;
using builtin::Vec;
using test::addLamp;
using test::addRoom;
using test::made;
using test::Placed;

// Two closed rooms with walls as thick as walls are: most of the surface is outside.
Scene twoRooms(bool glows = false) {
    return made([&](MeshBuilder& mesh) {
        mesh.box({-4.2, -0.3, -2.2}, {4.2, 3.3, 2.2});
        addRoom(mesh, {-4, 0, -2}, {-0.1, 3, 2});
        addRoom(mesh, {0.1, 0, -2}, {4, 3, 2});
        if (!glows) return;
        mesh.use(mesh.addMaterial("lamp", glm::vec3(0), false, glm::vec3(5)));
        mesh.box({2, 2.8, -0.2}, {2.4, 2.9, 0.2});
    });
}

// What a file's camera stands in is a room, whatever the file has outside of it.
TEST(Framing, ARoomThatTheFilesCameraStandsInIsLitFromWithin) {
    const auto lightsFor = [](Vec from, bool glows) {
        Scene s = twoRooms(glows);
        builtin::addCamera(s, "mine", from, {3, 1, 0}, 50);
        return Placed(std::move(s)).scene.lights;
    };
    EXPECT_TRUE(lightsFor({1, 1.5, 0}, true).empty()) << "its lamp is the light";
    const std::vector<Light> hung = lightsFor({1, 1.5, 0}, false);
    ASSERT_EQ(hung.size(), 1u);
    EXPECT_EQ(hung[0].type, LightType::point) << "no sun gets in";
    const std::vector<Light> around = lightsFor({12, 5, 9}, true);
    ASSERT_EQ(around.size(), 1u);
    EXPECT_EQ(around[0].type, LightType::directional) << "a block, from outside";
}

TEST(Framing, ARoomIsSeenWhoseLampsAreTheLight) {
    for (const double bright : {-2.0, 2.0}) {
        Scene s = twoRooms();
        addLamp(s, LightType::point, {bright, 2, 0}, {bright, 0, 0}, 50);
        addLamp(s, LightType::point, {-bright, 2, 0}, {-bright, 0, 0}, 0.01f);
        const Vec at = Placed(std::move(s)).camera().position;
        EXPECT_LT(std::abs(at.x - bright), 2) << "in the bright room";
        EXPECT_LT(std::abs(at.z), 2);
        EXPECT_GT(at.y, 0);
        EXPECT_LT(at.y, 3);
    }
    const auto outside = [](Scene s) {
        return glm::length(Placed(std::move(s)).camera().position);
    };
    EXPECT_GT(outside(twoRooms()), 6) << "a block";
    Scene lit = twoRooms();
    addLamp(lit, LightType::point, {2, 2, 0}, {2, 0, 0}, 50);
    addLamp(lit, LightType::point, {0, 6, 0}, {0, 0, 0}, 50);
    EXPECT_GT(outside(std::move(lit)), 6) << "a lamp hangs over it";
}

// A building of one room, 6 x 2.8 x 5 m times `scale`, with walls of 20 cm and two windows in the
// one at z = 0: more of its surface is outside than within.
void addBuilding(MeshBuilder& mesh, double scale = 1) {
    const auto box = [&](Vec low, Vec high) { mesh.box(low * scale, high * scale); };
    box({-0.2, -0.2, -0.2}, {6.2, 0, 5.2});
    box({-0.2, 2.8, -0.2}, {6.2, 3, 5.2});
    box({-0.2, 0, 5}, {6.2, 2.8, 5.2});
    box({-0.2, 0, -0.2}, {0, 2.8, 5});
    box({6, 0, -0.2}, {6.2, 2.8, 5});
    for (const auto& [from, to] : {std::pair{0.0, 1.0}, {2.5, 3.5}, {5.0, 6.0}}) {
        box({from, 0, -0.2}, {to, 2.8, 0});
    }
    for (const double window : {1.0, 3.5}) {
        box({window, 0, -0.2}, {window + 1.5, 0.9, 0});
        box({window, 2.3, -0.2}, {window + 1.5, 2.8, 0});
    }
    box({2, 0.7, 1.8}, {4, 0.75, 3});
}

bool isIn(const Placed& p, Vec low, Vec high) {
    const Vec at = p.camera().position;
    return glm::all(glm::greaterThan(at, low)) && glm::all(glm::lessThan(at, high));
}

TEST(Framing, ARoomWithinThickWallsIsSeenFromWithin) {
    const auto isInside = [](const Placed& p, double scale = 1) {
        return isIn(p, {0, 0, 0}, Vec(6, 2.8, 5) * scale);
    };
    const Placed plain(made([](MeshBuilder& mesh) { addBuilding(mesh); }));
    EXPECT_TRUE(isInside(plain));
    ASSERT_EQ(plain.scene.lights.size(), 1u);
    EXPECT_NE(plain.scene.lights[0].type, LightType::directional) << "light is placed for the room";

    for (const double scale : {0.2, 60.0}) {
        const Placed p(made([&](MeshBuilder& mesh) { addBuilding(mesh, scale); }));
        EXPECT_FALSE(isInside(p, scale)) << "nobody could stand in a chest: " << scale;
    }
    const Placed inYard(made([](MeshBuilder& mesh) {
        addBuilding(mesh);
        addFloor(mesh, 25, -0.2);
    }));
    EXPECT_FALSE(isInside(inYard)) << "it is a small part of what there is";
}

// A room between machinery, beside a yard without a roof: as roomy as it is, it has little place to
// stand in.
TEST(Framing, AHollowAmongMachineryIsNoRoom) {
    const auto hasRoom = [](bool cluttered) {
        const Scene scene = made([&](MeshBuilder& mesh) {
            addBuilding(mesh);
            mesh.box({6.2, -0.2, -0.2}, {11, 0, 10.2});
            mesh.box({10.8, 0, -0.2}, {11, 2.8, 10.2});
            mesh.box({6.2, 0, -0.2}, {10.8, 2.8, 0});
            mesh.box({6.2, 0, 10}, {10.8, 2.8, 10.2});
            mesh.box({6, 0, 5.2}, {6.2, 2.8, 10.2});
            for (int i = 0; cluttered && i < 11; ++i) {
                mesh.box({0.4 * i, 0, 0}, {0.4 * i + 0.2, 0.5, 5});
            }
        });
        const TriangleBvh bvh = TriangleBvh::build(scene);
        framing::Surroundings s = framing::survey(bvh);
        return framing::hasRoomWithWindows(bvh, s);
    };
    EXPECT_TRUE(hasRoom(false));
    EXPECT_FALSE(hasRoom(true));
}

TEST(Framing, ARoomInWhichOnlyADialGlowsGetsALamp) {
    const auto lightsOf = [](double edge, float radiance) {
        return Placed(made([&](MeshBuilder& mesh) {
                   addRoom(mesh, {-4, 0, -2}, {4, 3, 2});
                   mesh.use(mesh.addMaterial("dial", glm::vec3(0), false, glm::vec3(radiance)));
                   mesh.box({2, 1, 0}, {2 + edge, 1 + edge, edge});
               }))
            .scene.lights.size();
    };
    EXPECT_EQ(lightsOf(0.01, 1), 1u);
    EXPECT_EQ(lightsOf(0.02, 30), 0u) << "a candle";
    EXPECT_EQ(lightsOf(0.5, 0.5f), 0u) << "a screen";
}

// A room of 5 x 2.7 x 4 m whose one window is in the wall at z = 0.
TEST(Framing, TheSunShinesThroughTheOneWindowOfARoom) {
    const Vec low(1.7, 0.9, 0), high(3.3, 2.2, 0);  // of the window
    Placed p(made([&](MeshBuilder& mesh) {
        mesh.box({-0.1, -0.1, -0.1}, {5.1, 0, 4.1});
        mesh.box({-0.1, 2.7, -0.1}, {5.1, 2.8, 4.1});
        mesh.box({-0.1, 0, 4}, {5.1, 2.7, 4.1});
        mesh.box({-0.1, 0, -0.1}, {0, 2.7, 4});
        mesh.box({5, 0, -0.1}, {5.1, 2.7, 4});
        mesh.box({0, 0, -0.1}, {low.x, 2.7, 0});
        mesh.box({high.x, 0, -0.1}, {5, 2.7, 0});
        mesh.box({low.x, 0, -0.1}, {high.x, low.y, 0});
        mesh.box({low.x, high.y, -0.1}, {high.x, 2.7, 0});
    }));
    ASSERT_EQ(p.scene.lights.size(), 1u);
    EXPECT_EQ(p.scene.lights[0].type, LightType::spot);
    const PosedLight sun = p.scene.lightsAt(0, p.animation()).at(0);
    EXPECT_LT(sun.position.z, 0);
    // Its edge is the window's, not that of the cone, but for what the wall's thickness hides.
    const Vec middle = 0.5 * (low + high), half = 0.85 * (high - low) / 2.0;
    for (const Vec corner : {Vec(-1, -1, 0), Vec(1, -1, 0), Vec(-1, 1, 0), Vec(1, 1, 0)}) {
        const Vec way = glm::normalize(middle + corner * half - sun.position);
        EXPECT_GT(glm::dot(way, sun.direction), std::cos(sun.light.innerConeRad))
            << corner.x << ", " << corner.y;
    }
}

TEST(Framing, ARoomThatTheFilesLightDoesNotReachIsSeenFromOutside) {
    const auto isInside = [](Vec to) {
        Scene s = made([](MeshBuilder& mesh) { addBuilding(mesh); });
        addLamp(s, LightType::directional, {0, 0, 0}, to, 1000);
        return isIn(Placed(std::move(s)), {0, 0, 0}, {6, 2.8, 5});
    };
    EXPECT_TRUE(isInside({-1, -0.5, 1})) << "through the windows";
    EXPECT_FALSE(isInside({0, -0.5, -1})) << "the sun is behind the house";

    const auto isInsideWithGlow = [](double z) {
        return isIn(Placed(made([&](MeshBuilder& mesh) {
                        addBuilding(mesh);
                        mesh.use(mesh.addMaterial("sign", glm::vec3(0), false, glm::vec3(5)));
                        mesh.box({1, 1, z}, {2, 2, z + 0.1});
                    })),
                    {0, 0, 0}, {6, 2.8, 5});
    };
    EXPECT_TRUE(isInsideWithGlow(-1)) << "before a window";
    EXPECT_FALSE(isInsideWithGlow(6)) << "behind the house";
}

// A terrace is roomier, but has no roof.
TEST(Framing, ARoomBesideAWalledYardIsSeenFromUnderItsRoof) {
    const Placed p(made([](MeshBuilder& mesh) {
        mesh.box({-0.2, -0.2, -0.2}, {8.2, 0, 13.2});
        mesh.box({-0.2, 2.8, -0.2}, {8.2, 3, 5});
        mesh.box({-0.2, 0, -0.2}, {8.2, 2.8, 0});
        mesh.box({-0.2, 0, 13}, {8.2, 2.8, 13.2});
        for (const double x : {-0.2, 8.0}) mesh.box({x, 0, 0}, {x + 0.2, 2.8, 13});
        mesh.box({0, 0, 4.8}, {3, 2.8, 5});
        mesh.box({6, 0, 4.8}, {8, 2.8, 5});
    }));
    EXPECT_TRUE(isIn(p, {0, 0, 0}, {8, 2.8, 5})) << p.camera().position.z;
}

}  // namespace
}  // namespace mv
