#include "scene/round_trip.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

namespace mv::testing {
namespace {

std::uint32_t number(const Bytes& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, &bytes.at(at), sizeof(value));
    return value;
}

Json jsonOf(const Bytes& glb) {
    const auto begin = glb.begin() + 20;
    return Json::parse(begin, begin + number(glb, 12));
}

// What the standard asks for and the loader does not: containers that are not empty, alignment,
// bounds of positions, extensions that are said. "" if all is well.
std::string violation(const Bytes& glb) {
    if (number(glb, 8) != glb.size() || glb.size() % 4 != 0) return "length of the file";
    const Json json = jsonOf(glb);
    const std::size_t bin = 20 + number(glb, 12);
    const bool hasData = json.contains("buffers");
    if ((bin < glb.size()) != hasData) return "BIN chunk";
    if (hasData) {
        const auto stated = json["buffers"][0]["byteLength"].get<std::size_t>();
        if ((stated + 3) / 4 * 4 != number(glb, bin)) return "byteLength of the buffer";
    }
    for (const auto& [key, value] : json.items()) {
        if ((value.is_array() || value.is_object()) && value.empty()) return key + " is empty";
    }
    for (const Json& view : json.value("bufferViews", Json::array())) {
        if (view.value("byteOffset", 0) % 4 != 0) return "alignment";
    }
    for (const Json& accessor : json.value("accessors", Json::array())) {
        if (accessor["count"] == 0) return "count of an accessor";
    }
    const std::string text = json.dump();
    for (const char* extension :
         {"KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_unlit",
          "KHR_materials_transmission", "KHR_materials_clearcoat"}) {
        const auto used = json.value("extensionsUsed", std::vector<std::string>());
        const bool said = std::find(used.begin(), used.end(), extension) != used.end();
        const bool there = text.find(std::string("\"") + extension + "\":") != std::string::npos;
        if (said != there) return extension;
    }
    for (const Json& mesh : json.value("meshes", Json::array())) {
        for (const Json& primitive : mesh["primitives"]) {
            const auto& attributes = primitive["attributes"];
            const Json& position = json["accessors"][attributes["POSITION"].get<std::size_t>()];
            if (position["min"].size() != 3 || position["max"].size() != 3) return "bounds";
            if (attributes.contains("TEXCOORD_1") && !attributes.contains("TEXCOORD_0")) {
                return "sets of texture coordinates count from 0";
            }
        }
    }
    for (const Json& material : json.value("materials", Json::array())) {
        if (material.contains("alphaCutoff") && material.value("alphaMode", "") != "MASK") {
            return "alphaCutoff of what is no mask";
        }
        for (const Json& factor : material.value("emissiveFactor", Json::array())) {
            if (!(factor >= 0.0 && factor <= 1.0)) return "emissiveFactor";
        }
    }
    const Json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
    if (json.contains(lights)) {
        for (const Json& light : json[lights]) {
            for (const Json& c : light["color"]) {
                if (!(c >= 0.0 && c <= 1.0)) return "colour of a light";
            }
            if (light["type"] != "spot") continue;
            const Json& spot = light["spot"];
            if (!(spot["innerConeAngle"].get<double>() < spot["outerConeAngle"].get<double>())) {
                return "cones";
            }
        }
    }
    for (const Json& camera : json.value("cameras", Json::array())) {
        const Json& lens = camera[camera["type"].get<std::string>()];
        if (!(lens["znear"] > 0.0 && lens["zfar"] > lens["znear"])) return "znear, zfar";
    }
    return "";
}

void expectSameLooks(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.materials.size(), b.materials.size());
    for (std::size_t i = 0; i < a.materials.size(); ++i) {
        const Material &x = a.materials[i], &y = b.materials[i];
        SCOPED_TRACE(x.name);
        EXPECT_EQ(x.name, y.name);
        EXPECT_EQ(x.baseColor, y.baseColor);
        EXPECT_EQ(x.metallic, y.metallic);
        EXPECT_EQ(x.roughness, y.roughness);
        EXPECT_NEAR(x.specular, y.specular, 1e-6);
        EXPECT_NEAR(x.specularFactor, y.specularFactor, 1e-6);
        EXPECT_EQ(x.metallicRoughnessTexture, y.metallicRoughnessTexture);
        EXPECT_EQ(x.normalTexture, y.normalTexture);
        EXPECT_EQ(x.normalScale, y.normalScale);
        EXPECT_EQ(x.baseTexture, y.baseTexture);
        EXPECT_EQ(x.emission, y.emission);
        EXPECT_EQ(x.emissiveTexture, y.emissiveTexture);
        EXPECT_EQ(x.alphaCutoff, y.alphaCutoff);
        EXPECT_EQ(x.blends, y.blends);
        EXPECT_EQ(x.transmission, y.transmission);
        if (x.transmission > 0) {
            EXPECT_NEAR(x.index, y.index, 1e-6);
        }
        EXPECT_EQ(x.specularColor, y.specularColor);
        EXPECT_NEAR(x.thickness, y.thickness, 1e-5f * x.thickness);
        EXPECT_NEAR(x.filledIndex(), y.filledIndex(), 1e-6);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(x.attenuation()[c], y.attenuation()[c], 1e-5f);
        }
        EXPECT_EQ(x.coat, y.coat);
        EXPECT_EQ(x.coatRoughness, y.coatRoughness);
        EXPECT_EQ(x.coatTexture, y.coatTexture);
        EXPECT_EQ(x.coatNormalTexture, y.coatNormalTexture);
        EXPECT_EQ(x.coatNormalScale, y.coatNormalScale);
        EXPECT_EQ(x.doubleSided, y.doubleSided);
        EXPECT_EQ(x.unlit, y.unlit);
    }
    ASSERT_EQ(a.textures.size(), b.textures.size());
    for (std::size_t i = 0; i < a.textures.size(); ++i) {
        EXPECT_EQ(a.textures[i].image, b.textures[i].image);
        EXPECT_EQ(a.textures[i].wrapS, b.textures[i].wrapS);
        EXPECT_EQ(a.textures[i].wrapT, b.textures[i].wrapT);
        EXPECT_EQ(a.textures[i].nearest, b.textures[i].nearest);
    }
    ASSERT_EQ(a.images.size(), b.images.size());
    for (std::size_t i = 0; i < a.images.size(); ++i) {
        EXPECT_EQ(a.images[i].name, b.images[i].name);
        EXPECT_EQ(a.images[i].width, b.images[i].width);
        EXPECT_EQ(a.images[i].height, b.images[i].height);
        EXPECT_TRUE(a.images[i].rgba == b.images[i].rgba) << "image " << i;
    }
}

void expectSameLights(const SceneToSave& saved, const Scene& loaded) {
    EXPECT_FALSE(loaded.animated());
    const std::vector<PosedLight> lights = loaded.lightsAt(0, -1);
    ASSERT_EQ(lights.size(), saved.lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const PosedLight &x = saved.lights[i], &y = lights[i];
        EXPECT_EQ(x.light.name, y.light.name);
        EXPECT_EQ(x.light.type, y.light.type);
        EXPECT_EQ(x.light.intensity, y.light.intensity);
        EXPECT_EQ(x.light.isDefault, y.light.isDefault);
        EXPECT_EQ(x.position, y.position);
        EXPECT_NEAR(glm::length(x.direction - y.direction), 0, 1e-15);
        if (x.light.type != LightType::spot) continue;
        EXPECT_EQ(x.light.outerConeRad, y.light.outerConeRad);
        EXPECT_NEAR(x.light.innerConeRad, y.light.innerConeRad, 1e-8);
    }
}

void expectSameCameras(const SceneToSave& saved, const Scene& loaded) {
    const std::vector<PosedCamera> cameras = loaded.camerasAt(0, -1);
    ASSERT_EQ(cameras.size(), saved.cameras.size());
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const PosedCamera &x = saved.cameras[i], &y = cameras[i];
        SCOPED_TRACE(x.camera.name);
        EXPECT_EQ(x.camera.name, y.camera.name);
        EXPECT_EQ(x.camera.orthoHalfHeight, y.camera.orthoHalfHeight);
        if (!x.camera.orthoHalfHeight) {
            EXPECT_EQ(x.camera.yfovRad, y.camera.yfovRad);
        }
        EXPECT_EQ(x.position, y.position);
        EXPECT_NEAR(glm::length(x.forward - y.forward), 0, 1e-15);
        EXPECT_NEAR(glm::length(x.up - y.up), 0, 1e-15);
    }
}

}  // namespace

Bytes readBytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return Bytes(std::istreambuf_iterator<char>(in), {});
}

// Saves and loads; what the loader warns of is a failure.
Scene roundTrip(const SceneToSave& saved) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "saved.glb";
    saveScene(file, saved);
    EXPECT_EQ(violation(readBytes(file)), "");
    Scene loaded = loadScene(file.string());
    EXPECT_EQ(inconsistency(loaded), "");
    for (const std::string& warning : loaded.warnings) ADD_FAILURE() << warning;
    return loaded;
}

void expectSameGeometry(const Scene& a, const Scene& b) {
    EXPECT_EQ(a.root.origin, b.root.origin);
    EXPECT_EQ(a.root.edge, b.root.edge);
    ASSERT_EQ(a.triangles.size(), b.triangles.size());
    ASSERT_EQ(a.triangleMaterials, b.triangleMaterials);
    ASSERT_EQ(a.colors.empty(), b.colors.empty());
    ASSERT_EQ(a.uvs.empty(), b.uvs.empty());
    ASSERT_EQ(a.emissiveUvs.empty(), b.emissiveUvs.empty());
    for (std::size_t t = 0; t < a.triangles.size(); ++t) {
        const Material& material = a.materials[a.triangleMaterials[t]];
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t i = a.triangles[t][k], j = b.triangles[t][k];
            ASSERT_EQ(a.positions[i], b.positions[j]) << "triangle " << t;
            ASSERT_EQ(a.normals[i], b.normals[j]) << "triangle " << t;
            if (!a.colors.empty()) {
                ASSERT_EQ(a.colors[i], b.colors[j]) << "triangle " << t;
            }
            if (material.baseTexture >= 0) {
                ASSERT_EQ(a.uvs[i], b.uvs[j]) << "triangle " << t;
            }
            if (material.emissiveTexture >= 0) {
                ASSERT_EQ(a.emissiveUvs[i], b.emissiveUvs[j]) << "triangle " << t;
            }
        }
    }
}

void expectRoundTrip(const SceneToSave& saved) {
    const Scene loaded = roundTrip(saved);
    expectSameGeometry(saved.scene, loaded);
    expectSameLooks(saved.scene, loaded);
    expectSameLights(saved, loaded);
    expectSameCameras(saved, loaded);
}

}  // namespace mv::testing
