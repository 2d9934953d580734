// What moves: node animation, skins, morph targets; lights and cameras at any time.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "megaviews/scene/framing.h"
#include "megaviews/scene/load_scene.h"
#include "megaviews/scene/pose.h"
#include "megaviews/scene/rigged_scene.h"
#include "megaviews/scene/triangle_bvh.h"
#include "scene/gltf_builder.h"

namespace mv {
namespace {

using testing::GltfBuilder;
using testing::Json;

// Adds an animation of one channel.
void animate(GltfBuilder& b, int node, const std::string& path, const std::vector<float>& times,
             const std::vector<float>& values, const std::string& interpolation = "LINEAR",
             const std::string& name = "") {
    const std::size_t width = path == "rotation" ? 4 : path == "weights" ? 1 : 3;
    const char* type = width == 4 ? "VEC4" : width == 1 ? "SCALAR" : "VEC3";
    const int input = b.accessor(times, testing::kFloat, "SCALAR", times.size());
    const int output = b.accessor(values, testing::kFloat, type, values.size() / width);
    Json entry = {
        {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
        {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}};
    if (!name.empty()) entry["name"] = name;
    b.add("animations", entry);
}

GltfBuilder squareWithCamera() {
    GltfBuilder b = GltfBuilder::square();
    b.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
    b.node({{"camera", 0}, {"name", "eye"}});
    return b;
}

glm::dvec3 cameraAt(const Scene& scene, double time, int animation = 0) {
    return scene.camerasAt(time, animation).at(0).position;
}

// Each object may have brought an animation of its own.
TEST(GltfAnimation, ThoseThatMoveOtherThingsArePlayedTogether) {
    GltfBuilder b = squareWithCamera();
    animate(b, 1, "translation", {0, 2}, {0, 0, 0, 4, 0, 0}, "LINEAR", "slide");
    animate(b, 0, "translation", {0, 1}, {0, 0, 0, 0, 1, 0}, "LINEAR", "lift");
    {
        const Scene scene = testing::loadJson(b);
        ASSERT_EQ(scene.animations.size(), 3u);
        EXPECT_EQ(scene.animations[2].name, "all");
        EXPECT_EQ(scene.animations[2].duration, 2);
        EXPECT_EQ(findAnimation(scene, ""), 2);
        EXPECT_EQ(findAnimation(scene, "slide"), 0);
        EXPECT_NEAR(cameraAt(scene, 1, 2).x, 2, 1e-9);
        EXPECT_TRUE(scene.moving);  // "lift", too
    }
    animate(b, 1, "rotation", {0, 1}, {0, 0, 0, 1, 0, 1, 0, 0}, "LINEAR", "turn");
    EXPECT_EQ(testing::loadJson(b).animations.size(), 4u);  // another property of the same node
    animate(b, 1, "translation", {0, 1}, {0, 0, 0, 0, 0, 1}, "LINEAR", "back");
    const Scene rival = testing::loadJson(b);
    EXPECT_EQ(rival.animations.size(), 4u);
    EXPECT_EQ(findAnimation(rival, ""), 0);
}

TEST(GltfAnimation, APlacedCameraSeesWhereThingsWillMove) {
    GltfBuilder b = GltfBuilder::square();
    animate(b, 0, "translation", {0, 1}, {0, 0, 0, 0, 9, 0});
    Scene first = testing::loadJson(b);
    const TriangleBvh bvh = TriangleBvh::build(first);
    placeDefaults(first, bvh);
    const PosedCamera camera = first.camerasAt(0, 0).at(0);
    for (const double time : {0.0, 0.5, 0.999}) {
        LoadOptions options;
        options.timeS = time;
        const Scene then = testing::loadJson(b, options);
        for (const glm::vec3 position : then.positions) {
            const glm::dvec3 to = then.root.worldFromRoot(position) - camera.position;
            const double depth = glm::dot(to, camera.forward);
            ASSERT_GT(depth, 0);
            EXPECT_LT(std::abs(glm::dot(to, camera.up)),
                      depth * std::tan(camera.camera.yfovRad / 2))
                << time;
        }
    }
}

// Fragments that fly far away leave the picture; it is of what they were.
TEST(GltfAnimation, APlacedCameraStaysWithWhatFliesAway) {
    GltfBuilder b = GltfBuilder::square();
    animate(b, 0, "translation", {0, 1}, {0, 0, 0, 0, 90, 0});
    Scene scene = testing::loadJson(b);
    placeDefaults(scene, TriangleBvh::build(scene));
    const PosedCamera camera = scene.camerasAt(0, 0).at(0);
    for (const glm::vec3 position : scene.positions) {
        EXPECT_LT(glm::length(scene.root.worldFromRoot(position) - camera.position), 9);
    }
}

TEST(GltfAnimation, TwoKeysOfOneTimeAreAJump) {
    GltfBuilder b = squareWithCamera();
    animate(b, 0, "translation", {0, 1, 1, 2}, {0, 0, 0, 1, 0, 0, 5, 0, 0, 6, 0, 0});
    const Scene scene = testing::loadJson(b);
    EXPECT_TRUE(scene.warnings.empty());
    const auto xAt = [&](double time) {
        LoadOptions options;
        options.timeS = time;
        const Scene then = testing::loadJson(b, options);
        return then.root.worldFromRoot(then.positions.at(0)).x;
    };
    const double first = xAt(0);
    EXPECT_NEAR(xAt(0.5) - first, 0.5, 1e-5);
    EXPECT_NEAR(xAt(0.999) - first, 0.999, 1e-4);
    EXPECT_NEAR(xAt(1.001) - first, 5.001, 1e-4);
    EXPECT_NEAR(xAt(1.5) - first, 5.5, 1e-5);
}

TEST(GltfAnimation, StepLinearAndCubicSpline) {
    GltfBuilder b = squareWithCamera();
    const std::vector<float> times = {1, 2, 4};
    const std::vector<float> values = {0, 0, 0, 10, 0, 0, 10, 20, 0};
    animate(b, 1, "translation", times, values, "STEP");
    animate(b, 1, "translation", times, values, "LINEAR");
    // In-tangent, value, out-tangent: at rest at each key but for an upward start.
    animate(b, 1, "translation", {0, 2}, {0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 8, 0, 0, 0, 0, 0},
            "CUBICSPLINE");
    const Scene scene = testing::loadJson(b);
    ASSERT_EQ(scene.animations.size(), 3u);
    EXPECT_EQ(scene.animations[0].duration, 4);
    EXPECT_TRUE(scene.animated());
    EXPECT_FALSE(scene.moving);

    const auto expectAt = [&](int animation, double time, glm::dvec3 expected) {
        EXPECT_NEAR(glm::length(cameraAt(scene, time, animation) - expected), 0, 1e-9)
            << "animation " << animation << " at " << time;
    };
    expectAt(0, 0, {0, 0, 0});
    expectAt(0, 1.99, {0, 0, 0});
    expectAt(0, 2, {10, 0, 0});
    expectAt(0, 3.9, {10, 0, 0});
    expectAt(1, 0.5, {0, 0, 0});  // before the first key
    expectAt(1, 1.25, {2.5, 0, 0});
    expectAt(1, 3, {10, 10, 0});
    expectAt(1, 4 + 1.25, {2.5, 0, 0});  // loops
    expectAt(1, 1.25 - 8, {2.5, 0, 0});
    // Half-way: mean of the values, and an eighth of the interval times the tangent.
    expectAt(2, 1, {4, 2.0 / 8 * 3, 0});
    expectAt(2, 0, {0, 0, 0});
    expectAt(-1, 3, {0, 0, 0});  // none
    expectAt(7, 3, {0, 0, 0});
}

TEST(GltfAnimation, RotationTakesTheShortWayAndMovesChildren) {
    GltfBuilder b = squareWithCamera();
    b.json["nodes"][1]["translation"] = {0, 0, 2};
    const int arm = b.add("nodes", {{"children", {1}}});
    b.json["scenes"][0]["nodes"] = {0, arm};
    const float h = std::sqrt(0.5f);
    // A quarter turn about y, its quaternion given with the other sign.
    animate(b, arm, "rotation", {0, 1}, {0, 0, 0, 1, 0, -h, 0, -h});
    const Scene scene = testing::loadJson(b);
    const double e = std::numbers::pi / 8;
    const PosedCamera half = scene.camerasAt(0.25, 0)[0];
    EXPECT_NEAR(glm::length(half.position - 2.0 * glm::dvec3(std::sin(e), 0, std::cos(e))), 0,
                1e-6);
    EXPECT_NEAR(glm::length(half.forward + glm::dvec3(std::sin(e), 0, std::cos(e))), 0, 1e-6);
    EXPECT_NEAR(glm::length(half.up - glm::dvec3(0, 1, 0)), 0, 1e-9);
}

TEST(GltfAnimation, QuantisedRotations) {
    GltfBuilder b = squareWithCamera();
    animate(b, 1, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, 0, 1});
    // A quarter turn about y: -z to -x.
    b.json["animations"][0]["samplers"][0]["output"] =
        b.accessor(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 23170, 0, 23170}, testing::kShort,
                   "VEC4", 2, true);
    const Scene scene = testing::loadJson(b);
    const glm::dvec3 forward = scene.camerasAt(0.999999999, 0)[0].forward;
    EXPECT_NEAR(glm::length(forward - glm::dvec3(-1, 0, 0)), 0, 1e-6);
}

TEST(GltfAnimation, GeometryStandsInThePoseOfTheTime) {
    GltfBuilder b = GltfBuilder::square();
    animate(b, 0, "translation", {0, 2}, {0, 0, 0, 6, 0, 0}, "LINEAR", "slide");
    animate(b, 0, "scale", {0, 1}, {1, 1, 1, 3, 3, 3}, "LINEAR", "grow");
    const auto loadAt = [&](double time, const std::string& animation) {
        LoadOptions options;
        options.timeS = time;
        options.animation = animation;
        const Scene scene = testing::loadJson(b, options);
        EXPECT_EQ(testing::inconsistency(scene), "");
        EXPECT_FALSE(scene.animated());  // only lights and cameras move
        return scene;
    };
    EXPECT_NEAR(testing::worldBox(loadAt(1, "")).first.x, 3, 1e-6);
    EXPECT_NEAR(testing::worldBox(loadAt(1, "slide")).first.x, 3, 1e-6);
    EXPECT_NEAR(testing::worldBox(loadAt(1, "none")).first.x, 0, 1e-6);
    EXPECT_NEAR(testing::worldBox(loadAt(0.5, "grow")).second.x, 2, 1e-6);
    EXPECT_NEAR(testing::worldBox(loadAt(0.5, "1")).second.x, 2, 1e-6);
    EXPECT_NE(loadAt(1, "").contentHash, loadAt(0.5, "").contentHash);
    EXPECT_EQ(loadAt(1, "none").contentHash, loadAt(0.5, "none").contentHash);
    LoadOptions wrong;
    wrong.animation = "jump";
    try {
        testing::loadJson(b, wrong);
        FAIL() << "loaded";
    } catch (const Error& e) {
        EXPECT_EQ(e.code, ExitCode::usage);
        EXPECT_NE(std::string(e.what()).find("slide"), std::string::npos);
    }
}

// Of two things shown in turn trees are built with both.
TEST(GltfAnimation, TreesHoldWhatHasNoSizeWhileTheRestIsLargest) {
    GltfBuilder b;
    const auto triangle = b.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    b.primitive({{"POSITION", triangle}});
    const int other = b.add("nodes", {{"mesh", 0}, {"translation", {3, 0, 0}}});
    b.json["scenes"][0]["nodes"].push_back(other);
    animate(b, 0, "scale", {0, 1, 2}, {2, 2, 2, 0, 0, 0, 0, 0, 0}, "STEP");
    animate(b, other, "scale", {0, 1, 2}, {0, 0, 0, 1, 1, 1, 1, 1, 1}, "STEP");
    Json& channels = b.json["animations"][0];
    channels["samplers"].push_back(b.json["animations"][1]["samplers"][0]);
    channels["channels"].push_back(b.json["animations"][1]["channels"][0]);
    channels["channels"][1]["sampler"] = 1;
    b.json["animations"].erase(1);
    Scene scene = testing::loadJson(b);
    ASSERT_TRUE(scene.moving);
    const auto area = [&](std::size_t t) {
        const glm::uvec3 c = scene.triangles[t];
        const glm::dvec3 a = scene.root.worldFromRoot(scene.positions[c.x]);
        return 0.5 * glm::length(glm::cross(scene.root.worldFromRoot(scene.positions[c.y]) - a,
                                            scene.root.worldFromRoot(scene.positions[c.z]) - a));
    };
    ASSERT_EQ(scene.triangles.size(), 2u);
    poseScene(scene, 0.5);
    EXPECT_NEAR(area(0), 2, 1e-5);
    EXPECT_NEAR(area(1), 0, 1e-9);
    poseForTrees(scene);
    EXPECT_NEAR(area(0), 2, 1e-5);
    EXPECT_NEAR(area(1), 0.5, 1e-5);
    poseScene(scene, 0.5);
    EXPECT_NEAR(area(1), 0, 1e-9) << "and every pose comes back";
}

// Without normals each triangle has vertices of its own; they stay in their order, so that textures
// and motion vectors do, where an animation turns it inside out. Its winding follows.
TEST(GltfAnimation, VerticesKeepTheirOrderWhereThingsTurnInsideOut) {
    GltfBuilder b;
    b.primitive({{"POSITION", b.positions({{1, 0, 0}, {2, 0, 0}, {1, 1, 0}})}});
    animate(b, 0, "scale", {0, 2}, {1, 1, 1, -1, 1, 1});
    Scene scene = testing::loadJson(b);
    ASSERT_TRUE(scene.moving);
    const auto world = [&](std::size_t i) { return scene.root.worldFromRoot(scene.positions[i]); };
    const std::vector<glm::dvec3> before = {world(0), world(1), world(2)};
    const std::vector<glm::uvec3> triangles = scene.triangles;
    poseScene(scene, 1.5);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(world(i).x, -0.5 * before[i].x, 1e-5) << i;
        EXPECT_NEAR(world(i).y, before[i].y, 1e-5) << i;
    }
    EXPECT_EQ(scene.triangles, (std::vector{glm::uvec3(0, 2, 1)}));
    poseScene(scene, 0);
    EXPECT_EQ(scene.triangles, triangles);
}

// What has no place in a pose is drawn together, not to a corner of the scene.
TEST(GltfAnimation, WhatHasNoPlaceIsNotDrawn) {
    GltfBuilder b;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    b.primitive({{"POSITION", b.positions({{4, 4, 4}, {5, 4, 4}, {nan, 5, 4}})}});
    b.primitive({{"POSITION", b.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})}});
    animate(b, 0, "translation", {0, 2}, {0, 0, 0, 1, 0, 0});
    Scene scene = testing::loadJson(b);
    for (const double time : {0.0, 1.0}) {
        poseScene(scene, time);
        double area = 0;
        for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
            area += glm::length(testing::areaVector(scene, t));
        }
        EXPECT_NEAR(area, 0.5, 1e-5) << time;
    }
}

TEST(GltfAnimation, NamesAndNumbers) {
    Scene scene;
    EXPECT_EQ(findAnimation(scene, ""), -1);
    EXPECT_EQ(findCamera(scene, ""), -1);
    scene.animations.resize(3);
    scene.animations[0].name = "walk";
    scene.animations[1].name = "0";
    scene.animations[2].name = "none of these";
    scene.cameras.resize(2);
    scene.cameras[1].name = "door";
    EXPECT_EQ(findAnimation(scene, ""), 0);
    EXPECT_EQ(findAnimation(scene, "walk"), 0);
    EXPECT_EQ(findAnimation(scene, "0"), 1);  // names before numbers
    EXPECT_EQ(findAnimation(scene, "2"), 2);
    EXPECT_EQ(findAnimation(scene, "none"), -1);
    EXPECT_EQ(findCamera(scene, "door"), 1);
    EXPECT_EQ(findCamera(scene, "1"), 1);
    for (const char* wrong : {"3", "-1", "1x", " 1", "walk "}) {
        EXPECT_THROW(findAnimation(scene, wrong), Error) << wrong;
    }
    EXPECT_THROW(findCamera(scene, "none"), Error);
}

TEST(GltfMorph, WeightsOfMeshNodeAndAnimation) {
    GltfBuilder b;
    Json& primitive = b.primitive({{"POSITION", b.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})}});
    const int up = b.positions({{0, 0, 0}, {0, 0, 0}, {0, 4, 0}});
    const int right = b.positions({{0, 0, 0}, {2, 0, 0}, {0, 0, 0}});
    primitive["targets"] = {{{"POSITION", up}}, {{"POSITION", right}}};
    const auto top = [&](const LoadOptions& options = {}) {
        return testing::worldBox(testing::loadJson(b, options)).second;
    };
    EXPECT_NEAR(top().y, 1, 1e-6);
    b.json["meshes"][0]["weights"] = {0.5, 0};
    EXPECT_NEAR(top().y, 3, 1e-6);
    b.json["nodes"][0]["weights"] = {0.25, 1};
    EXPECT_NEAR(top().y, 2, 1e-6);
    EXPECT_NEAR(top().x, 3, 1e-6);
    // Two keys of two weights each.
    animate(b, 0, "weights", {0, 2}, {0, 0, 1, 0.5}, "LINEAR");
    animate(b, 0, "weights", {0, 2}, {0, 0, 0, 0, 0, 0, 0, 0, 1, 0.5, 0, 0}, "CUBICSPLINE");
    LoadOptions options;
    options.timeS = 1;
    EXPECT_NEAR(top(options).y, 3, 1e-6);
    EXPECT_NEAR(top(options).x, 1.5, 1e-6);
    options.animation = "1";
    EXPECT_NEAR(top(options).y, 3, 1e-6);  // half-way between keys at rest
    EXPECT_TRUE(testing::loadJson(b, options).moving);
}

TEST(GltfMorph, NormalsMoveToo) {
    GltfBuilder b;
    const int normal = b.positions(std::vector<glm::vec3>(3, {0, 0, 1}));
    Json& primitive = b.primitive(
        {{"POSITION", b.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})}, {"NORMAL", normal}});
    primitive["targets"] = {{{"NORMAL", b.positions(std::vector<glm::vec3>(3, {1, 0, 0}))}}};
    b.json["nodes"][0]["weights"] = {1};
    const Scene scene = testing::loadJson(b);
    EXPECT_NEAR(scene.normals[0].x, std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(scene.normals[0].z, std::sqrt(0.5), 1e-6);
}

// A bar of three vertices: one on joint 0, one on joint 1, one half and half.
GltfBuilder skinnedBar(bool normalizedWeights = false) {
    GltfBuilder b;
    const int position = b.positions({{0, 0, 0}, {0, 2, 0}, {1, 2, 0}});
    const int joints = b.accessor(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0},
                                  testing::kUnsignedByte, "VEC4", 3);
    const int weights = normalizedWeights
                            ? b.accessor(std::vector<std::uint16_t>{65535, 0, 0, 0, 65535, 0, 0, 0,
                                                                    32768, 32767, 0, 0},
                                         testing::kUnsignedShort, "VEC4", 3, true)
                            // The last one's weights add up to 4: they are brought to 1.
                            : b.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 2, 2, 0, 0},
                                         testing::kFloat, "VEC4", 3);
    b.primitive({{"POSITION", position}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}});
    // Joint 1 binds at height 1.
    std::vector<float> bind(32, 0.0f);
    for (std::size_t m = 0; m < 2; ++m) {
        for (std::size_t i = 0; i < 4; ++i) bind[16 * m + 5 * i] = 1;
    }
    bind[16 + 13] = -1;
    const int inverse = b.accessor(bind, testing::kFloat, "MAT4", 2);
    const int tip = b.add("nodes", {{"translation", {0, 1, 0}}});
    const int root = b.node({{"children", {tip}}}).is_object() ? tip + 1 : -1;
    b.add("skins", {{"joints", {root, tip}}, {"inverseBindMatrices", inverse}});
    b.json["nodes"][0]["skin"] = 0;
    return b;
}

TEST(GltfSkin, RestsInItsBindPoseAndFollowsItsJoints) {
    for (const bool normalized : {false, true}) {
        GltfBuilder b = skinnedBar(normalized);
        b.json["nodes"][0]["translation"] = {100, 100, 100};  // skins ignore the mesh's own node
        Scene scene = testing::loadJson(b);
        EXPECT_EQ(testing::inconsistency(scene), "");
        EXPECT_NEAR(glm::length(testing::corner(scene, 0, 2) - glm::dvec3(1, 2, 0)), 0, 1e-5);

        // The tip moves by 3 along z: its vertex wholly, the shared one half as far.
        b.json["nodes"][1]["translation"] = {0, 1, 3};
        scene = testing::loadJson(b);
        EXPECT_NEAR(glm::length(testing::corner(scene, 0, 0) - glm::dvec3(0, 0, 0)), 0, 1e-5);
        EXPECT_NEAR(glm::length(testing::corner(scene, 0, 1) - glm::dvec3(0, 2, 3)), 0, 1e-5);
        EXPECT_NEAR(glm::length(testing::corner(scene, 0, 2) - glm::dvec3(1, 2, 1.5)), 0, 2e-4);
    }
}

TEST(GltfSkin, IsPosedByAnimation) {
    GltfBuilder b = skinnedBar();
    const float h = std::sqrt(0.5f);
    animate(b, 1, "rotation", {0, 1, 2}, {0, 0, 0, 1, 0, 0, h, h, 0, 0, 0, 1});
    LoadOptions options;
    options.timeS = 1;
    const Scene scene = testing::loadJson(b, options);
    // The tip turns a quarter about z at height 1: (0, 2) goes to (-1, 1).
    EXPECT_NEAR(glm::length(testing::corner(scene, 0, 1) - glm::dvec3(-1, 1, 0)), 0, 1e-5);
    EXPECT_TRUE(scene.moving);
}

TEST(GltfSkin, MirroredJointsTurnTrianglesOver) {
    GltfBuilder b = skinnedBar();
    const double before = testing::areaVector(testing::loadJson(b), 0).z;
    b.json["nodes"][2]["scale"] = {-1, 1, 1};
    const double after = testing::areaVector(testing::loadJson(b), 0).z;
    EXPECT_LT(before, 0);
    EXPECT_NEAR(after, before, 1e-5);  // mirrored in x and turned over: the same side still shows
}

TEST(GltfSkin, JointOutOfRangeIsRefused) {
    GltfBuilder b = skinnedBar();
    b.json["skins"][0]["joints"] = {2};
    const testing::TemporaryFolder folder;
    const std::string error = testing::inputError(folder.write("a.gltf", b.gltfText()));
    EXPECT_NE(error.find("meshes[0]"), std::string::npos) << error;
    EXPECT_NE(error.find("joint 1"), std::string::npos) << error;
}

TEST(GltfSkin, ZeroWeightsHangOnTheFirstJoint) {
    GltfBuilder b = skinnedBar();
    b.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
        b.accessor(std::vector<float>(12, 0.0f), testing::kFloat, "VEC4", 3);
    const Scene scene = testing::loadJson(b);
    EXPECT_EQ(testing::inconsistency(scene), "");
    EXPECT_NEAR(glm::length(testing::corner(scene, 0, 1) - glm::dvec3(0, 2, 0)), 0, 1e-5);
}

TEST(GltfLights, TypesConesAndPoses) {
    GltfBuilder b = GltfBuilder::square();
    b.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"name", "lamp"}, {"intensity", 20}, {"color", {1, 0.5, 0.25}}},
        {{"type", "spot"}, {"spot", Json::object()}},
        {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.5}}}},
        {{"type", "directional"}, {"intensity", 3}},
        {{"type", "point"}, {"intensity", 0}},
        {{"type", "spot"}}};
    b.json["extensionsUsed"] = {"KHR_lights_punctual"};
    const float h = std::sqrt(0.5f);
    for (int i = 0; i < 6; ++i) {
        Json& node = b.node({{"translation", {i, 0, 0}}, {"name", "n" + std::to_string(i)}});
        node["extensions"]["KHR_lights_punctual"]["light"] = i;
        if (i == 3) node["rotation"] = {-h, 0, 0, h};  // -z to -y
        if (i == 1) node["scale"] = {7, 7, 7};         // says nothing about a light
    }
    const Scene scene = testing::loadJson(b);
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(scene.lights.size(), 5u);  // the one of no intensity is off
    EXPECT_EQ(scene.lights[0].name, "lamp");
    EXPECT_EQ(scene.lights[1].name, "n1");
    EXPECT_EQ(scene.lights[0].intensity, glm::vec3(20, 10, 5));
    EXPECT_EQ(scene.lights[1].type, LightType::spot);
    for (const std::size_t i : {1u, 4u}) {
        EXPECT_NEAR(scene.lights[i].innerConeRad, 0, 1e-12);
        EXPECT_NEAR(scene.lights[i].outerConeRad, std::numbers::pi / 4, 1e-12);
    }
    EXPECT_NEAR(scene.lights[2].innerConeRad, 0.2, 1e-12);
    EXPECT_NEAR(scene.lights[2].outerConeRad, 0.5, 1e-12);
    EXPECT_EQ(scene.lights[3].type, LightType::directional);
    const std::vector<PosedLight> posed = scene.lightsAt(0, -1);
    EXPECT_EQ(posed[2].position, glm::dvec3(2, 0, 0));
    EXPECT_NEAR(glm::length(posed[2].direction - glm::dvec3(0, 0, -1)), 0, 1e-9);
    EXPECT_NEAR(glm::length(posed[1].direction - glm::dvec3(0, 0, -1)), 0, 1e-9);
    EXPECT_NEAR(glm::length(posed[3].direction - glm::dvec3(0, -1, 0)), 0, 1e-6);
    EXPECT_FALSE(scene.animated());
}

TEST(GltfLights, OnlyThoseOfTheSceneShine) {
    GltfBuilder b = GltfBuilder::square();
    b.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    for (int i = 0; i < 2; ++i) {
        b.add("nodes", Json::object());
        b.json["nodes"].back()["extensions"]["KHR_lights_punctual"]["light"] = 0;
    }
    b.json["scenes"][0]["nodes"].push_back(2);
    EXPECT_EQ(testing::loadJson(b).lights.size(), 1u);
}

TEST(GltfCameras, PerspectiveAndOrthographic) {
    GltfBuilder b = squareWithCamera();
    b.add("cameras", {{"type", "orthographic"},
                      {"name", "plan"},
                      {"orthographic", {{"xmag", 4}, {"ymag", 3}, {"znear", 0}, {"zfar", 10}}}});
    b.node({{"camera", 1}, {"translation", {1, 2, 3}}, {"scale", {-1, 0, 2}}});
    const Scene scene = testing::loadJson(b);
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].name, "eye");
    EXPECT_NEAR(scene.cameras[0].yfovRad, 0.7, 1e-12);
    EXPECT_FALSE(scene.cameras[0].orthoHalfHeight);
    EXPECT_EQ(scene.cameras[1].name, "plan");
    EXPECT_EQ(scene.cameras[1].orthoHalfHeight, 3);
    EXPECT_EQ(testing::inconsistency(scene), "");  // axes are unit and orthogonal all the same
    EXPECT_EQ(cameraAt(scene, 0), glm::dvec3(0));
    EXPECT_EQ(scene.camerasAt(0, 0)[1].position, glm::dvec3(1, 2, 3));
}

TEST(GltfCameras, OnlyTheirNodesAreKept) {
    GltfBuilder b = squareWithCamera();
    for (int i = 0; i < 10; ++i) b.node({{"mesh", 0}});
    const int parent = b.add("nodes", {{"children", {1}}, {"translation", {0, 5, 0}}});
    b.json["scenes"][0]["nodes"] = {0, parent};
    const Scene scene = testing::loadJson(b);
    EXPECT_EQ(scene.nodes.size(), 2u);
    EXPECT_EQ(cameraAt(scene, 0), glm::dvec3(0, 5, 0));
}

TEST(Pose, KeysAtTheirEndsAndBetween) {
    const std::vector<double> times = {1, 2, 4};
    EXPECT_EQ(findKeys(times, 0).from, 0u);
    EXPECT_EQ(findKeys(times, 0).to, 0u);
    EXPECT_EQ(findKeys(times, 1).u, 0);
    EXPECT_EQ(findKeys(times, 3).from, 1u);
    EXPECT_EQ(findKeys(times, 3).to, 2u);
    EXPECT_EQ(findKeys(times, 3).u, 0.5);
    EXPECT_EQ(findKeys(times, 4).from, 2u);
    EXPECT_EQ(findKeys(times, 9).to, 2u);
    const std::vector<double> one = {5};
    EXPECT_EQ(findKeys(one, 9).from, 0u);
    for (const double time : {-7.5, -0.0, 0.0, 0.5, 2.999, 3.0, 1e9}) {
        EXPECT_GE(loopTime(time, 3), 0) << time;
        EXPECT_LT(loopTime(time, 3), 3) << time;
    }
    EXPECT_EQ(loopTime(5, 0), 0);
    EXPECT_EQ(loopTime(std::nan(""), 3), 0);
}

}  // namespace
}  // namespace mv
