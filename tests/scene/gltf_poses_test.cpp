// What an animation moves, posed again and again: where it stands by numbers that gltf_poses.py
// worked out from the specification, and the same bytes as a file loaded at that time.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "megaviews/scene/rigged_scene.h"
#include "scene/gltf_builder.h"

namespace mv {
namespace {

using testing::GltfBuilder;
using testing::Json;

struct Stands {
    const char* file;
    int animation;
    double timeS;
    glm::dvec3 min, max, center;  // of all triangles; the last by area
};

// gltf_poses.py FILE TIME --animation N
const std::vector<Stands> kStands = {
    {"AnimatedMorphCube/AnimatedMorphCube.gltf",
     0,
     0.5,
     {-1, -1, -1},
     {1, 1, 0.560891},
     {-2.86015e-08, -3.82915e-08, -0.219554}},
    {"AnimatedMorphCube/AnimatedMorphCube.gltf",
     0,
     2.3,
     {-1, -1, -1},
     {1, 1, -0.067831},
     {-9.6442e-09, -0.187275, -0.702851}},
    {"AnimatedTriangle/AnimatedTriangle.gltf",
     0,
     0.4,
     {-0.809017, -0.809017, 0},
     {0, 0.587785, 0},
     {-0.465601, -0.0737439, 0}},
    {"BoxAnimated/BoxAnimated.glb",
     0,
     0.4,
     {-0.5, -0.5, -0.5},
     {0.5, 1.3064, 0.5},
     {2.34266e-07, 0.234446, 0.0028265}},
    {"BoxAnimated/BoxAnimated.glb",
     0,
     1.6,
     {-0.5, -0.5, -0.596907},
     {0.5, 3.09495, 0.596907},
     {2.34266e-07, 0.768353, 0.0116846}},
    {"BoxAnimated/BoxAnimated.glb",
     0,
     3.1,
     {-0.5, -0.5, -0.5},
     {0.5, 1.76869, 0.5},
     {2.34266e-07, 0.354656, -0.00286571}},
    {"CesiumMan/CesiumMan.glb",
     0,
     0.3,
     {-0.303091, 0.0151248, -0.217439},
     {0.18943, 1.51976, 0.198421},
     {-0.0259164, 0.839044, 0.0193836}},
    {"CesiumMan/CesiumMan.glb",
     0,
     1.27,
     {-0.235529, 0.0115279, -0.236269},
     {0.188363, 1.49627, 0.231149},
     {-0.033652, 0.832406, 0.0294374}},
    {"Fox/Fox.glb",
     0,
     0.8,
     {-11.5947, -0.130795, -84.269},
     {17.5429, 76.7527, 67.0715},
     {1.25243, 39.7641, -5.85974}},
    {"Fox/Fox.glb",
     0,
     2.9,
     {-24.1746, -0.130854, -82.8029},
     {11.5939, 79.2292, 67.9684},
     {-2.19307, 39.6929, -5.69965}},
    {"Fox/Fox.glb",
     2,
     0.45,
     {-13.2525, 0.295344, -94.5286},
     {13.8985, 72.7892, 69.8946},
     {0.0297266, 43.7958, -6.91156}},
    {"InterpolationTest/InterpolationTest.glb",
     2,
     0.5,
     {-4.38678, -2.15946, -1},
     {4.34834, 7.95891, 1.00367},
     {-0.266378, 3.50394, 0.0304579}},
    {"InterpolationTest/InterpolationTest.glb",
     4,
     1.3,
     {-4.38678, -2.15946, -1},
     {4.74831, 7.95891, 1.00894},
     {0.00810769, 3.23726, 0.0288206}},
    {"InterpolationTest/InterpolationTest.glb",
     7,
     0.7,
     {-4.38678, -2.15946, -1},
     {4.34834, 7.96666, 1.00894},
     {0.00810769, 3.26237, 0.0288206}},
    {"SimpleMorph/SimpleMorph.gltf", 0, 2.2, {0, 0, 0}, {1, 2.3, 0}, {0.433333, 0.766667, 0}},
    {"SimpleSkin/SimpleSkin.gltf",
     0,
     0.7,
     {-1.118, 0, 0},
     {0.543108, 1.8993, 0},
     {-0.1575, 0.903452, 0}},
    {"SimpleSkin/SimpleSkin.gltf", 0, 2.6, {-0.5, 0, 0}, {0.5, 2, 0}, {0, 1, 0}},
    {"VC/VC.glb",
     0,
     3.7,
     {-83.1387, -1.25691, -83.1387},
     {83.1387, 96.9437, 85.9927},
     {-0.0471191, 36.3651, 0.25819}},
};

glm::dvec3 centerOfArea(const Scene& scene) {
    glm::dvec3 sum(0);
    double total = 0;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const double area = glm::length(testing::areaVector(scene, t));
        for (int k = 0; k < 3; ++k) sum += area / 3 * testing::corner(scene, t, k);
        total += area;
    }
    return sum / total;
}

void expectStands(const Scene& scene, const Stands& expected) {
    const double close = 2e-5 * glm::length(expected.max - expected.min);
    const auto [min, max] = testing::worldBox(scene);
    EXPECT_LT(glm::length(min - expected.min), close);
    EXPECT_LT(glm::length(max - expected.max), close);
    EXPECT_LT(glm::length(centerOfArea(scene) - expected.center), close);
}

TEST(GltfPoses, StandWhereTheSpecificationSays) {
    const char* given = std::getenv("MEGAVIEWS_SCENES");
    const std::filesystem::path folder =
        std::filesystem::path(given ? given : MEGAVIEWS_SOURCE_DIR "/../shared/scenes") /
        "gltf-conformance";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no scenes in " << folder;
    for (const Stands& expected : kStands) {
        SCOPED_TRACE(std::string(expected.file) + " at " + std::to_string(expected.timeS) + " s");
        const std::string path = (folder / expected.file).string();
        LoadOptions options;
        options.animation = std::to_string(expected.animation);
        Scene posed = loadScene(path, options);
        options.timeS = expected.timeS;
        const Scene loaded = loadScene(path, options);
        expectStands(loaded, expected);
        ASSERT_TRUE(posed.moving);
        EXPECT_TRUE(poseScene(posed, expected.timeS));
        expectStands(posed, expected);
        EXPECT_EQ(posed.positions, loaded.positions);
        EXPECT_EQ(posed.normals, loaded.normals);
        EXPECT_EQ(posed.contentHash, loaded.contentHash);
    }
}

// A square that stands, one that slides, a triangle that grows out of nothing, one that is morphed.
GltfBuilder mixed() {
    GltfBuilder b = GltfBuilder::square();
    const int corners = b.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    const int up = b.positions({{0, 0, 0}, {0, 0, 0}, {0, 4, 0}});
    b.node({{"mesh", 0}});
    b.primitive({{"POSITION", corners}});
    b.primitive({{"POSITION", corners}})["targets"] = {{{"POSITION", up}}};
    const auto keys = [&](std::vector<float> values, const char* type, std::size_t count) {
        return b.accessor(values, testing::kFloat, type, count);
    };
    const int times = keys({0, 1, 2}, "SCALAR", 3);
    const auto sampler = [&](int output) { return Json{{"input", times}, {"output", output}}; };
    const auto channel = [&](int s, int node, const char* path) {
        return Json{{"sampler", s}, {"target", {{"node", node}, {"path", path}}}};
    };
    b.add("animations",
          {{"samplers",
            {sampler(keys({0, 0, 0, 6, 0, 0, 0, 3, 0}, "VEC3", 3)),
             sampler(keys({0, 0, 0, 2, 2, 2, 1, 1, 1}, "VEC3", 3)),
             sampler(keys({0, 1, -0.5}, "SCALAR", 3))}},
           {"channels",
            {channel(0, 1, "translation"), channel(1, 2, "scale"), channel(2, 3, "weights")}}});
    return b;
}

Scene loadAt(const GltfBuilder& b, double timeS) {
    LoadOptions options;
    options.timeS = timeS;
    return testing::loadJson(b, options);
}

TEST(GltfPoses, AreThoseOfTheFileLoadedThen) {
    const GltfBuilder b = mixed();
    Scene scene = loadAt(b, 0);
    ASSERT_TRUE(scene.moving);
    // There and back, past the end, before the start.
    for (const double timeS : {0.3, 1.0, 1.9, 0.3, 5.25, -0.5}) {
        SCOPED_TRACE(timeS);
        const Scene loaded = loadAt(b, timeS);
        const std::uint64_t before = scene.poseNumber;
        EXPECT_TRUE(poseScene(scene, timeS));
        EXPECT_NE(scene.poseNumber, before);
        EXPECT_EQ(testing::inconsistency(scene), "");
        EXPECT_EQ(scene.root.edge, loaded.root.edge);
        EXPECT_EQ(scene.positions, loaded.positions);
        EXPECT_EQ(scene.normals, loaded.normals);
        EXPECT_EQ(scene.triangles, loaded.triangles);
        EXPECT_EQ(scene.contentHash, loaded.contentHash);
        EXPECT_FALSE(poseScene(scene, timeS)) << "it stands there already";
    }
}

TEST(GltfPoses, WhatStandsIsFirstAndKeepsItsBytes) {
    Scene scene = loadAt(mixed(), 0);
    ASSERT_TRUE(scene.moving);
    EXPECT_EQ(scene.moving->triangle, 2u);
    EXPECT_EQ(scene.triangles.size(), 2u + 2u + 1u + 1u);
    const std::vector<glm::vec3> positions = scene.positions, normals = scene.normals;
    ASSERT_TRUE(poseScene(scene, 0.7));
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (i < scene.moving->vertex) {
            EXPECT_EQ(scene.positions[i], positions[i]);
            EXPECT_EQ(scene.normals[i], normals[i]);
        } else {
            // Wherever it goes, it stays in its box.
            EXPECT_EQ(glm::clamp(scene.positions[i], scene.moving->min, scene.moving->max),
                      scene.positions[i]);
        }
    }
    EXPECT_NE(scene.positions, positions);
}

TEST(GltfPoses, AStillSceneKeepsNoRig) {
    // An animation that moves nothing: the same place at all keys, and a node that nothing hangs
    // on.
    GltfBuilder b = GltfBuilder::square();
    b.node({{"name", "empty"}});
    const int times = b.accessor(std::vector<float>{0, 1}, testing::kFloat, "SCALAR", 2);
    const int still = b.accessor(std::vector<float>(6, 0.0f), testing::kFloat, "VEC3", 2);
    const int away = b.accessor(std::vector<float>{0, 0, 0, 5, 0, 0}, testing::kFloat, "VEC3", 2);
    b.add("animations",
          {{"samplers",
            {{{"input", times}, {"output", still}}, {{"input", times}, {"output", away}}}},
           {"channels",
            {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}},
             {{"sampler", 1}, {"target", {{"node", 1}, {"path", "translation"}}}}}}});
    Scene scene = testing::loadJson(b);
    EXPECT_FALSE(scene.moving);
    EXPECT_FALSE(poseScene(scene, 0.5));
    EXPECT_EQ(scene.contentHash, testing::loadJson(b).contentHash);
}

}  // namespace
}  // namespace mv
