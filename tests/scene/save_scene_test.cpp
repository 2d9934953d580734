// --save-scene: what is saved is loaded as the same scene, and is glTF by the letter.
#include "megaviews/io/save_scene.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "megaviews/io/png.h"
#include "megaviews/scene/gltf_images.h"
#include "scene/gltf_builder.h"
#include "scene/round_trip.h"
#include "support/sanitized.h"

namespace mv {
namespace {

using testing::Bytes;
using testing::expectRoundTrip;
using testing::expectSameGeometry;
using testing::GltfBuilder;
using testing::Json;
using testing::readBytes;
using testing::roundTrip;
using testing::TemporaryFolder;

PosedCamera someCamera() {
    PosedCamera posed;
    posed.camera.name = "eye";
    posed.camera.yfovRad = 0.7;
    posed.position = {0.25, -3, 1e-3};
    posed.forward = {0, 0.6, -0.8};
    posed.up = {0, 0.8, 0.6};
    return posed;
}

SceneToSave momentOf(const Scene& scene, double timeS = 0) {
    const int animation = scene.animations.empty() ? -1 : 0;
    std::vector<PosedCamera> cameras = scene.camerasAt(timeS, animation);
    if (cameras.empty()) cameras = {someCamera()};
    return {.scene = scene,
            .lights = scene.lightsAt(timeS, animation),
            .cameras = std::move(cameras),
            .aspect = 16.0 / 9};
}

LoadOptions at(double timeS) {
    LoadOptions options;
    options.timeS = timeS;
    return options;
}

TEST(SaveScene, BuiltinScenesComeBackBitByBit) {
    for (const char* name : {"builtin:cornell", "builtin:atrium", "builtin:cathedral"}) {
        SCOPED_TRACE(name);
        const Scene scene = loadScene(name);
        expectRoundTrip(momentOf(scene, 3.7));
    }
}

// Packing large textures takes a sanitized build a minute.
constexpr std::uintmax_t kLargeFile = 1 << 20;

TEST(SaveScene, GltfScenesComeBackBitByBit) {
    const char* other = std::getenv("MEGAVIEWS_SCENES");
    const std::filesystem::path folder =
        (other ? std::filesystem::path(other)
               : std::filesystem::path(MEGAVIEWS_SOURCE_DIR) / "../shared/scenes") /
        "gltf-conformance";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no scenes in " << folder;
    std::size_t seen = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string file = entry.path().string();
        if (!file.ends_with(".gltf") && !file.ends_with(".glb")) continue;
        if (testing::kSanitized && entry.file_size() > kLargeFile) continue;
        if (!testing::inputError(file).empty()) continue;
        SCOPED_TRACE(file);
        const Scene scene = loadScene(file, at(0.4));
        expectRoundTrip(momentOf(scene, 0.4));
        ++seen;
    }
    EXPECT_GE(seen, 25u);
}

// Two textures of their own coordinates, transformed, wrapped and filtered in every way; a mask.
GltfBuilder paintedSquare() {
    GltfBuilder b = GltfBuilder::square();
    const Bytes texels = {255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 3, 10, 20, 30, 0};
    const Bytes opaque = {1, 2, 3, 255, 4, 5, 6, 255};
    b.texture(testing::png(2, 2, texels));
    b.texture(testing::png(1, 2, opaque));
    b.json["images"][0]["name"] = "leaves";
    b.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
    b.json["textures"][0]["sampler"] = 0;
    const Json transform = {
        {"KHR_texture_transform", {{"offset", {0.1, -3}}, {"rotation", 0.5}, {"scale", {2, 0.3}}}}};
    b.json["materials"][0] = {
        {"name", "paint"},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {0.8, 0.3, 0.2, 0.9}},
          {"baseColorTexture", {{"index", 0}, {"extensions", transform}}}}},
        {"emissiveFactor", {1, 0.3, 0.7}},
        {"emissiveTexture", {{"index", 1}}},
        {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 7.3}}}}},
        {"alphaMode", "MASK"},
        {"alphaCutoff", 0.3},
        {"doubleSided", true}};
    b.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
        b.accessor(std::vector<glm::vec3>{{0.1f, 1, 0}, {1, 0.7f, 0.2f}, {1, 1, 1}, {0, 0, 0.3f}},
                   testing::kFloat, "VEC3", 4);
    return b;
}

TEST(SaveScene, TexturesMasksAndEmission) {
    const Scene scene = testing::loadJson(paintedSquare());
    ASSERT_EQ(scene.images.size(), 2u);
    ASSERT_FALSE(scene.colors.empty());
    expectRoundTrip(momentOf(scene));

    // An emissive texture alone, then an unlit one.
    GltfBuilder b = paintedSquare();
    b.json["materials"][0].erase("pbrMetallicRoughness");
    const Scene emissive = testing::loadJson(b);
    ASSERT_TRUE(emissive.uvs.empty() && !emissive.emissiveUvs.empty());
    expectRoundTrip(momentOf(emissive));
    b = paintedSquare();
    b.json["materials"][0]["extensions"] = {{"KHR_materials_unlit", Json::object()}};
    const Scene unlit = testing::loadJson(b);
    ASSERT_TRUE(unlit.materials[0].unlit);
    expectRoundTrip(momentOf(unlit));
}

TEST(SaveScene, GlassComesBack) {
    GltfBuilder b = paintedSquare();
    Json& material = b.json["materials"][0];
    material["alphaMode"] = "BLEND";
    expectRoundTrip(momentOf(testing::loadJson(b)));
    material["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 0.75}};
    const Scene scene = testing::loadJson(b);
    EXPECT_TRUE(scene.materials[0].blends);
    EXPECT_EQ(scene.materials[0].transmission, 0.75f);
    expectRoundTrip(momentOf(scene));
    // Thin and dimmed: its index still spreads what passes it.
    material["extensions"]["KHR_materials_ior"] = {{"ior", 1.25}};
    material["extensions"]["KHR_materials_specular"] = {{"specularFactor", 0.5}};
    expectRoundTrip(momentOf(testing::loadJson(b)));
    // Filled: what it reflects no longer says how it bends light.
    material["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 0.5}};
    const Scene filled = testing::loadJson(b);
    EXPECT_EQ(filled.materials[0].filledIndex(), 1.25f);
    EXPECT_FLOAT_EQ(filled.materials[0].specular, 1.0f / 81);
    EXPECT_FLOAT_EQ(filled.materials[0].specularFactor, 0.5f);
    expectRoundTrip(momentOf(filled));
}

TEST(SaveScene, GlossAndItsMapsComeBack) {
    GltfBuilder b = paintedSquare();
    Json& material = b.json["materials"][0];
    Json maps = material["pbrMetallicRoughness"]["baseColorTexture"];  // at the same coordinates
    material["pbrMetallicRoughness"]["metallicFactor"] = 0.75;
    material["pbrMetallicRoughness"]["roughnessFactor"] = 0.25;
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = maps;
    maps["scale"] = 0.5;
    material["normalTexture"] = maps;
    material["extensions"]["KHR_materials_ior"] = {{"ior", 2}};
    material["extensions"]["KHR_materials_clearcoat"] = {
        {"clearcoatFactor", 0.75},
        {"clearcoatRoughnessFactor", 0.25},
        {"clearcoatTexture", material["pbrMetallicRoughness"]["baseColorTexture"]},
        {"clearcoatNormalTexture", maps}};
    const Scene scene = testing::loadJson(b);
    EXPECT_FLOAT_EQ(scene.materials[0].specular, 1.0f / 9);
    EXPECT_GE(scene.materials[0].metallicRoughnessTexture, 0);
    EXPECT_GE(scene.materials[0].normalTexture, 0);
    EXPECT_GE(scene.materials[0].coatTexture, 0);
    expectRoundTrip(momentOf(scene));
    material["pbrMetallicRoughness"].erase("baseColorTexture");
    expectRoundTrip(momentOf(testing::loadJson(b)));
    // The coat's alone: they need coordinates, too.
    material["pbrMetallicRoughness"].erase("metallicRoughnessTexture");
    material.erase("normalTexture");
    const Scene coated = testing::loadJson(b);
    EXPECT_GE(coated.materials[0].coatNormalTexture, 0);
    EXPECT_FALSE(coated.uvs.empty());
    expectRoundTrip(momentOf(coated));
}

TEST(SaveScene, MaterialsByTurnsKeepTheirOrder) {
    GltfBuilder b = GltfBuilder::square();
    b.add("materials", {{"emissiveFactor", {0.5, 0, 0.25}}});
    for (int i = 0; i < 4; ++i) {
        const float x = static_cast<float>(i);
        b.primitive(
            {{"POSITION", b.positions({{x, 0, 1}, {x + 1, 0, 2}, {x, 3, 1}})}})["material"] =
            (i + 1) % 2;
    }
    b.primitive({{"POSITION", b.positions({{0, 0, 1}, {1, 0, 2}, {0, 3, 1}})}});  // the default
    const Scene scene = testing::loadJson(b);
    ASSERT_EQ(scene.materials.size(), 3u);
    expectRoundTrip(momentOf(scene));
}

TEST(SaveScene, GeometryStandsWhereItWasAtTheTime) {
    GltfBuilder b = GltfBuilder::square();
    const int input = b.accessor(std::vector<float>{0, 2}, testing::kFloat, "SCALAR", 2);
    const int output =
        b.accessor(std::vector<float>{0, 0, 0, 10, 20, 30}, testing::kFloat, "VEC3", 2);
    b.add("animations",
          {{"samplers", {{{"input", input}, {"output", output}}}},
           {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
    const TemporaryFolder folder;
    const Scene scene = loadScene(folder.write("moving.gltf", b.gltfText()), at(1));
    ASSERT_TRUE(scene.moving);
    const Scene loaded = roundTrip(momentOf(scene, 1));
    expectSameGeometry(scene, loaded);
    EXPECT_FALSE(loaded.moving);
    EXPECT_NEAR(glm::length(testing::worldBox(loaded).first - glm::dvec3(5, 10, 15)), 0, 1e-6);
}

TEST(SaveScene, LightsOfEveryKind) {
    const Scene scene = testing::loadJson(GltfBuilder::square());
    SceneToSave saved = momentOf(scene);
    const auto add = [&](const char* name, LightType type, glm::vec3 intensity) -> Light& {
        PosedLight posed;
        posed.light.name = name;
        posed.light.type = type;
        posed.light.intensity = intensity;
        posed.position = {1e4, -0.1, 1.0 / 3};
        posed.direction = glm::normalize(glm::dvec3(0.1, -1, 0.3));
        return saved.lights.emplace_back(posed).light;
    };
    add("bulb", LightType::point, {0.1f, 1e-4f, 0.3f});
    add("sun", LightType::directional, {1e5f, 9e4f, 7e4f});
    add("cone", LightType::spot, {30, 0, 0}).innerConeRad = 0.3;
    saved.lights.back().light.isDefault = true;  // placed: an automatic sky goes with it
    Light& sharp = add("sharp", LightType::spot, {1, 1, 1});
    sharp.innerConeRad = sharp.outerConeRad = 0.5;
    saved.lights.back().direction = {0, -1, 0};  // the axis that `up` is made from
    expectRoundTrip(saved);

    // The scale is in what is written; what it leaves dark is not.
    saved.lightScale = 2.5;
    const Scene brighter = roundTrip(saved);
    ASSERT_EQ(brighter.lights.size(), 4u);
    EXPECT_EQ(brighter.lights[2].intensity, glm::vec3(75, 0, 0));
    saved.lightScale = 0;
    EXPECT_TRUE(roundTrip(saved).lights.empty());
}

TEST(SaveScene, LightScaleMultipliesEmission) {
    const Scene scene = testing::loadJson(paintedSquare());
    SceneToSave saved = momentOf(scene);
    saved.lightScale = 0.01;
    const Material dim = roundTrip(saved).materials[0];
    EXPECT_NEAR(dim.emission.r, 0.073, 1e-7);
    EXPECT_EQ(dim.emissiveTexture, 1);
    saved.lightScale = 0;
    const Material dark = roundTrip(saved).materials[0];
    EXPECT_EQ(dark.emission, glm::vec3(0));
    EXPECT_EQ(dark.emissiveTexture, -1);
}

TEST(SaveScene, OrthographicCamera) {
    const Scene scene = testing::loadJson(GltfBuilder::square());
    SceneToSave saved = momentOf(scene);
    saved.cameras[0].camera.orthoHalfHeight = 1.7;
    expectRoundTrip(saved);
}

TEST(SaveScene, SeveralCamerasInTheirOrder) {
    const Scene scene = testing::loadJson(GltfBuilder::square());
    SceneToSave saved = momentOf(scene);
    ASSERT_EQ(saved.cameras.size(), 1u);
    for (const char* name : {"Küche", "台所 \"2\"", "eye", "from above"}) {
        PosedCamera& camera = saved.cameras.emplace_back(someCamera());
        camera.camera.name = name;
        camera.camera.yfovRad = 0.1 * static_cast<double>(saved.cameras.size());
        camera.position.x = 10.0 / static_cast<double>(saved.cameras.size());
    }
    saved.cameras.back().camera.orthoHalfHeight = 3;
    expectRoundTrip(saved);
    saved.cameras.clear();
    expectRoundTrip(saved);
}

TEST(SaveScene, NothingButACamera) {
    GltfBuilder b;
    b.json["scenes"] = {{{"nodes", Json::array()}}};
    const Scene scene = testing::loadJson(b);
    ASSERT_TRUE(scene.empty());
    const Scene loaded = roundTrip(momentOf(scene));
    EXPECT_TRUE(loaded.empty() && loaded.lights.empty());
    EXPECT_EQ(loaded.cameras.size(), 1u);
}

TEST(SaveScene, FarFromTheOriginAndTiny) {
    for (const double scale : {1e-12, 1.0, 1e12}) {
        for (const double offset : {0.0, 1e6}) {
            SCOPED_TRACE(std::to_string(scale) + " " + std::to_string(offset));
            GltfBuilder b = GltfBuilder::square();
            b.json["nodes"][0]["scale"] = {scale, -scale, scale};
            b.json["nodes"][0]["rotation"] = {0.5, 0.5, 0.5, 0.5};
            b.json["nodes"][0]["translation"] = {offset * scale, 0, 0};
            const Scene scene = testing::loadJson(b);
            ASSERT_EQ(scene.triangles.size(), 2u);
            expectRoundTrip(momentOf(scene));
        }
    }
}

// A root cube that does not fit what the file holds, after an edit say, is not taken.
TEST(SaveScene, AStatedRootCubeMustFit) {
    GltfBuilder b = GltfBuilder::square();
    const Scene scene = testing::loadJson(b);
    const auto rootWith = [&](Json stated) {
        b.json["asset"]["extras"] = {{"megaviews", {{"rootCube", std::move(stated)}}}};
        return testing::loadJson(b).root;
    };
    const Json bad[] = {{0, 0, 0, 1},     {-1, -1, -1, 70}, {-5, -5, -5, 2}, {0, 0, 0, 0},
                        {-1, -1, -1, -3}, {1, 2, 3},        {"a", 0, 0, 1},  nullptr,
                        "text",           {0, 0, 0, 1e300}};
    for (const Json& stated : bad) {
        SCOPED_TRACE(stated.dump());
        const RootCube root = rootWith(stated);
        EXPECT_EQ(root.origin, scene.root.origin);
        EXPECT_EQ(root.edge, scene.root.edge);
    }
    EXPECT_EQ(rootWith({-0.25, -0.25, -0.75, 1.5}).edge, 1.5);
    b.json["asset"]["extras"] = "a sentence";
    EXPECT_EQ(testing::loadJson(b).root.edge, scene.root.edge);
}

// Of positions that were packed: rays start as far off surfaces again.
TEST(SaveScene, KeepsTheStepOfPositions) {
    Scene scene = testing::loadJson(paintedSquare());
    EXPECT_EQ(scene.positionStep, 0.0f);
    scene.positionStep = 3e-4f;
    const TemporaryFolder folder;
    saveScene(folder.path() / "a.glb", momentOf(scene));
    EXPECT_EQ(loadScene((folder.path() / "a.glb").string()).positionStep, 3e-4f);
}

TEST(SaveScene, EqualScenesGiveEqualBytes) {
    const Scene scene = testing::loadJson(paintedSquare());
    const TemporaryFolder folder;
    saveScene(folder.path() / "a.glb", momentOf(scene));
    saveScene(folder.path() / "b.glb", momentOf(scene));
    EXPECT_EQ(readBytes(folder.path() / "a.glb"), readBytes(folder.path() / "b.glb"));
}

TEST(SaveScene, WhatCannotBeWrittenIsSaidInOneSentence) {
    const Scene scene = loadScene("builtin:cornell");
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "folder.glb");
    std::vector<std::filesystem::path> files = {folder.path() / "nowhere" / "a.glb",
                                                folder.path() / "folder.glb"};
    // A device that is always full: the error comes from amidst the writing.
    if (std::filesystem::exists("/dev/full")) files.emplace_back("/dev/full");
    for (const std::filesystem::path& file : files) {
        SCOPED_TRACE(file);
        try {
            saveScene(file, momentOf(scene));
            ADD_FAILURE() << "written";
        } catch (const Error& error) {
            EXPECT_EQ(error.code, ExitCode::output);
            EXPECT_TRUE(std::string(error.what())
                            .starts_with("'" + file.string() + "' cannot be written: "))
                << error.what();
        }
    }
    std::size_t left = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        left += entry.path() != folder.path() / "folder.glb";
    }
    EXPECT_EQ(left, 0u);
}

TEST(Png, DecodesToTheSamePixels) {
    for (const int width : {1, 3, 64, 257}) {
        for (const bool opaque : {false, true}) {
            Image image;
            image.width = width;
            image.height = 5;
            std::uint32_t random = 12345;
            for (int i = 0; i < 4 * width * image.height; ++i) {
                random = random * 1664525 + 1013904223;
                const auto byte = static_cast<std::uint8_t>(random >> 24);
                image.rgba.push_back(opaque && i % 4 == 3 ? std::uint8_t{255} : byte);
            }
            const DecodedImage decoded = decodeImage(encodePng(image));
            EXPECT_EQ(decoded.error, "");
            EXPECT_EQ(decoded.width, width);
            EXPECT_EQ(decoded.height, 5);
            EXPECT_EQ(decoded.rgba, image.rgba) << width << (opaque ? ", opaque" : "");
        }
    }
}

}  // namespace
}  // namespace mv
