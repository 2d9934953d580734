// Packed meshes and images: what Draco, meshoptimizer and WebP hold is drawn as what is not packed,
// and damaged or contradictory data get a sentence.
#include <gtest/gtest.h>
#include <meshoptimizer.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "megaviews/scene/gltf_images.h"
#include "scene/packed_box.h"

namespace mv {
namespace {

using testing::Bytes;
using testing::DracoMethod;
using testing::GltfBuilder;
using testing::Json;

constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr const char* kMeshopt = "EXT_meshopt_compression";

Json& dracoOf(GltfBuilder& b) { return b.primitive()["extensions"][kDraco]; }

GltfBuilder dracoBox(DracoMethod method = DracoMethod::edgebreaker) {
    return testing::dracoBox(testing::dracoStream(testing::makeBox(), method));
}

Scene loadGlb(const GltfBuilder& b, const LoadOptions& options = {}) {
    const testing::TemporaryFolder folder;
    return loadScene(folder.write("box.glb", b.glb()), options);
}

std::string errorOf(const GltfBuilder& b) {
    const testing::TemporaryFolder folder;
    return testing::inputError(folder.write("box.glb", b.glb()));
}

TEST(GltfDraco, BoxIsDrawnAsTheUnpackedOne) {
    const std::string plain = testing::describeTriangles(loadGlb(testing::plainBox()));
    for (const DracoMethod method : {DracoMethod::sequential, DracoMethod::edgebreaker}) {
        for (const bool quantised : {true, false}) {
            const Scene scene = loadGlb(
                testing::dracoBox(testing::dracoStream(testing::makeBox(), method, quantised)));
            EXPECT_EQ(testing::inconsistency(scene), "");
            EXPECT_EQ(testing::describeTriangles(scene), plain);
            EXPECT_EQ(scene.extensions, std::vector<std::string>{kDraco});
            EXPECT_TRUE(scene.ignored.empty() || scene.ignored.size() == 1);  // metallic factors
            EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
        }
    }
}

// As an exporter for Blender wrote them once: corners that differ in more than accessors count.
TEST(GltfDraco, AStreamMayHoldMoreVerticesThanAreAnnounced) {
    GltfBuilder b = dracoBox();
    for (std::size_t i = 0; i < 4; ++i) b.json["accessors"][i]["count"] = 20;
    const Scene scene = loadGlb(b);
    EXPECT_EQ(testing::describeTriangles(scene),
              testing::describeTriangles(loadGlb(testing::plainBox())));
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("24 vertices, its accessors announce 20"), std::string::npos);
}

// A step of 14 bits; positions lie where Draco's own decoder puts them, to the bit.
TEST(GltfDraco, TheStepOfPositionsIsKnown) {
    testing::Box box = testing::makeBox();
    for (glm::vec3& p : box.positions) p = 0.3f * p + glm::vec3(0.1f, 0.7f, -0.2f);
    const Bytes stream = testing::dracoStream(box, DracoMethod::sequential);
    const Scene scene = loadGlb(testing::dracoBox(stream));
    EXPECT_NEAR(scene.positionStep * scene.root.edge, 0.6 / 16383, 1e-9);
    const std::vector<glm::vec3> decoded = testing::dracoPositions(stream);
    for (const glm::vec3& p : scene.positions) {
        EXPECT_TRUE(std::any_of(decoded.begin(), decoded.end(),
                                [&](const glm::vec3& d) {
                                    return glm::vec3(scene.root.rootFromWorld(glm::dvec3(d))) == p;
                                }))
            << p.x << " " << p.y << " " << p.z;
    }
    const Bytes exact = testing::dracoStream(box, DracoMethod::sequential, false);
    EXPECT_EQ(loadGlb(testing::dracoBox(exact)).positionStep, 0.0f);
    EXPECT_EQ(loadGlb(testing::plainBox()).positionStep, 0.0f);
}

TEST(GltfDraco, AttributesTakeTheTypesOfTheirAccessors) {
    // Bytes of the stream as shorts that are not normalised, as which no colour could be read.
    const testing::Box box = testing::makeBox();
    GltfBuilder b = testing::dracoBox(testing::dracoStream(box, DracoMethod::sequential));
    const int joints = b.accessor(-1, testing::kUnsignedShort, "VEC4", 24);
    Json& primitive = b.primitive();
    primitive["attributes"].erase("COLOR_0");
    primitive["attributes"]["JOINTS_0"] = joints;
    primitive["attributes"]["WEIGHTS_0"] =
        b.accessor(std::vector<glm::vec4>(24, {1, 0, 0, 0}), testing::kFloat, "VEC4", 24);
    dracoOf(b)["attributes"].erase("COLOR_0");
    dracoOf(b)["attributes"]["JOINTS_0"] = testing::kDracoColor;
    b.json["nodes"][0]["skin"] = 0;
    b.add("skins", {{"joints", {0}}});
    // Its first corner, joint 0, would do; the second hangs on joint 40 of one.
    const std::string error = errorOf(b);
    EXPECT_NE(error.find("vertex 4 hangs on joint 40"), std::string::npos) << error;
}

TEST(GltfDraco, OnePairOfAccessorsServesTwoStreams) {
    // Accessors of packed data only say how many of what: equal ones may be one.
    testing::Box far = testing::makeBox();
    for (glm::vec3& p : far.positions) p += glm::vec3(10, 0, 0);
    GltfBuilder b = dracoBox();
    const int second = b.view(testing::dracoStream(far, DracoMethod::sequential, false));
    Json copy = b.primitive();
    copy["extensions"][kDraco]["bufferView"] = second;
    Json third = copy;  // the same stream once more
    b.json["meshes"][0]["primitives"].push_back(copy);
    b.json["meshes"][0]["primitives"].push_back(third);
    const Scene scene = loadGlb(b);
    EXPECT_EQ(testing::inconsistency(scene), "");
    EXPECT_EQ(scene.triangles.size(), 36u);
    std::size_t beyond = 0;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        beyond += testing::corner(scene, t, 0).x > 5;
    }
    EXPECT_EQ(beyond, 24u);
    EXPECT_NEAR(testing::worldBox(scene).second.x, 11, 1e-4);
}

TEST(GltfDraco, TakesUnpackedDataWhereTheFileHasThem) {
    const std::string plain = testing::describeTriangles(loadGlb(testing::plainBox()));
    GltfBuilder b = testing::plainBox();
    dracoOf(b) = {{"bufferView", b.view(Bytes(20, 7))},
                  {"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}};
    EXPECT_EQ(testing::describeTriangles(loadGlb(b)), plain);
}

TEST(GltfDraco, MorphTargetsKeepTheOrderOfItsVertices) {
    // A sequential stream keeps the order; target and stream are of the same corner then.
    const testing::Box box = testing::makeBox();
    GltfBuilder b = testing::dracoBox(testing::dracoStream(box, DracoMethod::sequential));
    std::vector<glm::vec3> moves;
    for (const glm::vec3& p : box.positions)
        moves.push_back(p.x > 0 ? glm::vec3(2, 0, 0) : glm::vec3(0));
    b.primitive()["targets"] = {{{"POSITION", b.positions(moves)}}};
    b.json["meshes"][0]["weights"] = {1};
    const auto [min, max] = testing::worldBox(loadGlb(b));
    EXPECT_NEAR(min.x, -1, 1e-3);
    EXPECT_NEAR(max.x, 3, 1e-3);
}

TEST(GltfDraco, FewerTrianglesThanAnnouncedAreDrawnWithAWarning) {
    GltfBuilder b = dracoBox();
    b.json["accessors"][4]["count"] = 42;
    const Scene scene = loadGlb(b);
    EXPECT_EQ(scene.triangles.size(), 12u);
    EXPECT_TRUE(testing::anyContains(scene.warnings, "12 triangles, its accessors announce 14"));
}

struct Wrong {
    std::string reason;  // and the place
    std::function<void(GltfBuilder&)> change;
};

TEST(GltfDraco, ContradictionsAreNamed) {
    const auto streamOf = [](GltfBuilder& b) {
        const auto view = dracoOf(b)["bufferView"].get<std::size_t>();
        return &b.binary[b.json["bufferViews"][view]["byteOffset"].get<std::size_t>()];
    };
    const std::string here = "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression: ";
    const std::vector<Wrong> cases = {
        {here + "its stream announces 12 triangles, its accessors 11",
         [](GltfBuilder& b) { b.json["accessors"][4]["count"] = 33; }},
        {here + "its stream holds 24 vertices, its accessors 25",
         [](GltfBuilder& b) {
             for (std::size_t i = 0; i < 4; ++i) b.json["accessors"][i]["count"] = 25;
         }},
        {"primitives[0].attributes.NORMAL: it has 23 elements, POSITION has 24",
         [](GltfBuilder& b) { b.json["accessors"][1]["count"] = 23; }},
        {here + "its data are no Draco stream", [&](GltfBuilder& b) { streamOf(b)[0] = 'd'; }},
        {here + "its stream is of Draco's version 2.1, not 2.2",
         [&](GltfBuilder& b) { streamOf(b)[6] = 1; }},
        {here + "its stream holds no triangles", [&](GltfBuilder& b) { streamOf(b)[7] = 0; }},
        {here + "its stream is damaged (unknown method)",
         [&](GltfBuilder& b) { streamOf(b)[8] = 9; }},
        {here + "there is no attribute 77 of its stream",
         [](GltfBuilder& b) { dracoOf(b)["attributes"]["NORMAL"] = 77; }},
        {here + "attribute 2 of its stream has 2 components, its accessor 3",
         [](GltfBuilder& b) { dracoOf(b)["attributes"]["NORMAL"] = testing::kDracoUv; }},
        {"primitives[0].extensions.KHR_draco_mesh_compression.bufferView: it is missing",
         [](GltfBuilder& b) { dracoOf(b).erase("bufferView"); }},
        {"primitives[0].extensions.KHR_draco_mesh_compression.attributes.NORMAL: it is negative",
         [](GltfBuilder& b) { dracoOf(b)["attributes"]["NORMAL"] = -1; }},
        {"primitives[0].indices: it is missing",
         [](GltfBuilder& b) { b.primitive().erase("indices"); }},
        {here + "the extension has no triangle fans",
         [](GltfBuilder& b) { b.primitive()["mode"] = 6; }},
        {here + "with it the packed data of the file expand to", [](GltfBuilder& b) {
             for (std::size_t i = 0; i < 5; ++i) b.json["accessors"][i]["count"] = 3000000000u;
         }}};
    for (const Wrong& wrong : cases) {
        GltfBuilder b = dracoBox();
        wrong.change(b);
        const std::string error = errorOf(b);
        EXPECT_NE(error.find(wrong.reason), std::string::npos) << wrong.reason << " / " << error;
    }
}

TEST(GltfMeshopt, BoxIsDrawnAsTheUnpackedOne) {
    const std::string plain = testing::describeTriangles(loadGlb(testing::plainBox()));
    const Scene scene = loadGlb(testing::meshoptBox());
    EXPECT_EQ(testing::inconsistency(scene), "");
    EXPECT_EQ(testing::describeTriangles(scene), plain);
    EXPECT_EQ(scene.extensions, (std::vector<std::string>{kMeshopt, "KHR_mesh_quantization"}));
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
}

TEST(GltfMeshopt, IndicesOfBothSizesAndBothCodecs) {
    const testing::Box box = testing::makeBox();
    const std::string plain = testing::describeTriangles(loadGlb(testing::plainBox()));
    const std::vector<std::uint32_t> wide(box.indices.begin(), box.indices.end());
    Bytes triangles(meshopt_encodeIndexBufferBound(36, 24));
    triangles.resize(
        meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), wide.data(), 36));
    Bytes sequence(meshopt_encodeIndexSequenceBound(36, 24));
    sequence.resize(meshopt_encodeIndexSequence(sequence.data(), sequence.size(), wide.data(), 36));
    for (const std::size_t stride : {2u, 4u}) {
        for (const bool asTriangles : {true, false}) {
            GltfBuilder b = testing::meshoptBox();
            const int view = testing::addMeshoptView(b, asTriangles ? triangles : sequence, 36,
                                                     stride, asTriangles ? "TRIANGLES" : "INDICES");
            b.primitive()["indices"] = b.accessor(
                view, stride == 2 ? testing::kUnsignedShort : testing::kUnsignedInt, "SCALAR", 36);
            EXPECT_EQ(testing::describeTriangles(loadGlb(b)), plain) << stride << asTriangles;
        }
    }
}

TEST(GltfMeshopt, RotationsOfTheQuaternionFilter) {
    // A quarter turn about y at the animation's end.
    const float half = std::sqrt(0.5f);
    const std::vector<glm::vec4> keys = {{0, 0, 0, 1}, {0, half, 0, half}};
    std::vector<glm::i16vec4> packed(2);
    meshopt_encodeFilterQuat(packed.data(), 2, sizeof packed[0], 16, &keys[0].x);
    GltfBuilder b = testing::meshoptBox();
    const int view =
        testing::addMeshoptView(b, testing::meshoptVertices(packed.data(), 2, sizeof packed[0]), 2,
                                sizeof packed[0], "ATTRIBUTES", "QUATERNION");
    const int times = b.accessor(std::vector<float>{0, 1}, testing::kFloat, "SCALAR", 2);
    b.json["buffers"][0]["byteLength"] = b.binary.size();
    const int rotations = b.accessor(view, testing::kShort, "VEC4", 2, 0, true);
    Json& animation = b.json["animations"][0];
    animation["samplers"] = {{{"input", times}, {"output", rotations}}};
    animation["channels"] = {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}};
    b.json["nodes"][0]["mesh"] = nullptr;
    b.json["nodes"][0].erase("mesh");
    b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
    b.json["nodes"][0]["camera"] = 0;
    b.node({{"mesh", 0}});
    const Scene scene = loadGlb(b);
    const PosedCamera start = scene.camerasAt(0, 0)[0], end = scene.camerasAt(0.9999, 0)[0];
    EXPECT_NEAR(start.forward.z, -1, 1e-3);
    EXPECT_NEAR(end.forward.x, -1, 1e-3);
    EXPECT_NEAR(end.forward.z, 0, 1e-3);
}

TEST(GltfMeshopt, FallbackBuffersAreNeverRead) {
    // Not even where one names a file that is not there.
    GltfBuilder b = testing::meshoptBox();
    b.json["buffers"][1]["uri"] = "no-such-file.bin";
    EXPECT_EQ(loadGlb(b).triangles.size(), 12u);
    // Views of a buffer with data of their own are unpacked as well.
    GltfBuilder whole = testing::meshoptBox();
    const auto bytes = whole.json["buffers"][1]["byteLength"].get<std::size_t>();
    whole.json["buffers"][1] = {{"byteLength", bytes}, {"uri", testing::dataUri(Bytes(bytes, 0))}};
    EXPECT_EQ(loadGlb(whole).triangles.size(), 12u);
}

TEST(GltfMeshopt, ContradictionsAreNamed) {
    const auto ofView = [](GltfBuilder& b, std::size_t i) -> Json& {
        return b.json["bufferViews"][i]["extensions"][kMeshopt];
    };
    const auto packed = [ofView](GltfBuilder& b, std::size_t i) {
        return &b.binary[ofView(b, i)["byteOffset"].get<std::size_t>()];
    };
    const std::string first = "bufferViews[0].extensions.EXT_meshopt_compression";
    const std::string last = "bufferViews[4].extensions.EXT_meshopt_compression";
    const std::vector<Wrong> cases = {
        {first + ": its byteStride is 6; of attributes",
         [&](GltfBuilder& b) { ofView(b, 0)["byteStride"] = 6; }},
        {last + ": its byteStride is 12; of indices",
         [&](GltfBuilder& b) { ofView(b, 4)["byteStride"] = 12; }},
        {last + ": count 35 of mode TRIANGLES is no multiple of 3",
         [&](GltfBuilder& b) { ofView(b, 4)["count"] = 35; }},
        {last + ": filter OCTAHEDRAL is for attributes only",
         [&](GltfBuilder& b) { ofView(b, 4)["filter"] = "OCTAHEDRAL"; }},
        {first + ": its byteStride is 12; for filter OCTAHEDRAL",
         [&](GltfBuilder& b) { ofView(b, 0)["filter"] = "OCTAHEDRAL"; }},
        {first + ": its byteStride is 12; for filter QUATERNION",
         [&](GltfBuilder& b) { ofView(b, 0)["filter"] = "QUATERNION"; }},
        {first + ".mode: \"POINTS\" is none of",
         [&](GltfBuilder& b) { ofView(b, 0)["mode"] = "POINTS"; }},
        {first + ".filter: \"SHARPEN\" is none of",
         [&](GltfBuilder& b) { ofView(b, 0)["filter"] = "SHARPEN"; }},
        {first + ".count: it is missing", [&](GltfBuilder& b) { ofView(b, 0).erase("count"); }},
        {first + ".byteStride: it is 260",
         [&](GltfBuilder& b) { ofView(b, 0)["byteStride"] = 260; }},
        {first + ".buffer: it refers to buffer 2",
         [&](GltfBuilder& b) { ofView(b, 0)["buffer"] = 2; }},
        {first + ": buffers[1] is a fallback buffer",
         [&](GltfBuilder& b) { ofView(b, 0)["buffer"] = 1; }},
        {"run past the end of buffers[0]",
         [&](GltfBuilder& b) { ofView(b, 0)["byteLength"] = 1 << 20; }},
        {first + ": its elements take 276 bytes, bufferViews[0] has 288",
         [&](GltfBuilder& b) { ofView(b, 0)["count"] = 23; }},
        {"bytes cannot hold 4000000000 elements",
         [&](GltfBuilder& b) { ofView(b, 0)["count"] = 4000000000u; }},
        {"bufferViews[0]: its bytes are those of buffers[1], which has none",
         [&](GltfBuilder& b) { b.json["bufferViews"][0].erase("extensions"); }},
        {first + ": its data do not begin as those of mode ATTRIBUTES do",
         [&](GltfBuilder& b) { packed(b, 0)[0] = 0; }},
        {first + ": its data are damaged: they end too early",
         [&](GltfBuilder& b) {
             ofView(b, 0)["byteLength"] = ofView(b, 0)["byteLength"].get<int>() / 2;
         }},
        {last + ": its data are damaged",
         [&](GltfBuilder& b) {
             ofView(b, 4)["byteLength"] = ofView(b, 4)["byteLength"].get<int>() - 5;
         }},
        {"index 0 is vertex", [&](GltfBuilder& b) {
             // The first triangle has indices of its own, far beyond the vertices.
             std::vector<std::uint16_t> indices = testing::makeBox().indices;
             indices[0] = 9999;
             const int view =
                 testing::addMeshoptView(b, testing::meshoptTriangles(indices), 36, 2, "TRIANGLES");
             b.primitive()["indices"] = b.accessor(view, testing::kUnsignedShort, "SCALAR", 36);
         }}};
    for (const Wrong& wrong : cases) {
        GltfBuilder b = testing::meshoptBox();
        wrong.change(b);
        const std::string error = errorOf(b);
        EXPECT_NE(error.find(wrong.reason), std::string::npos) << wrong.reason << " / " << error;
    }
}

TEST(GltfMeshopt, ManyViewsOfTheSameBytesAreRefused) {
    // Each unpacks to 64 times its size, and nothing of it is drawn.
    const std::vector<std::uint32_t> zeros(std::size_t{1} << 20, 0);
    const std::size_t count = zeros.size() / 4;
    GltfBuilder b = testing::meshoptBox();
    const int view = testing::addMeshoptView(b, testing::meshoptVertices(zeros.data(), count, 16),
                                             count, 16, "ATTRIBUTES");
    const Json entry = b.json["bufferViews"][static_cast<std::size_t>(view)];
    for (int i = 0; i < 20; ++i) b.json["bufferViews"].push_back(entry);
    const std::string error = errorOf(b);
    EXPECT_NE(error.find("with it the packed data of the file expand to"), std::string::npos)
        << error;
}

// ---------------------------------------------------------------- images

const Bytes kTexels = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 10, 20, 30, 40};

TEST(GltfWebp, StandsForTheImageInAnotherFormat) {
    GltfBuilder b = GltfBuilder::square();
    b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {
        {"index", b.texture(testing::png(1, 1, Bytes{9, 9, 9, 255}))}};
    const int image = b.add("images", {{"bufferView", b.view(testing::webp(2, 2, kTexels))},
                                       {"mimeType", "image/webp"}});
    b.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = image;
    b.json["extensionsUsed"] = {"EXT_texture_webp"};
    const Scene scene = loadGlb(b);
    EXPECT_EQ(testing::inconsistency(scene), "");
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0].width, 2);
    EXPECT_EQ(scene.images[0].rgba, kTexels);
    EXPECT_EQ(scene.extensions, std::vector<std::string>{"EXT_texture_webp"});
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    // Alone as well, and what is left out names it.
    b.json["textures"][0].erase("source");
    b.json["extensionsRequired"] = b.json["extensionsUsed"];
    EXPECT_EQ(loadGlb(b).images.size(), 1u);
    b.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 7;
    const Scene without = loadGlb(b);
    EXPECT_TRUE(without.images.empty());
    EXPECT_TRUE(testing::anyContains(
        without.warnings, "textures[0].extensions.EXT_texture_webp.source: it refers to image 7"));
}

TEST(GltfWebp, EveryCutOfAFileIsRefused) {
    const Bytes whole = testing::webp(2, 2, kTexels);
    EXPECT_EQ(decodeImage(whole).rgba, kTexels);
    EXPECT_EQ(decodeImage(whole, 1).rgba.size(), 4u);
    for (std::size_t length = 0; length + 1 < whole.size(); ++length) {
        const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
        const DecodedImage image = decodeImage(cut);
        if (image.error.empty()) {
            EXPECT_EQ(image.rgba, kTexels) << length;  // padding alone is missing
        } else {
            EXPECT_TRUE(image.rgba.empty());
        }
    }
    EXPECT_FALSE(decodeImage(std::span(whole).first(whole.size() / 2)).error.empty());
}

TEST(GltfImages, TheLargestAreHalvedWhereAllAreTooMany) {
    std::vector<glm::ivec2> sizes(16, glm::ivec2(4096));
    EXPECT_EQ(halvingsOf(sizes), std::vector<int>(16, 0));
    sizes.insert(sizes.end(), {glm::ivec2(4), glm::ivec2(2048), glm::ivec2(8192, 2), {0, 0}});
    std::vector<int> wanted(16, 1);
    wanted.insert(wanted.end(), {0, 0, 2, 0});
    EXPECT_EQ(halvingsOf(sizes), wanted);
}

TEST(GltfWebp, AnimatedAndHugeImagesAreRefused) {
    // A header of the extended format: flags, three bytes unused, width - 1 and height - 1 in
    // three.
    const auto header = [](std::uint8_t flags, std::uint8_t sideHigh) {
        const std::string start("RIFF\x64\0\0\0WEBPVP8X\x0a\0\0\0", 20);
        Bytes b(110, 0);
        std::copy(start.begin(), start.end(), b.begin());
        b[20] = flags;
        b[24] = b[27] = 255;
        b[25] = b[28] = sideHigh;
        return b;
    };
    constexpr std::uint8_t kAnimated = 2;
    EXPECT_EQ(decodeImage(header(kAnimated, 0)).error, "animated WebP images are not supported");
    // The format alone allows a side of 16383 pixels, hence more than is decoded.
    EXPECT_FALSE(decodeImage(header(0, 60)).error.empty());
    Bytes texels(std::size_t{4} * 16383, 255);
    EXPECT_EQ(decodeImage(testing::webp(16383, 1, texels)).error, "");
}

// ---------------------------------------------------------------- damage

// Loads and judges; returns whether it loaded.
bool survives(const testing::TemporaryFolder& folder, const GltfBuilder& b) {
    try {
        EXPECT_EQ(testing::inconsistency(loadScene(folder.write("packed.glb", b.glb()))), "");
        return true;
    } catch (const Error& e) {
        EXPECT_EQ(e.code, ExitCode::input) << e.what();
        EXPECT_NE(std::string(e.what()).find("packed.glb"), std::string::npos) << e.what();
    }
    return false;
}

class GltfPackedDamage : public ::testing::Test {
  protected:
    GltfPackedDamage() : level_(spdlog::get_level()) { spdlog::set_level(spdlog::level::off); }
    ~GltfPackedDamage() override { spdlog::set_level(level_); }

    static std::vector<GltfBuilder> boxes() {
        GltfBuilder textured = testing::plainBox();
        textured.json["images"][0] = {{"bufferView", textured.view(testing::webp(2, 2, kTexels))}};
        return {dracoBox(DracoMethod::sequential), dracoBox(DracoMethod::edgebreaker),
                testing::dracoBox(
                    testing::dracoStream(testing::makeBox(), DracoMethod::sequential, false)),
                testing::meshoptBox(), textured};
    }
    testing::TemporaryFolder folder_;

  private:
    spdlog::level::level_enum level_;
};

TEST_F(GltfPackedDamage, EveryBitOfTheData) {
    for (const GltfBuilder& whole : boxes()) {
        std::size_t loaded = 0;
        const std::size_t step = whole.binary.size() / 400 + 1;
        for (std::size_t i = 0; i < whole.binary.size(); i += step) {
            SCOPED_TRACE("byte " + std::to_string(i));
            GltfBuilder b = whole;
            b.binary[i] = static_cast<std::uint8_t>(b.binary[i] ^ (1u << i % 8));
            loaded += survives(folder_, b);
        }
        EXPECT_LT(loaded, whole.binary.size());
    }
}

TEST_F(GltfPackedDamage, SeveralBytesAtRandom) {
    std::mt19937 random(31);
    for (const GltfBuilder& whole : boxes()) {
        int loaded = 0;
        for (int round = 0; round < 300; ++round) {
            SCOPED_TRACE("round " + std::to_string(round));
            GltfBuilder b = whole;
            for (std::size_t changes = 1 + random() % 6; changes > 0; --changes) {
                b.binary[random() % b.binary.size()] = static_cast<std::uint8_t>(random());
            }
            loaded += survives(folder_, b);
        }
        EXPECT_LT(loaded, 300);
    }
}

TEST_F(GltfPackedDamage, EveryCutOfAStream) {
    for (const DracoMethod method : {DracoMethod::sequential, DracoMethod::edgebreaker}) {
        const Bytes stream = testing::dracoStream(testing::makeBox(), method);
        for (std::size_t length = 1; length < stream.size(); ++length) {
            EXPECT_FALSE(survives(folder_, testing::dracoBox(std::span(stream).first(length))))
                << length;
        }
    }
    const GltfBuilder whole = testing::meshoptBox();
    for (std::size_t v = 0; v < whole.json["bufferViews"].size(); ++v) {
        const Json::json_pointer place("/bufferViews/" + std::to_string(v) + "/extensions/" +
                                       kMeshopt + "/byteLength");
        if (!whole.json.contains(place)) continue;
        for (auto length = whole.json[place].get<std::size_t>() - 1; length > 0; --length) {
            GltfBuilder b = whole;
            b.json[place] = length;
            EXPECT_FALSE(survives(folder_, b)) << place.to_string() << " " << length;
        }
    }
}

}  // namespace
}  // namespace mv
