// Files damaged at random, always alike: the loader answers with a scene that holds together or
// with Error(input), and never with anything else.
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <random>

#include "scene/gltf_builder.h"

namespace mv {
namespace {

using testing::Bytes;
using testing::GltfBuilder;
using testing::Json;

// Hundreds of warnings would only hide a failure.
class Quiet {
  public:
    Quiet() : level_(spdlog::get_level()) { spdlog::set_level(spdlog::level::off); }
    ~Quiet() { spdlog::set_level(level_); }

  private:
    spdlog::level::level_enum level_;
};

// A small file that uses most of what the loader knows.
GltfBuilder rich() {
    GltfBuilder b = GltfBuilder::square();
    const Bytes image = testing::png(4, 4, Bytes(64, 130));
    Json& material = b.json["materials"][0];
    material["pbrMetallicRoughness"]["baseColorTexture"] = {
        {"index", b.texture(image)},
        {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"scale", {2, 2}}}}}}};
    material["emissiveFactor"] = {1, 1, 1};
    material["emissiveTexture"] = {{"index", 0}, {"texCoord", 0}};
    material["alphaMode"] = "MASK";
    b.json["images"].push_back({{"bufferView", b.view(image)}, {"mimeType", "image/png"}});
    b.json["textures"].push_back({{"source", 1}});
    b.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}}}}},
                        {"extensions", {{"KHR_materials_unlit", Json::object()}}}});

    // A skinned, morphed strip with sparse positions and colours.
    const int position = b.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}});
    const int targets = b.view(std::vector<std::uint16_t>{1, 3}),
              values = b.view(std::vector<glm::vec3>{{2, 0, 0}, {2, 1, 0}});
    b.json["accessors"][static_cast<std::size_t>(position)]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", targets}, {"componentType", testing::kUnsignedShort}}},
        {"values", {{"bufferView", values}}}};
    const int normal = b.positions(std::vector<glm::vec3>(5, {0, 0, 1}));
    const int color =
        b.accessor(std::vector<std::uint8_t>(20, 200), testing::kUnsignedByte, "VEC4", 5, true);
    const int uv = b.accessor(std::vector<glm::vec2>(5, {0.5f, 0.25f}), testing::kFloat, "VEC2", 5);
    const int joints =
        b.accessor(std::vector<std::uint8_t>(20, 0), testing::kUnsignedByte, "VEC4", 5);
    const int weights = b.accessor(std::vector<float>(20, 0.25f), testing::kFloat, "VEC4", 5);
    Json& strip = b.primitive({{"POSITION", position},
                               {"NORMAL", normal},
                               {"COLOR_0", color},
                               {"TEXCOORD_0", uv},
                               {"JOINTS_0", joints},
                               {"WEIGHTS_0", weights}},
                              -1, 5);
    strip["material"] = 1;
    strip["targets"] = {{{"POSITION", normal}, {"NORMAL", normal}}};
    b.json["meshes"][1]["weights"] = {0.5};
    const int bind = b.accessor(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                                testing::kFloat, "MAT4", 1);
    b.add("skins", {{"joints", {0}}, {"inverseBindMatrices", bind}});
    b.json["nodes"][1]["skin"] = 0;

    // Instances, lights, cameras, animations.
    const int instances = b.positions({{0, 0, 0}, {3, 0, 0}});
    Json& forest =
        b.node({{"mesh", 0}, {"matrix", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}}});
    forest["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = instances;
    b.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}}}}};
    b.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
    Json& lamp =
        b.node({{"camera", 0}, {"rotation", {0, 0.6, 0, 0.8}}, {"children", Json::array()}});
    lamp["extensions"]["KHR_lights_punctual"]["light"] = 0;
    const int times = b.accessor(std::vector<float>{0, 1}, testing::kFloat, "SCALAR", 2);
    const int moves = b.positions({{0, 0, 0}, {0, 1, 0}});
    const int morphs = b.accessor(std::vector<float>{0, 1}, testing::kFloat, "SCALAR", 2);
    const auto channel = [](int sampler, int node, const char* path) {
        return Json{{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}};
    };
    b.add(
        "animations",
        {{"samplers",
          {{{"input", times}, {"output", moves}}, {{"input", times}, {"output", morphs}}}},
         {"channels",
          {channel(0, 3, "translation"), channel(1, 1, "weights"), channel(0, 0, "translation")}}});
    b.json["extensionsUsed"] = {"KHR_texture_transform", "KHR_mesh_quantization"};
    return b;
}

// Loads and judges; returns whether it loaded.
bool survives(const testing::TemporaryFolder& folder, const std::string& name, const Bytes& bytes) {
    const std::string path = folder.write(name, bytes);
    LoadOptions options;
    options.timeS = 0.5;
    try {
        const Scene scene = loadScene(path, options);
        EXPECT_EQ(testing::inconsistency(scene), "");
        return true;
    } catch (const Error& e) {
        EXPECT_EQ(e.code, ExitCode::input) << e.what();
        EXPECT_NE(std::string(e.what()).find(name), std::string::npos) << e.what();
    }
    return false;
}

TEST(GltfFuzz, TheUndamagedFileLoads) {
    const testing::TemporaryFolder folder;
    const Scene scene = loadScene(folder.write("rich.glb", rich().glb()));
    EXPECT_EQ(testing::inconsistency(scene), "");
    EXPECT_EQ(scene.triangles.size(), 9u);
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.images.size(), 2u);
    EXPECT_TRUE(scene.animated());
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
}

TEST(GltfFuzz, BytesChangedAnywhere) {
    const Quiet quiet;
    const testing::TemporaryFolder folder;
    const Bytes whole = rich().glb();
    std::mt19937 random(20);
    int loaded = 0;
    for (int round = 0; round < 400; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        Bytes bytes = whole;
        const std::size_t changes = 1 + random() % 4;
        for (std::size_t i = 0; i < changes; ++i) {
            bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
        }
        loaded += survives(folder, "bytes.glb", bytes);
    }
    EXPECT_GT(loaded, 20);  // else the damage never gets past the front door
    EXPECT_LT(loaded, 380);
}

TEST(GltfFuzz, BinaryDataChanged) {
    // Indices, floats, images: all of this the JSON knows nothing of.
    const Quiet quiet;
    const testing::TemporaryFolder folder;
    const GltfBuilder whole = rich();
    std::mt19937 random(21);
    int loaded = 0;
    for (int round = 0; round < 200; ++round) {
        SCOPED_TRACE("round " + std::to_string(round));
        GltfBuilder b = whole;
        const std::size_t first = random() % b.binary.size();
        const std::size_t length =
            std::min<std::size_t>(1 + random() % 40, b.binary.size() - first);
        for (std::size_t i = 0; i < length; ++i) {
            b.binary[first + i] = static_cast<std::uint8_t>(random() % 3 ? 0xff : random());
        }
        loaded += survives(folder, "data.glb", b.glb());
    }
    EXPECT_GT(loaded, 20);
    EXPECT_LT(loaded, 200);
}

// All values of a document, however deep.
void collect(Json& value, std::vector<Json*>& all) {
    all.push_back(&value);
    if (value.is_structured()) {
        for (Json& child : value) collect(child, all);
    }
}

TEST(GltfFuzz, JsonValuesReplaced) {
    const Quiet quiet;
    const testing::TemporaryFolder folder;
    const GltfBuilder whole = rich();
    const std::vector<Json> strange = {-1,
                                       0,
                                       1,
                                       2,
                                       7,
                                       255,
                                       5120,
                                       1e30,
                                       -0.5,
                                       4294967295u,
                                       4294967296,
                                       9007199254740993,
                                       18446744073709551615u,
                                       1.7976931348623157e308,
                                       nullptr,
                                       true,
                                       "",
                                       "MAT4",
                                       "../../x",
                                       Json::array(),
                                       Json::object(),
                                       Json::array({0, 0, 0}),
                                       Json::array({-1, 99, "x", nullptr})};
    std::mt19937 random(22);
    int loaded = 0;
    for (int round = 0; round < 800; ++round) {
        GltfBuilder b = whole;
        std::string what;
        for (std::size_t i = 0; i < 1 + random() % 2; ++i) {
            std::vector<Json*> all;
            collect(b.json, all);
            Json& value = *all[1 + random() % (all.size() - 1)];
            const Json& replacement = strange[random() % strange.size()];
            what += value.dump() + " -> " + replacement.dump() + "; ";
            value = replacement;
        }
        SCOPED_TRACE("round " + std::to_string(round) + ": " + what);
        const std::string text = b.gltfText();
        loaded += survives(folder, "json.gltf", Bytes(text.begin(), text.end()));
    }
    EXPECT_GT(loaded, 80);
    EXPECT_LT(loaded, 750);
}

TEST(GltfFuzz, MembersErased) {
    const Quiet quiet;
    const testing::TemporaryFolder folder;
    GltfBuilder whole = rich();
    std::vector<Json*> all;
    collect(whole.json, all);
    // Every member of every object, one at a time.
    std::size_t members = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!all[i]->is_object()) continue;
        for (std::size_t m = 0; m < all[i]->size(); ++m, ++members) {
            GltfBuilder b = whole;
            std::vector<Json*> copies;
            collect(b.json, copies);
            auto member = copies[i]->begin();
            std::advance(member, static_cast<std::ptrdiff_t>(m));
            SCOPED_TRACE("without " + member.key() + " of " + copies[i]->dump());
            copies[i]->erase(member);
            survives(folder, "member.glb", b.glb());
        }
    }
    EXPECT_GT(members, 150u);
}

TEST(GltfFuzz, EveryCutOfAFile) {
    const Quiet quiet;
    const testing::TemporaryFolder folder;
    const GltfBuilder b = GltfBuilder::square();
    const Bytes glb = b.glb();
    const std::string gltf = b.gltfText();
    for (std::size_t length = 0; length < glb.size(); length += 7) {
        EXPECT_FALSE(
            survives(folder, "cut.glb",
                     Bytes(glb.begin(), glb.begin() + static_cast<std::ptrdiff_t>(length))));
    }
    for (std::size_t length = 0; length < gltf.size(); length += 13) {
        EXPECT_FALSE(
            survives(folder, "cut.gltf",
                     Bytes(gltf.begin(), gltf.begin() + static_cast<std::ptrdiff_t>(length))));
    }
}

}  // namespace
}  // namespace mv
