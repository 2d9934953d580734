// Files that are broken, each in one way: the loader says file, place and reason, or goes on with
// a warning, and never crashes.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "scene/gltf_builder.h"

namespace mv {
namespace {

using testing::Bytes;
using testing::GltfBuilder;
using testing::Json;
using testing::TemporaryFolder;

enum class Answer { error, warning, loads };

struct BadCase {
    std::string name;  // of the file
    Answer answer;
    std::vector<std::string> words;  // that the sentence must contain, besides the file's name
    std::function<void(const TemporaryFolder&, const std::string& name)> write;
};

// A square whose JSON is changed, as .gltf with its buffer in a data URI.
auto changed(std::function<void(GltfBuilder&)> change) {
    return [change](const TemporaryFolder& folder, const std::string& name) {
        GltfBuilder b = GltfBuilder::square();
        change(b);
        folder.write(name, b.gltfText());
    };
}

const std::string kLfsPointer =
    "version https://git-lfs.github.com/spec/v1\n"
    "oid sha256:595e1652abb099a527f03277ce1379bb9cb7214bb376ce8f5aa44003e6fbdc4a\n"
    "size 125449772\n";

auto rawText(const std::string& text) {
    return [text](const TemporaryFolder& folder, const std::string& name) {
        folder.write(name, text);
    };
}

auto rawBytes(const Bytes& bytes) {
    return [bytes](const TemporaryFolder& folder, const std::string& name) {
        folder.write(name, bytes);
    };
}

auto withBufferUri(const std::string& uri) {
    return changed([uri](GltfBuilder& b) {
        b.json["buffers"] = {{{"byteLength", b.binary.size()}, {"uri", uri}}};
    });
}

auto withPositions(const std::vector<glm::vec3>& positions) {
    return [positions](const TemporaryFolder& folder, const std::string& name) {
        GltfBuilder b = GltfBuilder::square();
        std::memcpy(b.binary.data(), positions.data(), 4 * sizeof(glm::vec3));
        folder.write(name, b.glb());
    };
}

Bytes goodGlb() { return GltfBuilder::square().glb(); }

Bytes glbWith(const std::string& magic, std::uint32_t version, int jsonExtra,
              std::int64_t binLength) {
    GltfBuilder b = GltfBuilder::square();
    b.json["buffers"] = {{{"byteLength", b.binary.size()}}};
    return testing::makeGlb(b.json.dump(), b.binary, magic, version, jsonExtra, binLength);
}

Json& materialOf(GltfBuilder& b) { return b.json["materials"][0]["pbrMetallicRoughness"]; }

void useImage(GltfBuilder& b, const std::string& uri) {
    b.add("images", {{"uri", uri}});
    b.add("textures", {{"source", 0}});
    materialOf(b)["baseColorTexture"] = {{"index", 0}};
}

std::vector<BadCase> badCases() {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    const Bytes good = goodGlb();
    const std::vector<std::uint8_t> texels(16, 255);
    const Bytes image = testing::png(2, 2, texels);
    std::vector<BadCase> cases;
    const auto add = [&](std::string name, Answer answer, std::vector<std::string> words,
                         auto write) {
        cases.push_back({std::move(name), answer, std::move(words), write});
    };
    const auto e = Answer::error;
    const auto w = Answer::warning;

    // Container.
    add("zero-byte.glb", e, {"empty"}, rawText(""));
    add("zero-byte.gltf", e, {"empty"}, rawText(""));
    add("truncated.glb", e, {"cut short", std::to_string(good.size())},
        rawBytes(Bytes(good.begin(), good.end() - 70)));
    add("truncated-header.glb", e, {"header is incomplete"},
        rawBytes(Bytes(good.begin(), good.begin() + 9)));
    add("two-bytes.glb", e, {"header is incomplete"}, rawText("gl"));
    add("header-only.glb", e, {"no JSON chunk"},
        rawBytes({'g', 'l', 'T', 'F', 2, 0, 0, 0, 12, 0, 0, 0}));
    add("wrong-magic.glb", e, {"not a GLB", "glTX"}, rawBytes(glbWith("glTX", 2, 0, -1)));
    add("wrong-version.glb", e, {"version 7", "only version 2"},
        rawBytes(glbWith("glTF", 7, 0, -1)));
    add("wrong-chunk-length.glb", e, {"chunk 0", "past the end"},
        rawBytes(glbWith("glTF", 2, 0x7fff0000, -1)));
    add("wrong-bin-chunk-length.glb", e, {"chunk 1", "4294967292", "past the end"},
        rawBytes(glbWith("glTF", 2, 0, 0xfffffffc)));
    add("not-json.gltf", e, {"parse error", "line 1, column 42"},
        rawText(R"({"asset": {"version": "2.0"}, "scenes": [)"));
    add("number-overflow.gltf", e, {"JSON"},
        rawText(R"({"asset":{"version":"2.0"},"scene":1e999})"));
    add("deep-json.gltf", e, {"nested"},
        rawText(R"({"asset":{"version":"2.0"},"extras":)" + std::string(100000, '[') +
                std::string(100000, ']') + "}"));
    add("array.gltf", e, {"object"}, rawText("[1, 2, 3]"));
    add("no-asset.gltf", e, {"asset"}, rawText("{}"));
    add("version-1.gltf", e, {"asset.version", "1.0", "2.x"},
        changed([](GltfBuilder& b) { b.json["asset"]["version"] = "1.0"; }));
    add("min-version.gltf", e, {"asset.minVersion", "2.5"},
        changed([](GltfBuilder& b) { b.json["asset"]["minVersion"] = "2.5"; }));
    add("directory.gltf", e, {"folder"},
        [](const TemporaryFolder& folder, const std::string& name) {
            std::filesystem::create_directory(folder.path() / name);
        });
    add("absent.gltf", e, {"no such file"}, [](const TemporaryFolder&, const std::string&) {});
    add("text.obj", e, {"neither"}, rawText("v 0 0 0\n"));
    add("not-fetched.glb", e, {"Git LFS"}, rawText(kLfsPointer));

    // Buffers.
    add("missing-buffer-file.gltf", e, {"buffers[0]", "this-file-does-not-exist.bin"},
        withBufferUri("this-file-does-not-exist.bin"));
    add("buffer-not-fetched.gltf", e, {"buffers[0]", "large.bin", "Git LFS"},
        [](const TemporaryFolder& folder, const std::string& name) {
            folder.write("large.bin", kLfsPointer);
            withBufferUri("large.bin")(folder, name);
        });
    add("path-traversal.gltf", e, {"buffers[0]", "refused"},
        withBufferUri("../../../../../../etc/passwd"));
    add("path-traversal-encoded.gltf", e, {"buffers[0]", "refused"},
        withBufferUri("%2e%2e/README.md"));
    add("path-traversal-inside.gltf", e, {"buffers[0]", "refused"}, withBufferUri("a/../../b.bin"));
    add("path-backslash.gltf", e, {"buffers[0]", "refused"}, withBufferUri("..\\b.bin"));
    add("path-absolute.gltf", e, {"buffers[0]", "refused"}, withBufferUri("/etc/passwd"));
    add("path-nul.gltf", e, {"buffers[0]", "refused"}, withBufferUri("a%00b"));
    add("path-http.gltf", e, {"buffers[0]", "not a file"},
        withBufferUri("https://example.org/a.bin"));
    add("bad-percent.gltf", e, {"buffers[0]", "percent"}, withBufferUri("a%zz.bin"));
    add("bad-base64.gltf", e, {"buffers[0]", "cannot be decoded"},
        withBufferUri("data:application/octet-stream;base64,@@@@****not-base64"));
    add("short-file.gltf", e, {"buffers[0]", "short.bin", "fewer"},
        [](const TemporaryFolder& folder, const std::string& name) {
            folder.write("short.bin", std::string("12345678"));
            withBufferUri("short.bin")(folder, name);
        });
    add("huge-buffer.gltf", e, {"buffers[0]", "1000000000000000"}, changed([](GltfBuilder& b) {
            b.json["buffers"] = {
                {{"byteLength", 1000000000000000}, {"uri", testing::dataUri(b.binary)}}};
        }));
    add("no-uri.gltf", e, {"buffers[0]", "uri"}, changed([](GltfBuilder& b) {
            b.json["buffers"] = {{{"byteLength", b.binary.size()}}};
        }));
    add("negative-byteoffset.gltf", e, {"bufferViews[0].byteOffset", "negative"},
        changed([](GltfBuilder& b) { b.json["bufferViews"][0]["byteOffset"] = -12; }));
    add("bufferview-out-of-range.gltf", e, {"bufferViews[0]", "100000"},
        changed([](GltfBuilder& b) { b.json["bufferViews"][0]["byteLength"] = 100000; }));
    add("bufferview-overflow.gltf", e, {"bufferViews[0]"}, changed([](GltfBuilder& b) {
            b.json["bufferViews"][0]["byteLength"] = 9007199254740991;
            b.json["bufferViews"][0]["byteOffset"] = 9007199254740991;
        }));
    add("bad-stride.gltf", e, {"bufferViews[0].byteStride", "multiple of 4"},
        changed([](GltfBuilder& b) { b.json["bufferViews"][0]["byteStride"] = 13; }));
    add("small-stride.gltf", e, {"accessors[0]", "byteStride"},
        changed([](GltfBuilder& b) { b.json["bufferViews"][0]["byteStride"] = 4; }));
    add("dangling-buffer.gltf", e, {"bufferViews[0].buffer", "buffer 3"},
        changed([](GltfBuilder& b) { b.json["bufferViews"][0]["buffer"] = 3; }));

    // Accessors and indices.
    add("accessor-out-of-range.gltf", e, {"accessors[0]", "4000"},
        changed([](GltfBuilder& b) { b.json["accessors"][0]["count"] = 4000; }));
    add("huge-count.gltf", e, {"accessors[0]", "4000000000"},
        changed([](GltfBuilder& b) { b.json["accessors"][0]["count"] = 4000000000; }));
    add("huge-count-no-view.gltf", e, {"accessors[0]", "4000000000"}, changed([](GltfBuilder& b) {
            b.json["accessors"][0].erase("bufferView");
            b.json["accessors"][0]["count"] = 4000000000;
        }));
    add("accessor-offset.gltf", e, {"accessors[0]"},
        changed([](GltfBuilder& b) { b.json["accessors"][0]["byteOffset"] = 4; }));
    add("accessor-index-out-of-range.gltf", e, {"meshes[0]", "POSITION", "99"},
        changed([](GltfBuilder& b) { b.primitive()["attributes"]["POSITION"] = 99; }));
    add("component-type.gltf", e, {"accessors[0].componentType"},
        changed([](GltfBuilder& b) { b.json["accessors"][0]["componentType"] = 5124; }));
    add("accessor-type.gltf", e, {"accessors[0].type", "VEC5"},
        changed([](GltfBuilder& b) { b.json["accessors"][0]["type"] = "VEC5"; }));
    add("count-string.gltf", e, {"accessors[0].count"},
        changed([](GltfBuilder& b) { b.json["accessors"][0]["count"] = "four"; }));
    for (const char* key : {"POSITION", "indices"}) {
        add(std::string("empty-") + key + ".gltf", w, {"meshes", "1 primitives have no positions"},
            changed([key](GltfBuilder& b) {
                Json second = b.primitive();
                b.json["accessors"].push_back({{"componentType", testing::kFloat},
                                               {"type", "VEC3"},
                                               {"count", 0},
                                               {"max", {nullptr, nullptr, nullptr}}});
                Json& owner = *key == 'P' ? second["attributes"] : second;
                owner[key] = b.json["accessors"].size() - 1;
                b.json["meshes"][0]["primitives"].push_back(second);
            }));
    }
    add("empty-coordinates.gltf", e, {"TEXCOORD_0", "accessors[1]", "no elements"},
        changed([](GltfBuilder& b) { b.json["accessors"][1]["count"] = 0; }));
    add("float-indices.gltf", e, {"meshes[0]", "indices"}, changed([](GltfBuilder& b) {
            const int index = b.accessor(std::vector<float>{0, 1, 2}, testing::kFloat, "SCALAR", 3);
            b.primitive()["indices"] = index;
        }));
    add("float-joints.gltf", e, {"meshes[0]", "JOINTS_0", "unsigned"}, changed([](GltfBuilder& b) {
            b.primitive()["attributes"]["JOINTS_0"] =
                b.accessor(std::vector<float>(16, 0), testing::kFloat, "VEC4", 4);
        }));
    add("attribute-counts.gltf", e, {"meshes[0]", "TEXCOORD_0", "3"},
        changed([](GltfBuilder& b) { b.json["accessors"][1]["count"] = 3; }));
    add("sparse-index.gltf", e, {"accessors[0].sparse", "77"}, changed([](GltfBuilder& b) {
            const int indices = b.view(std::vector<std::uint32_t>{77});
            const int values = b.view(std::vector<glm::vec3>{{0, 0, 0}});
            b.json["accessors"][0]["sparse"] = {
                {"count", 1},
                {"indices", {{"bufferView", indices}, {"componentType", testing::kUnsignedInt}}},
                {"values", {{"bufferView", values}}}};
        }));
    add("sparse-values.gltf", e, {"accessors[0].sparse.values"}, changed([](GltfBuilder& b) {
            const int indices = b.view(std::vector<std::uint32_t>{0, 1});
            const int values = b.view(std::vector<glm::vec3>{{0, 0, 0}});
            b.json["accessors"][0]["sparse"] = {
                {"count", 2},
                {"indices", {{"bufferView", indices}, {"componentType", testing::kUnsignedInt}}},
                {"values", {{"bufferView", values}}}};
        }));
    add("index-out-of-range.glb", e, {"meshes[0]", "60000"}, changed([](GltfBuilder& b) {
            const std::uint16_t far = 60000;
            std::memcpy(b.binary.data() + b.binary.size() - 2, &far, 2);
        }));
    cases.back().write = [](const TemporaryFolder& folder, const std::string& name) {
        GltfBuilder b = GltfBuilder::square();
        const std::uint16_t far = 60000;
        std::memcpy(b.binary.data() + b.binary.size() - 2, &far, 2);
        folder.write(name, b.glb());
    };
    add("position-vec2.gltf", e, {"POSITION", "VEC3"},
        changed([](GltfBuilder& b) { b.json["accessors"][0]["type"] = "VEC2"; }));
    add("position-bytes.gltf", e, {"POSITION", "VEC3 of floats"},
        changed([](GltfBuilder& b) { b.json["accessors"][0]["componentType"] = testing::kShort; }));
    add("mode-7.gltf", e, {"meshes[0].primitives[0].mode"},
        changed([](GltfBuilder& b) { b.primitive()["mode"] = 7; }));
    add("index-count-not-multiple-of-3.gltf", w, {"meshes[0]", "2 indices"},
        changed([](GltfBuilder& b) { b.json["accessors"][2]["count"] = 5; }));
    add("nan-inf-positions.glb", w, {"2 triangles", "NaN"},
        withPositions({{0, 0, 0}, {nan, 0, 0}, {1, inf, 0}, {0, 1, -inf}}));
    add("zero-area-only.glb", w, {"2 triangles have no area"},
        withPositions({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}));
    add("draco-used.gltf", e,
        {"primitives[0].extensions.KHR_draco_mesh_compression.attributes", "missing"},
        changed([](GltfBuilder& b) {
            b.json["accessors"][0].erase("bufferView");
            b.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
        }));

    // Nodes and scenes.
    add("cyclic-nodes.gltf", e, {"cycle", "0 -> 1 -> 2 -> 0"}, changed([](GltfBuilder& b) {
            b.json["nodes"] = {
                {{"mesh", 0}, {"children", {1}}}, {{"children", {2}}}, {{"children", {0}}}};
        }));
    add("self-cycle.gltf", e, {"cycle", "1 -> 1"}, changed([](GltfBuilder& b) {
            b.json["nodes"] = {{{"mesh", 0}}, {{"children", {1}}}};
        }));
    add("deep-nodes.gltf", Answer::loads, {}, changed([](GltfBuilder& b) {
            b.json["nodes"] = Json::array();
            for (int i = 0; i < 20000; ++i) b.json["nodes"].push_back({{"children", {i + 1}}});
            b.json["nodes"].push_back({{"mesh", 0}});
        }));
    add("child-twice.gltf", w, {"nodes[0].children[1]", "node 1"}, changed([](GltfBuilder& b) {
            b.json["nodes"] = {{{"children", {1, 1}}}, {{"mesh", 0}}};
        }));
    add("two-parents.gltf", w, {"nodes[1].children[0]", "node 2"}, changed([](GltfBuilder& b) {
            b.json["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
            b.json["scenes"][0]["nodes"] = {0, 1};
        }));
    add("child-out-of-range.gltf", e, {"nodes[0].children[0]", "9"},
        changed([](GltfBuilder& b) { b.json["nodes"][0]["children"] = {9}; }));
    add("mesh-index-out-of-range.gltf", e, {"nodes[0]", "mesh 7"},
        changed([](GltfBuilder& b) { b.json["nodes"][0]["mesh"] = 7; }));
    add("negative-mesh.gltf", e, {"nodes[0].mesh", "negative"},
        changed([](GltfBuilder& b) { b.json["nodes"][0]["mesh"] = -1; }));
    add("camera-index.gltf", e, {"nodes[0].camera"},
        changed([](GltfBuilder& b) { b.json["nodes"][0]["camera"] = 0; }));
    add("skin-index.gltf", e, {"nodes[0].skin"},
        changed([](GltfBuilder& b) { b.json["nodes"][0]["skin"] = 2; }));
    add("light-index.gltf", e, {"light 4"}, changed([](GltfBuilder& b) {
            b.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 4;
        }));
    add("short-matrix.gltf", e, {"nodes[0].matrix", "16"}, changed([](GltfBuilder& b) {
            b.json["nodes"][0]["matrix"] = {1, 0, 0};
        }));
    add("empty-scene.gltf", w, {"scenes[0]", "empty"}, changed([](GltfBuilder& b) {
            b.json["scenes"] = {{{"name", "empty"}}};
        }));
    add("no-scenes.gltf", w, {"no scene"}, rawText(R"({"asset":{"version":"2.0"}})"));
    add("nodes-without-scene.gltf", w, {"no scene"}, changed([](GltfBuilder& b) {
            b.json.erase("scenes");
            b.json.erase("scene");
        }));
    add("scene-out-of-range.gltf", e, {"scene 3"},
        changed([](GltfBuilder& b) { b.json["scene"] = 3; }));
    add("root-out-of-range.gltf", e, {"scenes[0].nodes[0]"},
        changed([](GltfBuilder& b) { b.json["scenes"][0]["nodes"] = {5}; }));
    add("zero-scale-matrix.glb", w, {"nodes[0]", "cannot be inverted"},
        [](const TemporaryFolder& folder, const std::string& name) {
            GltfBuilder b = GltfBuilder::square();
            std::vector<double> matrix(16, 0.0);
            matrix[15] = 1;
            b.json["nodes"][0]["matrix"] = matrix;
            folder.write(name, b.glb());
        });

    // Skins and animations.
    add("empty-skin.gltf", e, {"skins[0].joints"}, changed([](GltfBuilder& b) {
            b.add("skins", {{"joints", Json::array()}});
        }));
    add("joint-out-of-range.gltf", e, {"skins[0].joints[0]", "8"}, changed([](GltfBuilder& b) {
            b.add("skins", {{"joints", {8}}});
        }));
    add("few-bind-matrices.gltf", e, {"skins[0].inverseBindMatrices"}, changed([](GltfBuilder& b) {
            const int m = b.accessor(std::vector<float>(16, 1.0f), testing::kFloat, "MAT4", 1);
            b.add("skins", {{"joints", {0, 0}}, {"inverseBindMatrices", m}});
        }));
    add("keys-and-values.gltf", e, {"animations[0].samplers[0].output"},
        changed([](GltfBuilder& b) {
            const int times = b.accessor(std::vector<float>{0, 1}, testing::kFloat, "SCALAR", 2);
            const int values = b.positions({{0, 0, 0}});
            b.add("animations",
                  {{"samplers", {{{"input", times}, {"output", values}}}},
                   {"channels",
                    {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
        }));
    add("times-descend.gltf", w, {"animations[0].samplers[0].input"}, changed([](GltfBuilder& b) {
            const int times = b.accessor(std::vector<float>{1, 0}, testing::kFloat, "SCALAR", 2);
            const int values = b.positions({{0, 0, 0}, {1, 0, 0}});
            b.add("animations",
                  {{"samplers", {{{"input", times}, {"output", values}}}},
                   {"channels",
                    {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
        }));

    // Materials, textures, extensions, names.
    add("material-index.gltf", w, {"meshes[0].primitives[0].material", "4"},
        changed([](GltfBuilder& b) { b.primitive()["material"] = 4; }));
    add("texture-index-out-of-range.gltf", w, {"materials[0]", "texture 5"},
        changed([](GltfBuilder& b) {
            materialOf(b)["baseColorTexture"] = {{"index", 5}};
        }));
    add("texture-source.gltf", w, {"textures[0].source", "6"}, changed([](GltfBuilder& b) {
            b.add("textures", {{"source", 6}});
            materialOf(b)["baseColorTexture"] = {{"index", 0}};
        }));
    add("absent-texture-file.gltf", w, {"images[0]", "no-such-texture.png"},
        changed([](GltfBuilder& b) { useImage(b, "no-such-texture.png"); }));
    add("image-outside.gltf", w, {"images[0]", "refused"},
        changed([](GltfBuilder& b) { useImage(b, "../secret.png"); }));
    add("corrupt-image.gltf", w, {"images[0]", "decoded"}, changed([image](GltfBuilder& b) {
            useImage(b, testing::dataUri(std::span(image).first(45), "image/png"));
        }));
    add("not-an-image.gltf", w, {"images[0]", "neither PNG, JPEG nor WebP"},
        changed([](GltfBuilder& b) { useImage(b, testing::dataUri(Bytes(64, 7), "image/png")); }));
    add("webp-image.gltf", w, {"images[0]", "its WebP header is damaged"},
        changed([](GltfBuilder& b) {
            const std::string text = "RIFF1234WEBPVP8 rest of it";
            useImage(b, testing::dataUri(Bytes(text.begin(), text.end()), "image/webp"));
        }));
    add("huge-image.gltf", w, {"images[0]", "30000 x 30000"}, changed([](GltfBuilder& b) {
            Bytes huge = testing::pngHeader(30000, 30000);
            const Bytes rest = {0, 0, 0, 0, 'I', 'D', 'A', 'T', 0, 0, 0, 0};
            huge.insert(huge.end(), rest.begin(), rest.end());
            useImage(b, testing::dataUri(huge, "image/png"));
        }));
    // Either side would do, the area would not.
    add("large-image.gltf", w, {"images[0]", "12000 x 12000"}, changed([](GltfBuilder& b) {
            useImage(b, testing::dataUri(testing::pngHeader(12000, 12000), "image/png"));
        }));
    add("image-view-out-of-range.gltf", w, {"images[0]", "bufferView"}, changed([](GltfBuilder& b) {
            useImage(b, "");
            b.json["images"][0] = {{"bufferView", b.json["bufferViews"].size()}};
        }));
    add("bad-colour-factor.gltf", w, {"materials[0]", "baseColorFactor"},
        changed([](GltfBuilder& b) {
            materialOf(b)["baseColorFactor"] = {2, -1, "red"};
        }));
    add("colour-out-of-range.gltf", w, {"baseColorFactor", "clamped"}, changed([](GltfBuilder& b) {
            materialOf(b)["baseColorFactor"] = {2, -1, 0.5, 1};
        }));
    add("alpha-mode.gltf", w, {"materials[0].alphaMode"},
        changed([](GltfBuilder& b) { b.json["materials"][0]["alphaMode"] = "MAYBE"; }));
    add("material-number.gltf", w, {"materials[0]", "object"},
        changed([](GltfBuilder& b) { b.json["materials"][0] = 5; }));
    add("sampler-wrap.gltf", w, {"samplers[0].wrapS"}, changed([](GltfBuilder& b) {
            b.add("samplers", {{"wrapS", 3}});
        }));
    add("camera-yfov.gltf", w, {"cameras[0].perspective.yfov"}, changed([](GltfBuilder& b) {
            b.add("cameras",
                  {{"type", "perspective"}, {"perspective", {{"yfov", 0}, {"znear", 1}}}});
        }));
    add("light-type.gltf", w, {"lights[0].type"}, changed([](GltfBuilder& b) {
            b.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "laser"}}};
        }));
    add("unknown-required-extension.gltf", e, {"XYZ_does_not_exist"},
        changed([](GltfBuilder& b) { b.json["extensionsRequired"] = {"XYZ_does_not_exist"}; }));
    add("several-required.gltf", e,
        {"KHR_meshopt_compression", "KHR_texture_basisu", "EXT_texture_avif"},
        changed([](GltfBuilder& b) {
            b.json["extensionsRequired"] = {"KHR_meshopt_compression", "KHR_texture_transform",
                                            "KHR_texture_basisu", "EXT_texture_avif"};
        }));
    // Refused for what it requires before anything else in it is looked at.
    add("required-first.gltf", e, {"KHR_meshopt_compression"}, changed([](GltfBuilder& b) {
            b.json["extensionsRequired"] = {"KHR_meshopt_compression"};
            b.json["buffers"] = {{{"byteLength", -5}}};
            b.json["nodes"] = 7;
        }));
    add("required-first.glb", e, {"KHR_texture_basisu"},
        [](const TemporaryFolder& folder, const std::string& name) {
            GltfBuilder b;
            b.json["extensionsRequired"] = {"KHR_texture_basisu"};
            b.json["meshes"] = "none";
            folder.write(name, b.glb());
        });
    add("non-utf8-name.gltf", w, {"UTF-8"},
        [](const TemporaryFolder& folder, const std::string& name) {
            GltfBuilder b = GltfBuilder::square();
            b.json["nodes"][0]["name"] = "NAME";
            std::string text = b.gltfText();
            text.replace(text.find("NAME"), 4, "bad \xff\xfe\xc3\x28 name");
            folder.write(name, text);
        });
    return cases;
}

class GltfBad : public ::testing::TestWithParam<BadCase> {};

TEST_P(GltfBad, GetsItsAnswer) {
    const BadCase& bad = GetParam();
    const TemporaryFolder folder;
    bad.write(folder, bad.name);
    const std::string path = (folder.path() / bad.name).string();

    std::string sentence;
    if (bad.answer == Answer::error) {
        sentence = testing::inputError(path);
        ASSERT_NE(sentence, "") << "loaded without an error";
    } else {
        const Scene scene = loadScene(path);
        EXPECT_EQ(testing::inconsistency(scene), "");
        for (const std::string& warning : scene.warnings) sentence += warning + "\n";
    }
    if (bad.answer == Answer::loads) {
        EXPECT_EQ(sentence, "");
        return;
    }
    EXPECT_NE(sentence.find(bad.name), std::string::npos) << sentence;
    for (const std::string& word : bad.words) {
        EXPECT_NE(sentence.find(word), std::string::npos) << "no " << word << " in: " << sentence;
    }
    // Printable whatever the file holds.
    EXPECT_TRUE(std::none_of(sentence.begin(), sentence.end(), [](char c) {
        return static_cast<unsigned char>(c) < 0x20 && c != '\n';
    }));
}

INSTANTIATE_TEST_SUITE_P(Files, GltfBad, ::testing::ValuesIn(badCases()), [](const auto& test) {
    std::string name = test.param.name;
    for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return name;
});

TEST(GltfBadTolerated, KeepsWhatCanBeDrawn) {
    // One triangle of two is whole, in both ways of losing the other.
    GltfBuilder b = GltfBuilder::square();
    b.json["accessors"][2]["count"] = 5;
    EXPECT_EQ(testing::loadJson(b).triangles.size(), 1u);

    GltfBuilder nan = GltfBuilder::square();
    const float bad = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(nan.binary.data() + 3 * sizeof(glm::vec3), &bad, sizeof bad);
    const Scene scene = testing::loadJson(nan);
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(scene.positions.size(), 3u);
    EXPECT_NEAR(testing::worldBox(scene).second.x, 1, 1e-6);
}

TEST(GltfBadTolerated, DrawsAChildThatIsListedTwiceOnce) {
    GltfBuilder b = GltfBuilder::square();
    b.json["nodes"] = {{{"children", {1, 1}}}, {{"mesh", 0}}};
    EXPECT_EQ(testing::loadJson(b).triangles.size(), 2u);
}

TEST(GltfBadTolerated, TakesWhiteForABadColour) {
    GltfBuilder b = GltfBuilder::square();
    materialOf(b)["baseColorFactor"] = {2, -1, "red"};
    EXPECT_EQ(testing::loadJson(b).materials[0].baseColor, glm::vec4(1));
}

TEST(GltfBadTolerated, RefusesWhatExpandsBeyondMeasure) {
    // A few kilobytes that stand for 10^12 triangles: instances of instances of a large mesh.
    GltfBuilder b;
    const int position = b.accessor(-1, testing::kFloat, "VEC3", 1 << 22);
    b.primitive({{"POSITION", position}});
    const Json node = b.json["nodes"][0];
    for (int i = 0; i < 1000; ++i) b.node(node);
    const TemporaryFolder folder;
    b.json["buffers"] = Json::array();
    const std::string error = testing::inputError(folder.write("bomb.gltf", b.gltfText()));
    EXPECT_NE(error.find("expands"), std::string::npos) << error;
}

TEST(GltfBadTolerated, RefusesAttributesThatTheFileHasNoBytesFor) {
    // One long accessor of zeros that stands for a hundred morph targets.
    GltfBuilder b;
    const int zeros = b.accessor(-1, testing::kFloat, "VEC3", 1 << 22);
    Json& primitive = b.primitive({{"POSITION", zeros}});
    for (int i = 0; i < 100; ++i) primitive["targets"].push_back({{"POSITION", zeros}});
    const TemporaryFolder folder;
    const std::string error = testing::inputError(folder.write("bomb.gltf", b.gltfText()));
    EXPECT_NE(error.find("attributes expand"), std::string::npos) << error;
}

TEST(GltfBadTolerated, VerticesOfNoTriangleAreNotKept) {
    GltfBuilder b = GltfBuilder::square();
    b.json["accessors"][2]["count"] = 3;
    const int normal = b.positions(std::vector<glm::vec3>(4, {0, 0, 1}));
    b.primitive()["attributes"]["NORMAL"] = normal;
    const Scene scene = testing::loadJson(b);
    EXPECT_EQ(scene.positions.size(), 3u);
    EXPECT_EQ(testing::inconsistency(scene), "");
}

TEST(GltfBadTolerated, RefusesASceneNumberThatTheFileLacksAsUsage) {
    const TemporaryFolder folder;
    const std::string path = folder.write("square.gltf", GltfBuilder::square().gltfText());
    LoadOptions options;
    options.sceneIndex = 1;
    try {
        loadScene(path, options);
        FAIL() << "loaded";
    } catch (const Error& e) {
        EXPECT_EQ(e.code, ExitCode::usage);
    }
}

TEST(GltfBadTolerated, CallerMayCancel) {
    const TemporaryFolder folder;
    const std::string path = folder.write("square.gltf", GltfBuilder::square().gltfText());
    LoadOptions options;
    options.progress = [](std::string_view, float) { throw Cancelled(); };
    EXPECT_THROW(loadScene(path, options), Cancelled);
}

}  // namespace
}  // namespace mv
