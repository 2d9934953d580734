// What a glTF file says of materials, textures and images.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "megaviews/core/colour.h"
#include "megaviews/scene/gltf_images.h"
#include "scene/gltf_builder.h"

namespace mv {
namespace {

using testing::Bytes;
using testing::GltfBuilder;
using testing::Json;

const Bytes kTexels = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 10, 20, 30, 40};

GltfBuilder texturedSquare(Json textureInfo = {}) {
    GltfBuilder b = GltfBuilder::square();
    textureInfo["index"] = b.texture(testing::png(2, 2, kTexels));
    b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = std::move(textureInfo);
    return b;
}

Material loadMaterial(const Json& material) {
    GltfBuilder b = GltfBuilder::square();
    b.json["materials"][0] = material;
    return testing::loadJson(b).materials[0];
}

TEST(GltfMaterials, FactorsAlphaAndSides) {
    const Material plain = loadMaterial(Json::object());
    EXPECT_EQ(plain.baseColor, glm::vec4(1));
    EXPECT_EQ(plain.alphaCutoff, 0);
    EXPECT_FALSE(plain.doubleSided);
    EXPECT_FALSE(plain.emits());

    const Material all =
        loadMaterial({{"name", "paint"},
                      {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0, 0.75}}}},
                      {"alphaMode", "MASK"},
                      {"alphaCutoff", 0.3},
                      {"doubleSided", true},
                      {"emissiveFactor", {1, 0.5, 0}}});
    EXPECT_EQ(all.name, "paint");
    EXPECT_EQ(all.baseColor, glm::vec4(0.5, 0.25, 0, 0.75));
    EXPECT_FLOAT_EQ(all.alphaCutoff, 0.3f);
    EXPECT_TRUE(all.doubleSided);
    EXPECT_EQ(all.emission, glm::vec3(1, 0.5, 0));
    EXPECT_TRUE(all.emits());

    EXPECT_EQ(loadMaterial({{"alphaMode", "MASK"}}).alphaCutoff, 0.5f);
    EXPECT_EQ(loadMaterial({{"alphaMode", "BLEND"}}).alphaCutoff, 0.5f);
    EXPECT_EQ(loadMaterial({{"alphaMode", "OPAQUE"}, {"alphaCutoff", 0.9}}).alphaCutoff, 0);
}

// Texels that nobody sees take the colour of those beside them, however far: a leaf is not framed
// in the black or white of its background where texels are averaged.
TEST(GltfMaterials, UnseenTexelsHaveTheColourOfTheirNeighbours) {
    constexpr int kWidth = 13, kHeight = 6;
    Bytes texels;
    for (int i = 0; i < kWidth * kHeight; ++i) {
        const int x = i % kWidth;
        const bool leaf = x < 2, edge = x == 2, stem = x == 12;
        const auto a = static_cast<std::uint8_t>(leaf || stem ? 255 : edge ? 60 : 0);
        texels.insert(texels.end(), {std::uint8_t(stem ? 200 : 20), std::uint8_t(leaf ? 150 : 0),
                                     std::uint8_t(edge ? 90 : 0), a});
    }
    const auto image = [&](const Json& material) {
        GltfBuilder b = GltfBuilder::square();
        const int texture = b.texture(testing::png(kWidth, kHeight, texels));
        b.json["materials"][0] = material;
        b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}};
        return testing::loadJson(b).images[0].rgba;
    };
    EXPECT_EQ(image(Json::object()), texels) << "opaque: all of it is seen";
    const auto masked = image({{"alphaMode", "MASK"}});
    const auto blended = image({{"alphaMode", "BLEND"}});
    for (int i = 0; i < kWidth * kHeight; ++i) {
        const auto at = static_cast<std::size_t>(4 * i);
        const int x = i % kWidth;
        EXPECT_EQ(masked[at + 3], texels[at + 3]) << "alpha stays";
        EXPECT_EQ(blended[at + 3], texels[at + 3]);
        if (x < 2 || x == 12) {
            for (std::size_t c = 0; c < 3; ++c) {
                EXPECT_EQ(masked[at + c], texels[at + c]);
                EXPECT_EQ(blended[at + c], texels[at + c]);
            }
        } else {
            EXPECT_GE(std::max(masked[at], masked[at + 1]), 75) << x << ": none is black";
            if (x < 4) {
                EXPECT_EQ(masked[at + 1], 150) << x << ": of the leaf";
            }
            if (x == 3) {
                EXPECT_EQ(blended[at + 2], 90) << "of the edge, which is seen";
            }
            if (x == 11) {
                EXPECT_EQ(masked[at], 200) << "of the stem";
            }
        }
    }
}

TEST(GltfMaterials, Extensions) {
    const Material strong = loadMaterial(
        {{"emissiveFactor", {1, 0.5, 0}},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}}}});
    EXPECT_EQ(strong.emission, glm::vec3(8, 4, 0));

    const Material unlit =
        loadMaterial({{"emissiveFactor", {1, 1, 1}},
                      {"pbrMetallicRoughness", {{"baseColorFactor", {0, 1, 0, 1}}}},
                      {"extensions", {{"KHR_materials_unlit", Json::object()}}}});
    EXPECT_TRUE(unlit.unlit);
    EXPECT_TRUE(unlit.emits());
    EXPECT_EQ(unlit.emission, glm::vec3(0));

    const auto glass = [](double transmission) {
        return loadMaterial(
            {{"alphaMode", "BLEND"},
             {"extensions",
              {{"KHR_materials_transmission", {{"transmissionFactor", transmission}}}}}});
    };
    EXPECT_EQ(glass(1).transmission, 1);
    EXPECT_GT(glass(1).rayCutoff(), 1) << "light passes it";
    EXPECT_EQ(glass(0.25).rayCutoff(), 0.5f);
    EXPECT_EQ(glass(0).rayCutoff(), 0.5f);
    EXPECT_TRUE(glass(0).blends);
    EXPECT_EQ(glass(5).transmission, 1) << "more light than there is";
    EXPECT_EQ(glass(-1).transmission, 0);
    EXPECT_TRUE(glass(0).isClear());
    EXPECT_FALSE(loadMaterial({{"alphaMode", "MASK"}}).isClear());
}

TEST(GltfMaterials, Gloss) {
    const Material plain = loadMaterial(Json::object());
    EXPECT_EQ(plain.metallic, 1);  // as the standard has it
    EXPECT_EQ(plain.roughness, 1);
    EXPECT_FLOAT_EQ(plain.specular, 0.04f);
    EXPECT_TRUE(plain.isGlossy());

    const Material all = loadMaterial(
        {{"pbrMetallicRoughness", {{"metallicFactor", 0.25}, {"roughnessFactor", 0.5}}},
         {"extensions",
          {{"KHR_materials_ior", {{"ior", 2}}},
           {"KHR_materials_specular", {{"specularFactor", 0.5}}}}}});
    EXPECT_FLOAT_EQ(all.metallic, 0.25f);
    EXPECT_FLOAT_EQ(all.roughness, 0.5f);
    EXPECT_FLOAT_EQ(all.specular, 1.0f / 9);
    EXPECT_FLOAT_EQ(all.specularFactor, 0.5f);
    const auto ofIndex = [](double ior) {
        return loadMaterial({{"extensions", {{"KHR_materials_ior", {{"ior", ior}}}}}}).specular;
    };
    EXPECT_EQ(ofIndex(1), 0);
    EXPECT_EQ(ofIndex(0), 1);

    Material red = loadMaterial(
        {{"extensions", {{"KHR_materials_specular", {{"specularColorFactor", {30, 1, 0}}}}}}});
    EXPECT_EQ(red.layer(), glm::vec3(1, 0.04f, 0)) << "no more light than there is";
    red.specularFactor = 0.5f;
    EXPECT_EQ(red.layer(), glm::vec3(0.5f, 0.02f, 0)) << "the factor comes after the bound";
    Material black = Material{};
    black.specular = 1;
    black.specularColor = glm::vec3(0);
    EXPECT_FALSE(black.isGlossy());

    Material unlit = all;
    unlit.unlit = true;
    EXPECT_FALSE(unlit.isGlossy());
    EXPECT_FALSE(Material{}.isGlossy());  // of scenes that know no gloss
}

// What fills glass takes light away over its thickness, in units of the mesh.
TEST(GltfMaterials, Volume) {
    GltfBuilder b = GltfBuilder::square();
    b.json["nodes"][0]["scale"] = {2, 2, 2};
    Json& extensions = b.json["materials"][0]["extensions"];
    extensions["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
    Json& volume = extensions["KHR_materials_volume"];
    volume = {
        {"thicknessFactor", 0.5}, {"attenuationDistance", 2}, {"attenuationColor", {0.25, 1, 0}}};
    const auto attenuation = [&] { return testing::loadJson(b).materials[0].attenuation(); };
    // Half of two units in the world.
    EXPECT_FLOAT_EQ(testing::loadJson(b).materials[0].thickness, 1);
    EXPECT_FLOAT_EQ(attenuation().r, 0.5f);
    EXPECT_EQ(attenuation().g, 1);
    EXPECT_LT(attenuation().b, 2e-3f);
    EXPECT_TRUE(testing::loadJson(b).ignored.empty());
    // The means of textures: of how thick it is, green, and of how much passes, red.
    const int texture = b.texture(testing::png(2, 2, kTexels));
    volume["thicknessTexture"] = {{"index", texture}};
    extensions["KHR_materials_transmission"]["transmissionTexture"] = {{"index", texture}};
    const Scene textured = testing::loadJson(b);
    EXPECT_TRUE(textured.images.empty()) << "nothing else looks at it";
    b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}};
    const Scene coloured = testing::loadJson(b);
    ASSERT_EQ(coloured.images.size(), 1u);
    for (const Scene* s : {&textured, &coloured}) {
        const auto mean = [&](std::size_t channel) {
            const std::vector<std::uint8_t>& rgba = coloured.images[0].rgba;
            double sum = 0;
            for (std::size_t i = channel; i < rgba.size(); i += 4) sum += rgba[i];
            return sum / 255 / static_cast<double>(rgba.size() / 4);
        };
        EXPECT_NEAR(s->materials[0].thickness, mean(1), 1e-5);
        EXPECT_NEAR(s->materials[0].transmission, mean(0), 1e-5);
    }
    // Thin, or as clear as air; what bends sight is filled.
    const auto index = [&] { return testing::loadJson(b).materials[0].filledIndex(); };
    EXPECT_EQ(index(), 1.5f);
    volume = {{"thicknessFactor", 1}};
    extensions["KHR_materials_ior"] = {{"ior", 1.25}};
    EXPECT_EQ(index(), 1.25f);
    EXPECT_EQ(attenuation(), glm::vec3(1));
    for (const double none : {0, 1}) {
        extensions["KHR_materials_ior"] = {{"ior", none}};
        EXPECT_EQ(index(), 0) << none;
    }
    extensions.erase("KHR_materials_ior");
    volume["thicknessFactor"] = 0;
    EXPECT_EQ(index(), 0) << "thin";
    volume = {{"attenuationColor", {0.5, 0.5, 0.5}}, {"attenuationDistance", 1}};
    EXPECT_EQ(attenuation(), glm::vec3(1));
    volume = {{"thicknessFactor", 1}, {"attenuationColor", {0.5, 0.5, 0.5}}};
    EXPECT_EQ(attenuation(), glm::vec3(1)) << "whose colour is left at no distance";
    volume = {{"thicknessFactor", -1}, {"attenuationDistance", 1}};
    EXPECT_EQ(attenuation(), glm::vec3(1));
    volume = {{"thicknessFactor", 1e300},
              {"attenuationDistance", 1e-300},
              {"attenuationColor", {1, 1, 0.5}}};
    EXPECT_EQ(attenuation(), glm::vec3(1, 1, 0)) << "no number but a share";
}

// What gloss reflects: the means of textures, alpha and linear colour.
TEST(GltfMaterials, SpecularTextures) {
    GltfBuilder b = GltfBuilder::square();
    const int texture = b.texture(testing::png(2, 2, kTexels));
    b.json["materials"][0]["extensions"]["KHR_materials_specular"] = {
        {"specularFactor", 0.5},
        {"specularColorFactor", {1, 0.5, 1}},
        {"specularTexture", {{"index", texture}}},
        {"specularColorTexture", {{"index", texture}}}};
    const Scene scene = testing::loadJson(b);
    EXPECT_TRUE(scene.warnings.empty());
    const auto mean = [&](std::size_t channel, const auto& of) {
        double sum = 0;
        for (std::size_t i = channel; i < kTexels.size(); i += 4) sum += of(kTexels[i] / 255.0);
        return sum / static_cast<double>(kTexels.size() / 4);
    };
    EXPECT_NEAR(scene.materials[0].specularFactor, 0.5 * mean(3, [](double x) { return x; }), 1e-6);
    EXPECT_NEAR(scene.materials[0].specularColor.r, mean(0, linearFromSrgb), 1e-5);
    EXPECT_NEAR(scene.materials[0].specularColor.g, 0.5 * mean(1, linearFromSrgb), 1e-5);
    EXPECT_NEAR(scene.materials[0].specularColor.b, mean(2, linearFromSrgb), 1e-5);
}

TEST(GltfMaterials, ClearCoat) {
    EXPECT_EQ(loadMaterial(Json::object()).coat, 0);
    GltfBuilder b = GltfBuilder::square();
    const int texture = b.texture(testing::png(2, 2, kTexels));
    Json& coat = b.json["materials"][0]["extensions"]["KHR_materials_clearcoat"];
    coat = {{"clearcoatFactor", 0.75}, {"clearcoatRoughnessFactor", 0.25}};
    Scene scene = testing::loadJson(b);
    EXPECT_EQ(scene.materials[0].coat, 0.75f);
    EXPECT_EQ(scene.materials[0].coatRoughness, 0.25f);
    EXPECT_EQ(scene.materials[0].coatTexture, -1);
    EXPECT_TRUE(scene.materials[0].isGlossy());
    coat["clearcoatTexture"] = {{"index", texture}};
    EXPECT_EQ(testing::loadJson(b).materials[0].coatTexture, 0);

    // Where other textures have other coordinates, its mean stands for it.
    b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}};
    coat["clearcoatTexture"]["extensions"]["KHR_texture_transform"] = {{"offset", {0.5, 0}}};
    scene = testing::loadJson(b);
    EXPECT_EQ(scene.materials[0].coatTexture, -1);
    EXPECT_NEAR(scene.materials[0].coat, 0.75 * (255 + 0 + 0 + 10) / 4 / 255, 1e-4);

    coat = {{"clearcoatFactor", 1},
            {"clearcoatRoughnessFactor", 0.5},
            {"clearcoatRoughnessTexture", {{"index", texture}}}};
    scene = testing::loadJson(b);
    double greens = 0;
    for (std::size_t i = 1; i < kTexels.size(); i += 4) greens += kTexels[i];
    EXPECT_NEAR(scene.materials[0].coatRoughness,
                0.5 * greens / 255 / static_cast<double>(kTexels.size() / 4), 1e-6);
    coat = {{"clearcoatFactor", 7},
            {"clearcoatNormalTexture", {{"index", texture}, {"scale", 0.25}}}};
    scene = testing::loadJson(b);
    EXPECT_EQ(scene.materials[0].coat, 1) << "clamped";
    EXPECT_EQ(scene.materials[0].coatNormalTexture, scene.materials[0].baseTexture);
    EXPECT_EQ(scene.materials[0].coatNormalScale, 0.25f);
    coat = {{"clearcoatFactor", -1}};
    EXPECT_EQ(testing::loadJson(b).materials[0].coat, 0);
    coat = {{"clearcoatFactor", 1}, {"clearcoatTexture", {{"index", 17}}}};
    EXPECT_EQ(testing::loadJson(b).materials[0].coatTexture, -1) << "no such texture";
}

TEST(GltfMaterials, MapsBesideTheBaseColours) {
    GltfBuilder b = texturedSquare();
    Json& pbr = b.json["materials"][0]["pbrMetallicRoughness"];
    const int maps = b.texture(testing::png(2, 2, kTexels));
    pbr["metallicRoughnessTexture"] = {{"index", maps}};
    pbr["metallicFactor"] = 1;
    b.json["materials"][0]["normalTexture"] = {{"index", maps}, {"scale", 0.5}};
    const Scene same = testing::loadJson(b);
    EXPECT_EQ(testing::inconsistency(same), "");
    EXPECT_EQ(same.materials[0].metallicRoughnessTexture, 1);
    EXPECT_EQ(same.materials[0].normalTexture, 1);
    EXPECT_EQ(same.materials[0].normalScale, 0.5f);
    EXPECT_TRUE(same.warnings.empty());
    EXPECT_TRUE(same.ignored.empty());

    // Other coordinates: the mean of numbers; a normal map has none.
    const Json moved = {{"KHR_texture_transform", {{"offset", {0.5, 0}}}}};
    pbr["metallicRoughnessTexture"]["extensions"] = moved;
    b.json["materials"][0]["normalTexture"]["extensions"] = moved;
    b.json["extensionsUsed"] = {"KHR_texture_transform"};
    const Scene apart = testing::loadJson(b);
    EXPECT_EQ(apart.materials[0].metallicRoughnessTexture, -1);
    EXPECT_EQ(apart.materials[0].normalTexture, -1);
    EXPECT_NEAR(apart.materials[0].roughness, (0 + 255 + 0 + 20) / 1020.0, 1e-5);
    EXPECT_NEAR(apart.materials[0].metallic, (0 + 0 + 255 + 30) / 1020.0, 1e-5);
    EXPECT_EQ(apart.warnings.size(), 2u);

    // Without a base colour's texture they have the coordinates to themselves.
    pbr.erase("baseColorTexture");
    const Scene alone = testing::loadJson(b);
    EXPECT_EQ(alone.materials[0].baseTexture, -1);
    EXPECT_GE(alone.materials[0].metallicRoughnessTexture, 0);
    EXPECT_GE(alone.materials[0].normalTexture, 0);
    EXPECT_TRUE(alone.warnings.empty());
}

TEST(GltfMaterials, TexturesImagesAndSamplers) {
    GltfBuilder b = texturedSquare();
    b.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
    b.json["textures"][0]["sampler"] = 0;
    b.texture(testing::png(2, 2, kTexels));  // nobody uses it
    b.json["images"][0]["name"] = "four";
    const Scene scene = testing::loadJson(b);
    EXPECT_EQ(testing::inconsistency(scene), "");
    ASSERT_EQ(scene.textures.size(), 1u);
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0].name, "four");
    EXPECT_EQ(scene.images[0].width, 2);
    EXPECT_EQ(scene.images[0].height, 2);
    EXPECT_EQ(scene.images[0].rgba, kTexels);  // top row first
    EXPECT_EQ(scene.textures[0].wrapS, Wrap::clamp);
    EXPECT_EQ(scene.textures[0].wrapT, Wrap::mirror);
    EXPECT_TRUE(scene.textures[0].nearest);
    EXPECT_EQ(scene.materials[0].baseTexture, 0);
    EXPECT_EQ(scene.uvs[scene.triangles[0].x], glm::vec2(0, 1));
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfMaterials, ImagesInBufferViewsAndFiles) {
    const Bytes image = testing::png(2, 2, kTexels);
    GltfBuilder inBuffer = texturedSquare();
    inBuffer.json["images"][0] = {{"bufferView", inBuffer.view(image)}, {"mimeType", "image/png"}};
    const testing::TemporaryFolder folder;
    EXPECT_EQ(loadScene(folder.write("a.glb", inBuffer.glb())).images[0].rgba, kTexels);

    GltfBuilder beside = texturedSquare();
    beside.json["images"][0] = {{"uri", "my%20image.png"}};
    folder.write("my image.png", image);
    EXPECT_EQ(loadScene(folder.write("b.gltf", beside.gltfText())).images[0].rgba, kTexels);
}

TEST(GltfMaterials, LostImagesLeaveThePlainColour) {
    GltfBuilder b = texturedSquare();
    b.json["images"][0] = {{"uri", "gone.png"}};
    b.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
    b.json["materials"][0]["emissiveTexture"] = {{"index", 0}};
    const Scene scene = testing::loadJson(b);
    EXPECT_EQ(scene.materials[0].baseTexture, -1);
    EXPECT_FLOAT_EQ(scene.materials[0].baseColor.r, 0.8f);
    EXPECT_EQ(scene.materials[0].emission, glm::vec3(0));  // rather dark than all aglow
    EXPECT_TRUE(scene.uvs.empty());
    EXPECT_TRUE(testing::anyContains(scene.warnings, "gone.png"));
}

TEST(GltfMaterials, EmissiveTextureHasItsOwnCoordinates) {
    GltfBuilder b = texturedSquare();
    const int second = b.accessor(std::vector<glm::vec2>{{5, 5}, {6, 5}, {6, 6}, {5, 6}},
                                  testing::kFloat, "VEC2", 4);
    b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = second;
    b.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
    b.json["materials"][0]["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
    const Scene scene = testing::loadJson(b);
    EXPECT_EQ(testing::inconsistency(scene), "");
    EXPECT_EQ(scene.textures.size(), 1u);  // shared
    EXPECT_EQ(scene.uvs[scene.triangles[0].y], glm::vec2(1, 1));
    EXPECT_EQ(scene.emissiveUvs[scene.triangles[0].y], glm::vec2(6, 5));
}

TEST(GltfMaterials, TextureTransformIsBakedIntoTheCoordinates) {
    const double angle = 0.3;
    GltfBuilder b = texturedSquare({{"texCoord", 5},
                                    {"extensions",
                                     {{"KHR_texture_transform",
                                       {{"offset", {-0.2, 0.1}},
                                        {"rotation", angle},
                                        {"scale", {1.5, 0.5}},
                                        {"texCoord", 0}}}}}});
    b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_texture_transform"};
    const Scene scene = testing::loadJson(b);
    EXPECT_EQ(testing::inconsistency(scene), "");
    // Corner 1 of triangle 0 has uv (1, 1): scaled, turned counter-clockwise (v down), moved.
    const double u = 1.5 * 1, v = 0.5 * 1;
    const glm::dvec2 expected(std::cos(angle) * u + std::sin(angle) * v - 0.2,
                              -std::sin(angle) * u + std::cos(angle) * v + 0.1);
    const glm::vec2 got = scene.uvs[scene.triangles[0].y];
    EXPECT_NEAR(got.x, expected.x, 1e-6);
    EXPECT_NEAR(got.y, expected.y, 1e-6);
}

TEST(GltfMaterials, QuantisedTextureCoordinates) {
    const auto check = [](auto top, int componentType, bool normalized, float expected) {
        using T = decltype(top);
        GltfBuilder b = texturedSquare();
        std::vector<T> data;
        for (int vertex = 0; vertex < 4; ++vertex) {
            data.push_back(top);
            data.push_back(T(0));
            while (data.size() * sizeof(T) % 4 != 0) data.push_back(T(0));
        }
        const int view = b.view(data, sizeof(T) == 1 ? 4 : static_cast<int>(2 * sizeof(T)));
        b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
            b.accessor(view, componentType, "VEC2", 4, 0, normalized);
        EXPECT_EQ(testing::loadJson(b).uvs[0], glm::vec2(expected, 0)) << componentType;
    };
    check(std::uint8_t{255}, testing::kUnsignedByte, true, 1);
    check(std::uint16_t{65535}, testing::kUnsignedShort, true, 1);
    check(std::int8_t{-127}, testing::kByte, true, -1);
    check(std::int16_t{-32768}, testing::kShort, true, -1);
    check(std::int16_t{300}, testing::kShort, false, 300);
    check(0.25f, testing::kFloat, false, 0.25f);
}

TEST(GltfMaterials, NonFiniteCoordinatesBecomeZero) {
    GltfBuilder b = texturedSquare();
    const float inf = std::numeric_limits<float>::infinity();
    b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = b.accessor(
        std::vector<glm::vec2>(4, glm::vec2(inf, std::nanf(""))), testing::kFloat, "VEC2", 4);
    EXPECT_EQ(testing::loadJson(b).uvs[0], glm::vec2(0));
}

// Two squares, of which the first has materials of its own for variants 0 and 2.
GltfBuilder squareOfVariants() {
    GltfBuilder b = GltfBuilder::square();
    b.add("materials", {{"name", "A"}});
    b.add("materials", {{"name", "B"}});
    Json primitive = b.json["meshes"][0]["primitives"][0];
    b.json["meshes"][0]["primitives"].push_back(primitive);
    b.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
        {{"material", 1}, {"variants", {0}}}, {{"material", 2}, {"variants", {1, 2}}}};
    b.json["extensions"]["KHR_materials_variants"]["variants"] = {
        {{"name", "beach"}}, {{"name", "2"}}, {{"name", "street"}}};
    b.json["extensionsUsed"] = {"KHR_materials_variants"};
    return b;
}

TEST(GltfVariants, PrimitivesTakeTheMaterialOfTheChosenOne) {
    const GltfBuilder b = squareOfVariants();
    const auto load = [&](const std::string& variant) {
        LoadOptions options;
        options.variant = variant;
        return testing::loadJson(b, options);
    };
    const auto materials = [&](const std::string& variant) {
        const Scene scene = load(variant);
        EXPECT_EQ(scene.variants, (std::vector<std::string>{"beach", "2", "street"}));
        EXPECT_EQ(testing::inconsistency(scene), "");
        return scene.triangleMaterials;
    };
    using Materials = std::vector<std::uint32_t>;
    EXPECT_EQ(materials(""), (Materials{0, 0, 0, 0}));
    EXPECT_EQ(materials("beach"), (Materials{1, 1, 0, 0}));
    EXPECT_EQ(materials("street"), (Materials{2, 2, 0, 0}));
    EXPECT_EQ(materials("1"), (Materials{2, 2, 0, 0}));
    EXPECT_EQ(materials("2"), (Materials{2, 2, 0, 0}));  // a name goes before a number
    // Surfaces may be cut out by their materials: octrees are kept apart.
    EXPECT_NE(load("beach").contentHash, load("").contentHash);
    EXPECT_NE(load("beach").contentHash, load("street").contentHash);
    try {
        load("snow");
        FAIL() << "loaded";
    } catch (const Error& e) {
        EXPECT_EQ(e.code, ExitCode::usage);
        EXPECT_NE(std::string(e.what()).find("\"beach\""), std::string::npos) << e.what();
    }
}

TEST(GltfMaterials, SpecularAndGlossinessAreReadWhereThereIsNothingElse) {
    GltfBuilder b = GltfBuilder::square();
    const Bytes texel = {255, 0, 0, 51};
    b.json["images"].push_back(
        {{"bufferView", b.view(testing::png(1, 1, texel))}, {"mimeType", "image/png"}});
    b.json["textures"].push_back({{"source", 0}});
    const Json old = {{"diffuseFactor", {0.1, 0.2, 0.3, 1}},
                      {"specularFactor", {0.5, 0.6, 0.7}},
                      {"glossinessFactor", 0.5},
                      {"specularGlossinessTexture", {{"index", 0}}}};
    b.json["materials"] = Json::array();
    for (const Json& metal : {Json(), Json::object(), Json{{"baseColorFactor", {1, 0, 0, 1}}}}) {
        Json& material = b.json["materials"].emplace_back(Json::object());
        material["extensions"]["KHR_materials_pbrSpecularGlossiness"] = old;
        if (!metal.is_null()) material["pbrMetallicRoughness"] = metal;
    }
    b.json["meshes"][0]["primitives"][0]["material"] = 0;
    b.json["extensionsUsed"] = {"KHR_materials_pbrSpecularGlossiness"};
    b.json["extensionsRequired"] = {"KHR_materials_pbrSpecularGlossiness"};
    const Scene scene = testing::loadJson(b);
    for (const std::size_t i : {0u, 1u}) {
        const Material& m = scene.materials.at(i);
        EXPECT_EQ(m.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 1));
        EXPECT_EQ(m.metallic, 0);
        EXPECT_NEAR(m.roughness, 1 - 0.5 * 0.2, 1e-6) << "the texture's alpha is a fifth";
        EXPECT_EQ(m.specular, 1);
        EXPECT_EQ(m.specularColor, glm::vec3(0.5f, 0, 0));
    }
    EXPECT_EQ(scene.materials.at(2).baseColor, glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(scene.materials.at(2).metallic, 1);
}

// A variant more or less is no reason to refuse a file: the primitive keeps its own material.
TEST(GltfVariants, AMaterialThatIsMissingIsLeftOut) {
    LoadOptions options;
    options.variant = "0";
    for (const bool wrong : {false, true}) {
        GltfBuilder b = squareOfVariants();
        Json& mappings = b.json["meshes"][0]["primitives"][0]["extensions"]
                               ["KHR_materials_variants"]["mappings"];
        for (Json& mapping : mappings) {
            if (wrong) mapping["material"] = 8;
            if (!wrong) mapping.erase("material");
        }
        const Scene scene = testing::loadJson(b, options);
        EXPECT_EQ(scene.triangleMaterials, testing::loadJson(b).triangleMaterials);
        EXPECT_EQ(scene.warnings.empty(), !wrong);
    }
}

TEST(GltfVariants, IndicesThatLeadNowhereAreNamed) {
    const auto errorOf = [](const std::function<void(Json&)>& change) {
        GltfBuilder b = squareOfVariants();
        change(b.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]);
        const testing::TemporaryFolder folder;
        return testing::inputError(folder.write("v.gltf", b.gltfText()));
    };
    const std::string place =
        "meshes[0].primitives[0].extensions.KHR_materials_variants.mappings[0].";
    EXPECT_NE(errorOf([](Json& e) {
                  e["mappings"][0]["variants"] = {3};
              }).find(place + "variants[0]: it refers to variant 3, but the file has 3"),
              std::string::npos);
}

TEST(DecodeImage, HalvesColoursInLinearLight) {
    // Black and white in turns: the mean of their light, 0.5, is 188 in sRGB, not 128.
    Bytes texels;
    for (int i = 0; i < 16; ++i) {
        const std::uint8_t c = i % 2 ? 255 : 0;
        texels.insert(texels.end(), {c, c, c, static_cast<std::uint8_t>(i % 2 ? 100 : 0)});
    }
    const Bytes file = testing::png(4, 4, texels);
    const DecodedImage half = decodeImage(file, 1);
    ASSERT_EQ(half.error, "");
    EXPECT_EQ(half.width, 2);
    EXPECT_EQ(half.height, 2);
    EXPECT_EQ(half.rgba,
              Bytes({188, 188, 188, 50, 188, 188, 188, 50, 188, 188, 188, 50, 188, 188, 188, 50}));
    EXPECT_EQ(decodeImage(file, 1, Texels::numbers).rgba,
              Bytes({128, 128, 128, 50, 128, 128, 128, 50, 128, 128, 128, 50, 128, 128, 128, 50}))
        << "normals and roughness are no light";
    const DecodedImage least = decodeImage(file, 5);
    EXPECT_EQ(least.width, 1);
    EXPECT_EQ(least.height, 1);
}

TEST(DecodeImage, EveryCutOfAFileIsRefusedOrWhole) {
    const Bytes whole = testing::png(5, 3, Bytes(60, 77));
    for (std::size_t length = 0; length <= whole.size(); ++length) {
        // A copy of that length alone, so that the sanitiser sees what is read past its end.
        const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
        const DecodedImage image = decodeImage(cut);
        if (length == whole.size()) {
            EXPECT_EQ(image.error, "");
        }
        if (image.error.empty()) {
            EXPECT_EQ(image.rgba, Bytes(60, 77));
            EXPECT_GE(length + 12, whole.size());  // the end mark alone may be missing
        }
    }
}

}  // namespace
}  // namespace mv
