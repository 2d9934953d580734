// Where cameras and lights are put when a file has none: inside rooms, outside objects, in the
// open, and never where the file already says.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "megaviews/scene/framing_probe.h"
#include "megaviews/scene/load_scene.h"
#include "scene/bvh_test_scene.h"
#include "scene/framing_scenes.h"

namespace mv {
namespace {

using builtin::MeshBuilder;
using builtin::Vec;
using test::addBall;
using test::addFloor;
using test::addLamp;
using test::addRoom;
using test::ball;
using test::extentInPicture;
using test::made;
using test::Placed;
using test::room;

TEST(Framing, RoomIsSeenFromInsideAlongItsLength) {
    for (double scale : {1.0, 0.01, 100.0, 3.0}) {
        SCOPED_TRACE(scale);
        Placed p(room(scale));
        ASSERT_EQ(p.scene.cameras.size(), 1u);
        EXPECT_TRUE(p.scene.cameras[0].isDefault);
        PosedCamera c = p.camera();
        Vec at = c.position / scale;
        EXPECT_LT(std::abs(at.x), 4.4);
        EXPECT_LT(std::abs(at.z), 2.4);
        EXPECT_GT(at.y, 0.5);
        EXPECT_LT(at.y, 2.2);
        if (scale == 1.0) {
            EXPECT_NEAR(at.y, 1.7, 0.05);
        }
        EXPECT_GT(std::abs(c.forward.x), 0.7) << "along the longer side";
        EXPECT_LT(c.forward.x * at.x, 0) << "away from the wall it stands at";
        EXPECT_NEAR(glm::dot(c.forward, c.up), 0, 1e-6);
        EXPECT_EQ(p.scene.notes.size(), 2u);
    }
}

TEST(Framing, LampHangsFreeInTheRoomAndGoesRoundInALoop) {
    Placed p(room());
    ASSERT_EQ(p.scene.lights.size(), 1u);
    const Light& lamp = p.scene.lights[0];
    EXPECT_EQ(lamp.type, LightType::point);
    EXPECT_TRUE(lamp.isDefault);
    EXPECT_GT(lamp.intensity.r, 0);
    ASSERT_EQ(p.scene.animations.size(), 1u);
    double duration = p.scene.animations[0].duration;
    double farthest = 0;
    Vec start = p.scene.lightsAt(0, 0)[0].position;
    for (int i = 0; i <= 20; ++i) {
        Vec at = p.scene.lightsAt(duration * i / 20 * (1 - 1e-9), 0)[0].position;
        EXPECT_TRUE(std::abs(at.x) < 4.3 && std::abs(at.z) < 2.3 && at.y > 0.9 && at.y < 2.8)
            << at.x << " " << at.y << " " << at.z;
        framing::FreePoint f = framing::probe(p.bvh, p.scene.root.rootFromWorld(at));
        EXPECT_GT(static_cast<double>(f.clearance) * p.scene.root.edge, 0.15);
        EXPECT_TRUE(framing::clear(p.bvh, p.scene.root.rootFromWorld(start),
                                   p.scene.root.rootFromWorld(at)));
        farthest = std::max(farthest, glm::length(at - start));
        if (i == 20) {
            EXPECT_LT(glm::length(at - start), 1e-3) << "the loop is closed";
        }
    }
    EXPECT_GT(farthest, 0.5) << "it visibly moves";
}

TEST(Framing, OpenCourtGetsABeamOfSunThatReachesItsFloor) {
    Placed p(room(4, false, 2.5));  // 36 x 20 m, 10 m high walls, no roof
    EXPECT_LT(p.camera().position.y, 6) << "still seen from inside";
    EXPECT_LT(std::abs(p.camera().position.x), 18);
    ASSERT_EQ(p.scene.lights.size(), 1u);
    EXPECT_EQ(p.scene.lights[0].type, LightType::spot);
    for (double t : {0.0, 10.0, 20.0, 30.0}) {
        glm::vec3 toSun(-p.scene.lightsAt(t, 0)[0].direction);
        EXPECT_GT(toSun.y, 0.4f);
        int lit = 0, all = 0;
        for (double x = -17; x < 17; x += 2)
            for (double z = -9; z < 9; z += 2, ++all)
                lit += !p.bvh.occluded(p.scene.root.rootFromWorld({x, 0.01, z}), toSun, 1e-5f, 4);
        EXPECT_GT(lit, all / 5) << "at " << t << " s";
    }
}

TEST(Framing, ObjectsAreSeenWholeFromOutside) {
    for (auto [centre, radius] :
         {std::pair{Vec(0), 1.0}, {Vec(1e5, -3e4, 7), 0.01}, {Vec(0, 40, 0), 300.0}}) {
        Placed p(ball(centre, radius));
        PosedCamera c = p.camera();
        EXPECT_GT(glm::length(c.position - centre), radius * 1.3);
        EXPECT_GT(c.position.y, centre.y) << "from a little above";
        auto [x, y] = extentInPicture(p.scene, c);
        EXPECT_LT(x, 0.99);
        EXPECT_LT(y, 0.99);
        EXPECT_GT(std::max(x, y), 0.75) << "and fills the picture";
        ASSERT_EQ(p.scene.lights.size(), 1u);
        EXPECT_EQ(p.scene.lights[0].type, LightType::directional);
        for (double t : {0.0, 7.0, 20.0, 33.0})
            EXPECT_GT(glm::dot(p.scene.lightsAt(t, 0)[0].direction, c.forward), 0.1)
                << "the sun stands on the viewer's side";
    }
}

TEST(Framing, ObjectsOfAnyShapeFit) {
    testing::Random random(9);
    for (int i = 0; i < 40; ++i) {
        Vec size(std::pow(10.0, random.uniform(-3, 1)), std::pow(10.0, random.uniform(-3, 1)),
                 std::pow(10.0, random.uniform(-3, 1)));
        if (i == 0) size = {1, 1, 0};
        Scene s;
        MeshBuilder mesh(s);
        mesh.use(mesh.addMaterial("white", glm::vec3(1)));
        if (i % 3 == 0)
            mesh.flat({0, 0, 0}, {size.x, 0, 0}, {0, size.y, size.z});
        else
            mesh.box(-size, size);
        mesh.finish();
        Placed p(std::move(s));
        auto [x, y] = extentInPicture(p.scene, p.camera());
        EXPECT_LT(std::max(x, y), 1.0) << i << ": " << size.x << " " << size.y << " " << size.z;
        EXPECT_GT(std::max(x, y), 0.4) << i << ": " << size.x << " " << size.y << " " << size.z;
    }
}

TEST(Framing, EmptySceneStillGetsACamera) {
    Scene s;
    s.materials.push_back({});
    Placed p(std::move(s));
    EXPECT_EQ(p.scene.cameras.size(), 1u);
    EXPECT_EQ(p.scene.lights.size(), 1u);
    EXPECT_TRUE(std::isfinite(p.camera().position.x));
    EXPECT_TRUE(std::isfinite(p.camera().forward.x));
}

TEST(Framing, WhatTheFileSaysStays) {
    Scene s = room();
    builtin::addCamera(s, "mine", {0, 1, 0}, {1, 1, 0}, 50);
    Light light;
    light.node = builtin::addNode(s, {0, 2, 0}, {0, 0, 0.1});
    s.lights.push_back(light);
    Placed p(std::move(s));
    EXPECT_EQ(p.scene.cameras.size(), 1u);
    EXPECT_EQ(p.scene.cameras[0].name, "mine");
    EXPECT_EQ(p.scene.lights.size(), 1u);
    EXPECT_TRUE(p.scene.notes.empty());
    EXPECT_TRUE(p.scene.animations.empty());
}

TEST(Framing, EmissiveSurfacesAreLightEnough) {
    Scene s = room();
    s.materials.push_back({.name = "unused glow", .emission = {5, 5, 5}});
    EXPECT_EQ(Placed(s).scene.lights.size(), 1u) << "nothing is made of it";
    s.triangleMaterials[3] = 1;
    EXPECT_TRUE(Placed(s).scene.lights.empty());
}

// A model with a glowing part is shown by daylight, a stage by its lamps.
TEST(Framing, WhatGlowsIsTheLightWhereItLightsMostOfTheScene) {
    const auto addLamp = [](MeshBuilder& mesh, Vec low, Vec high, float radiance) {
        mesh.use(mesh.addMaterial("lamp", glm::vec3(0), false, glm::vec3(radiance)));
        mesh.box(low, high);
    };
    Placed dial(made([&](MeshBuilder& mesh) {
        addBall(mesh, {0, 0, 0}, 1);
        addLamp(mesh, {-0.1, -0.1, 0.95}, {0.1, 0.1, 1.05}, 1);
    }));
    ASSERT_EQ(dial.scene.lights.size(), 1u) << "it lights nothing but the air before it";
    EXPECT_EQ(dial.scene.lights[0].type, LightType::directional);
    EXPECT_NE(dial.scene.notes.back().find("what glows lights little of it"), std::string::npos);

    const auto lightsOverFloor = [&](double height, float radiance) {
        Placed p(made([&](MeshBuilder& mesh) {
            addFloor(mesh, 4, 0);
            addLamp(mesh, {-1, height, -1}, {1, height + 0.1, 1}, radiance);
        }));
        return p.scene.lights.size();
    };
    EXPECT_EQ(lightsOverFloor(3, 10), 0u);
    EXPECT_EQ(lightsOverFloor(3, 0.1f), 1u) << "next to nothing";
    EXPECT_EQ(lightsOverFloor(-3, 10), 1u) << "behind the floor, which has one side";

    // A street at night: most of the houses is behind what its signs light.
    const auto lightsOfStreet = [&](const std::function<void(Scene&)>& addCamera) {
        Scene street = made([&](MeshBuilder& mesh) {
            addFloor(mesh, 4, 0);
            mesh.box({-4, 0, -16}, {4, 8, -4});
            addLamp(mesh, {-1, 3, -1}, {1, 3.1, 1}, 10);
        });
        addCamera(street);
        return Placed(std::move(street)).scene.lights.size();
    };
    EXPECT_EQ(lightsOfStreet([](Scene&) {}), 1u);
    const auto from = [](Vec eye, Vec target) {
        return [=](Scene& s) { builtin::addCamera(s, "mine", eye, target, 50); };
    };
    EXPECT_EQ(lightsOfStreet(from({0, 1.7, 6}, {0, 1.5, 0})), 0u) << "the file's camera sees signs";
    EXPECT_EQ(lightsOfStreet(from({0, 4, -30}, {0, 4, 0})), 1u) << "it sees dark backs";
}

TEST(Framing, ARoomThatLacksAWallIsSeenThroughIt) {
    for (bool doubleSided : {true, false}) {
        Scene s = room();
        // The wall at z = 2.5 is the fourth quad.
        s.triangles.erase(s.triangles.begin() + 6, s.triangles.begin() + 8);
        s.triangleMaterials.erase(s.triangleMaterials.begin() + 6, s.triangleMaterials.begin() + 8);
        s.materials[0].doubleSided = doubleSided;
        Placed p(std::move(s));
        const PosedCamera c = p.camera();
        EXPECT_GT(c.position.z, 2.6) << "before the opening";
        EXPECT_LT(c.forward.z, -0.99) << "level and straight into it";
        const auto [x, y] = extentInPicture(p.scene, c);
        EXPECT_LT(std::max(x, y), 0.99);
    }
}

// The model of a flat; an open court, whose walls are higher, is seen from inside (above).
TEST(Framing, RoomsWithoutARoofAreLookedIntoFromAbove) {
    for (const double scale : {1.0, 0.01}) {
        const Placed p(room(scale, false));
        const PosedCamera c = p.camera();
        EXPECT_GT(c.position.y, 3.0 * scale);
        EXPECT_LT(c.forward.y, -0.6) << "steeply down";
        const auto [x, y] = extentInPicture(p.scene, c);
        EXPECT_LT(std::max(x, y), 0.99);
        ASSERT_EQ(p.scene.lights.size(), 1u);
        EXPECT_EQ(p.scene.lights[0].type, LightType::directional) << "a sun as over objects";
    }
}

// A pagoda has rooms, but shows little there.
TEST(Framing, ATowerIsSeenFromOutside) {
    const Placed p(made([](MeshBuilder& mesh) {
        for (int storey = 0; storey < 4; ++storey) {
            const double low = 4 * storey;
            addRoom(mesh, {-4, low, -4}, {4, low + 3.6, 4});
            mesh.box({-4.2, low, -4.2}, {4.2, low + 3.7, 4.2});
            mesh.box({-6, low + 3.7, -6}, {6, low + 4, 6});
        }
    }));
    const PosedCamera c = p.camera();
    EXPECT_GT(glm::length(c.position), 20);
    const auto [x, y] = extentInPicture(p.scene, c);
    EXPECT_LT(std::max(x, y), 0.99);
    EXPECT_EQ(p.scene.lights.at(0).type, LightType::directional);
}

// A car: a cabin behind a band of windows, in which nobody fits, over what drives it.
TEST(Framing, AHollowThingIsSeenFromOutside) {
    const Placed p(made([](MeshBuilder& mesh) {
        constexpr double kTop = 1.2, kSill = 0.67, kWindow = 0.05;
        mesh.box({-0.75, 0, -0.45}, {0.75, 0.08, 0.45});
        mesh.box({-0.75, kTop - 0.08, -0.45}, {0.75, kTop, 0.45});
        const auto wall = [&](Vec a, Vec b) {  // but for its window
            mesh.box({a.x, 0.08, a.z}, {b.x, kSill, b.z});
            mesh.box({a.x, kSill + kWindow, a.z}, {b.x, kTop - 0.08, b.z});
        };
        for (const double z : {-0.45, 0.4}) {
            wall({-0.75, 0, z}, {0.75, 0, z + 0.05});
            for (int i = 0; i < 8; ++i) {
                const double x = -0.75 + 1.5 * (i + 0.5) / 8;
                mesh.box({x - 0.04, kSill, z}, {x + 0.04, kSill + kWindow, z + 0.05});
            }
        }
        for (const double x : {-0.75, 0.7}) wall({x, 0, -0.4}, {x + 0.05, 0, 0.4});
        for (int i = 0; i < 4; ++i) {
            const double y = 0.09 + 0.012 * i;
            mesh.box({-0.65, y, -0.38}, {0.65, y + 0.006, 0.38});
        }
    }));
    const PosedCamera c = p.camera();
    EXPECT_GT(glm::length(c.position), 1.5);
    EXPECT_EQ(p.scene.lights.at(0).type, LightType::directional);
}

TEST(Framing, TheSideIsShownThatTheFilesSunReaches) {
    for (const Vec to : {Vec(1, -0.5, 0), Vec(-1, -0.5, 0), Vec(0, -0.5, -1), Vec(0, -0.5, 1)}) {
        Scene s = made([](MeshBuilder& mesh) { mesh.box({-1, -1, -1}, {1, 1, 1}); });
        addLamp(s, LightType::directional, {0, 0, 0}, to, 3);
        EXPECT_LT(glm::dot(to, Placed(std::move(s)).camera().position), 0);
    }
}

TEST(Framing, TheLightFollowsTheRoomsWhoeverPlacedTheCamera) {
    const auto lightOf = [](Scene s) {
        builtin::addCamera(s, "mine", {-3, 1.5, 0}, {3, 1, 0}, 50);
        const Placed p(std::move(s));
        EXPECT_EQ(p.scene.cameras.size(), 1u);
        return p.scene.lights.at(0).type;
    };
    EXPECT_EQ(lightOf(room(1, false)), LightType::directional) << "a flat without a roof: a sun";
    EXPECT_EQ(lightOf(room(1, true)), LightType::point) << "a closed room: a lamp";
    EXPECT_EQ(lightOf(room(4, false, 2.5)), LightType::spot) << "a court: a beam";
}

TEST(Framing, WhatStandsOnAWideGroundFillsThePicture) {
    const auto onGround = [](Vec centre, double edge) {
        return made([&](MeshBuilder& mesh) {
            addBall(mesh, centre, 0.5);
            addFloor(mesh, edge, -0.5);
        });
    };
    const auto ballInPicture = [](const Placed& p) {
        const PosedCamera c = p.camera();
        return 0.5 / (glm::length(c.position) * std::tan(c.camera.yfovRad / 2));
    };
    EXPECT_GT(ballInPicture(Placed(onGround({0, 0, 0}, 50))), 0.5);
    EXPECT_LT(ballInPicture(Placed(onGround({0, 0, 0}, 1.4))), 0.5) << "the ground is shown, too";
    EXPECT_LT(ballInPicture(Placed(onGround({0, -1, 0}, 50))), 0.1) << "it hangs below the ground";
}

// A little stage before the walls of a studio, which rise high above it, its back towards +z.
TEST(Framing, WhatStandsBeforeABackdropFillsThePictureAndIsSeenAgainstIt) {
    const auto distanceAndSide = [](double wallAt, double facing) {
        const Placed p(made([&](MeshBuilder& mesh) {
            addFloor(mesh, 40, 0);
            mesh.box({-1, 0, 0.9}, {1, 1.5, 1});
            mesh.box({-1, 0, -1}, {1, 0.1, 0.9});
            addBall(mesh, {0, 0.6, 0}, 0.4);
            const Vec a(-40 * facing, 0, wallAt), b(40 * facing, 0, wallAt), up(0, 40, 0);
            mesh.quad(a, b, b + up, a + up);
        }));
        const Vec at = p.camera().position;
        return std::pair{glm::length(at), at.z};
    };
    const auto [near, side] = distanceAndSide(40, -1);
    EXPECT_LT(near, 12);
    EXPECT_LT(side, 0) << "the wall is behind it";
    EXPECT_GT(distanceAndSide(40, 1).first, 40)
        << "the wall faces away: it is the back of something";
    EXPECT_GT(distanceAndSide(3, -1).first, 40) << "the ground goes on behind the wall";
}

// Files of others have crumbs far from all else, which the root cube reaches to.
TEST(Framing, AStrayTriangleFarAwayIsLeftOutOfThePicture) {
    const auto crumb = [](MeshBuilder& mesh, double away, double size) {
        mesh.flat({away, 0, 0}, {away + size, 0, 0}, {away, size, 0});
    };
    const auto ballInPicture = [&](double away, double size) {
        Placed p(made([&](MeshBuilder& mesh) {
            addBall(mesh, {0, 0, 0}, 1);
            crumb(mesh, away, size);
        }));
        const PosedCamera c = p.camera();
        return 1 / (glm::length(c.position) * std::tan(c.camera.yfovRad / 2));
    };
    for (double away : {15.0, 100.0, 3000.0}) {
        EXPECT_GT(ballInPicture(away, 0.01), 0.75) << away << " radii away";
    }
    EXPECT_LT(ballInPicture(15, 3), 0.3) << "it is large enough to be meant";
    EXPECT_LT(ballInPicture(3, 0.01), 0.75) << "a picture has room for it";

    Placed inRoom(made([&](MeshBuilder& mesh) {
        addRoom(mesh, {0, 0, 0}, {8, 3, 5});
        crumb(mesh, 60, 0.01);
    }));
    const Vec from = inRoom.camera().position;
    EXPECT_TRUE(glm::all(glm::greaterThan(from, Vec(0)))) << from.x << " " << from.y;
    EXPECT_TRUE(glm::all(glm::lessThan(from, Vec(8, 3, 5)))) << from.x << " " << from.y;
}

TEST(Framing, LightRestsWhereTheFileMovesByItself) {
    Scene s = room();
    s.nodes.push_back({});
    AnimationChannel channel{.node = 0, .times = {0, 1}, .values = {glm::dvec4(0), glm::dvec4(1)}};
    s.animations.push_back({.name = "mine", .duration = 1, .channels = {channel}});
    Placed p(std::move(s));
    ASSERT_EQ(p.scene.lights.size(), 1u);
    ASSERT_EQ(p.scene.animations.size(), 1u);
    EXPECT_EQ(p.scene.animations[0].channels.size(), 1u);
    EXPECT_EQ(p.scene.lightsAt(0, 0)[0].position, p.scene.lightsAt(0.5, 0)[0].position);
}

TEST(Framing, TwoPlacementsAreTheSame) {
    Placed a(room()), b(room());
    EXPECT_EQ(a.camera().position, b.camera().position);
    EXPECT_EQ(a.scene.lightsAt(0, 0)[0].position, b.scene.lightsAt(0, 0)[0].position);
}

// The real ones: stands inside Sponza's court on the ground floor, outside of the bunny.
std::string sceneFile(const std::string& name) {
    const char* folder = std::getenv("MEGAVIEWS_SCENES");
    std::string root = folder ? folder : MEGAVIEWS_SOURCE_DIR "/../shared/scenes";
    return root + "/" + name;
}

TEST(Framing, SponzaIsSeenFromItsCourt) {
    std::string file = sceneFile("sponza/sponza.glb");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    Placed p(loadScene(file));
    PosedCamera c = p.camera();
    EXPECT_LT(std::abs(c.position.x), 12);
    EXPECT_LT(std::abs(c.position.z), 3.5);
    EXPECT_NEAR(c.position.y, 1.7, 0.3);
    EXPECT_GT(std::abs(c.forward.x), 0.8);
    EXPECT_EQ(p.scene.lights.at(0).type, LightType::spot);
}

TEST(Framing, BunnyIsSeenFromOutside) {
    std::string file = sceneFile("stanford-bunny/stanford-bunny.glb");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    Placed p(loadScene(file));
    auto [x, y] = extentInPicture(p.scene, p.camera());
    EXPECT_LT(std::max(x, y), 1);
    EXPECT_GT(std::max(x, y), 0.75);
}

}  // namespace
}  // namespace mv
