// What a glTF file says of triangles: primitive modes, component types, layouts, transforms,
// instances, precision. Every file is made here.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "megaviews/scene/gltf_primitive.h"
#include "scene/gltf_builder.h"

namespace mv {
namespace {

using testing::GltfBuilder;
using testing::Json;

const std::vector<glm::vec3> kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

// All triangles face `direction`, and their areas add up to `area`.
void expectFacing(const Scene& scene, glm::dvec3 direction, double area) {
    EXPECT_EQ(testing::inconsistency(scene), "");
    double sum = 0;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const glm::dvec3 vector = testing::areaVector(scene, t);
        sum += glm::length(vector);
        EXPECT_GT(glm::dot(glm::normalize(vector), direction), 0.999) << "triangle " << t;
    }
    EXPECT_NEAR(sum, area, 1e-5 * area);
}

TEST(GltfModes, ListStripAndFanWindAlike) {
    const glm::dvec3 front(0, 0, 1);
    for (const bool indexed : {false, true}) {
        SCOPED_TRACE(indexed ? "indexed" : "not indexed");
        const auto load = [&](const std::vector<glm::vec3>& positions, int mode) {
            GltfBuilder b;
            std::vector<std::uint32_t> order(positions.size());
            for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
            const int index =
                indexed ? b.accessor(order, testing::kUnsignedInt, "SCALAR", order.size()) : -1;
            b.primitive({{"POSITION", b.positions(positions)}}, index, mode);
            return testing::loadJson(b);
        };
        const auto& p = kSquare;
        expectFacing(load({p[0], p[1], p[2], p[0], p[2], p[3]}, 4), front, 1);
        // A strip of four triangles: two squares side by side.
        expectFacing(load({p[0], p[1], p[3], p[2], {0, 2, 0}, {1, 2, 0}}, 5), front, 2);
        expectFacing(load({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 1, 0}}, 6), front, 1.5);
    }
}

TEST(GltfModes, PointsAndLinesAreSkippedWithAWarning) {
    for (int mode = 0; mode < 4; ++mode) {
        GltfBuilder b = GltfBuilder::square();
        b.primitive({{"POSITION", 0}}, -1, mode);
        const Scene scene = testing::loadJson(b);
        EXPECT_EQ(scene.triangles.size(), 2u) << "mode " << mode;
        EXPECT_TRUE(testing::anyContains(scene.warnings, "points or lines")) << "mode " << mode;
    }
}

TEST(GltfModes, AssemblesAnyNumberOfIndices) {
    for (std::uint32_t n = 0; n < 12; ++n) {
        std::vector<std::uint32_t> indices(n);
        for (std::uint32_t i = 0; i < n; ++i) indices[i] = i;
        const TriangleList list = assembleTriangles(4, indices);
        EXPECT_EQ(list.triangles.size(), n / 3);
        EXPECT_EQ(list.leftOver, n % 3);
        for (const int mode : {5, 6}) {
            EXPECT_EQ(assembleTriangles(mode, indices).triangles.size(), n >= 3 ? n - 2 : 0u);
        }
    }
    // Stitched strips hold flat triangles on purpose; in a list they are a defect.
    const std::vector<std::uint32_t> stitched = {0, 1, 2, 2, 3, 3, 4, 5};
    EXPECT_EQ(assembleTriangles(5, stitched).repeated, 0u);
    EXPECT_EQ(assembleTriangles(4, std::vector<std::uint32_t>{0, 1, 1}).repeated, 1u);
}

TEST(GltfLayouts, AllIndexTypesReadAlike) {
    const std::vector<std::uint8_t> bytes = {0, 1, 2, 0, 2, 3};
    const std::vector<std::uint16_t> shorts(bytes.begin(), bytes.end());
    const std::vector<std::uint32_t> ints(bytes.begin(), bytes.end());
    for (const int type :
         {testing::kUnsignedByte, testing::kUnsignedShort, testing::kUnsignedInt}) {
        GltfBuilder b;
        const int index = type == testing::kUnsignedByte    ? b.accessor(bytes, type, "SCALAR", 6)
                          : type == testing::kUnsignedShort ? b.accessor(shorts, type, "SCALAR", 6)
                                                            : b.accessor(ints, type, "SCALAR", 6);
        b.primitive({{"POSITION", b.positions(kSquare)}}, index);
        expectFacing(testing::loadJson(b), {0, 0, 1}, 1);
    }
}

TEST(GltfLayouts, InterleavedWithOffsets) {
    // Position, normal, uv in one view of stride 32, behind twelve bytes of something else.
    std::vector<float> data = {9, 9, 9};
    for (const glm::vec3& p : kSquare) {
        data.insert(data.end(), {p.x, p.y, p.z, 0, 0.6f, 0.8f, p.x, p.y});
    }
    GltfBuilder b;
    const int view = b.view(data, 32);
    const int position = b.accessor(view, testing::kFloat, "VEC3", 4, 12);
    const int normal = b.accessor(view, testing::kFloat, "VEC3", 4, 24);
    const int index = b.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3},
                                 testing::kUnsignedShort, "SCALAR", 6);
    b.primitive({{"POSITION", position}, {"NORMAL", normal}}, index);
    const Scene scene = testing::loadJson(b);
    expectFacing(scene, {0, 0, 1}, 1);
    ASSERT_EQ(scene.positions.size(), 4u);
    EXPECT_NEAR(scene.normals[3].y, 0.6, 1e-6);
    EXPECT_NEAR(scene.normals[3].z, 0.8, 1e-6);
}

TEST(GltfLayouts, SparseReplacesElementsWithAndWithoutABase) {
    for (const int indexType :
         {testing::kUnsignedByte, testing::kUnsignedShort, testing::kUnsignedInt}) {
        for (const bool base : {true, false}) {
            GltfBuilder b;
            const int position = base ? b.positions({{5, 5, 5}, {1, 0, 0}, {1, 1, 0}})
                                      : b.accessor(-1, testing::kFloat, "VEC3", 3);
            const std::vector<glm::vec3> values =
                base ? std::vector<glm::vec3>{{0, 0, 0}}
                     : std::vector<glm::vec3>{{1, 0, 0}, {1, 1, 0}};
            const std::vector<std::uint8_t> targets =
                base ? std::vector<std::uint8_t>{0} : std::vector<std::uint8_t>{1, 2};
            const int targetView =
                indexType == testing::kUnsignedByte ? b.view(targets)
                : indexType == testing::kUnsignedShort
                    ? b.view(std::vector<std::uint16_t>(targets.begin(), targets.end()))
                    : b.view(std::vector<std::uint32_t>(targets.begin(), targets.end()));
            const int valueView = b.view(values);
            b.json["accessors"][static_cast<std::size_t>(position)]["sparse"] = {
                {"count", targets.size()},
                {"indices", {{"bufferView", targetView}, {"componentType", indexType}}},
                {"values", {{"bufferView", valueView}}}};
            b.primitive({{"POSITION", position}});
            expectFacing(testing::loadJson(b), {0, 0, 1}, 0.5);
        }
    }
}

TEST(GltfLayouts, SparseIndicesWithoutABaseView) {
    GltfBuilder b;
    const int index = b.accessor(-1, testing::kUnsignedShort, "SCALAR", 3);
    const int targets = b.view(std::vector<std::uint8_t>{1, 2});
    const int values = b.view(std::vector<std::uint16_t>{1, 2});
    b.json["accessors"][static_cast<std::size_t>(index)]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", targets}, {"componentType", testing::kUnsignedByte}}},
        {"values", {{"bufferView", values}}}};
    b.primitive({{"POSITION", b.positions(kSquare)}}, index);
    expectFacing(testing::loadJson(b), {0, 0, 1}, 0.5);
}

template <typename T>
void expectQuantised(int componentType, bool normalized, double unit) {
    // The square from 0 to the largest value, scaled back by the node, as exporters do.
    const T top = std::numeric_limits<T>::max();
    std::vector<T> data;
    const std::size_t stride = (3 * sizeof(T) + 3) / 4 * 4;
    for (const glm::vec3& p : kSquare) {
        for (int k = 0; k < 3; ++k) data.push_back(p[k] > 0 ? top : T(0));
        while (data.size() * sizeof(T) % stride != 0) data.push_back(T(0));
    }
    std::vector<T> normals;
    for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < 3; ++k) normals.push_back(k == 2 ? top : T(0));
        while (normals.size() * sizeof(T) % stride != 0) normals.push_back(T(0));
    }
    GltfBuilder b;
    const int position =
        b.accessor(b.view(data, static_cast<int>(stride)), componentType, "VEC3", 4, 0, normalized);
    const int normal =
        b.accessor(b.view(normals, static_cast<int>(stride)), componentType, "VEC3", 4, 0, true);
    const int index = b.accessor(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3},
                                 testing::kUnsignedByte, "SCALAR", 6);
    b.primitive({{"POSITION", position}, {"NORMAL", normal}}, index);
    b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    b.json["nodes"][0]["scale"] = {unit, unit, unit};
    const Scene scene = testing::loadJson(b);
    expectFacing(scene, {0, 0, 1}, 1);
    EXPECT_EQ(scene.normals[0], glm::vec3(0, 0, 1));
    EXPECT_NEAR(scene.positionStep * scene.root.edge, 1.0 / top, 1e-7);
}

TEST(GltfLayouts, QuantisedPositionsAndNormals) {
    expectQuantised<std::int8_t>(testing::kByte, true, 1);
    expectQuantised<std::uint8_t>(testing::kUnsignedByte, true, 1);
    expectQuantised<std::int16_t>(testing::kShort, true, 1);
    expectQuantised<std::uint16_t>(testing::kUnsignedShort, true, 1);
    expectQuantised<std::int8_t>(testing::kByte, false, 1.0 / 127);
    expectQuantised<std::uint8_t>(testing::kUnsignedByte, false, 1.0 / 255);
    expectQuantised<std::int16_t>(testing::kShort, false, 1.0 / 32767);
    expectQuantised<std::uint16_t>(testing::kUnsignedShort, false, 1.0 / 65535);
}

TEST(GltfLayouts, BinaryFilesAndBuffersBesideTheFile) {
    const testing::TemporaryFolder folder;
    const GltfBuilder b = GltfBuilder::square();
    expectFacing(loadScene(folder.write("square.glb", b.glb())), {0, 0, 1}, 1);
    GltfBuilder external = b;
    folder.write("data/my square é.bin", b.binary);
    external.json["buffers"] = {
        {{"byteLength", b.binary.size()}, {"uri", "data/./my%20square%20%C3%A9.bin"}}};
    expectFacing(loadScene(folder.write("external.gltf", external.json.dump())), {0, 0, 1}, 1);
    // A byte order mark before the JSON is tolerated.
    expectFacing(loadScene(folder.write("bom.gltf", "\xef\xbb\xbf" + b.gltfText())), {0, 0, 1}, 1);
}

TEST(GltfLayouts, HashesCoverFilesThatAreReferredTo) {
    const testing::TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::square();
    testing::Bytes data = b.binary;
    b.json["buffers"] = {{{"byteLength", data.size()}, {"uri", "a.bin"}}};
    const std::string path = folder.write("a.gltf", b.json.dump());
    folder.write("a.bin", data);
    const Scene first = loadScene(path), again = loadScene(path);
    data[0] = 1;  // a position, in its last bits
    folder.write("a.bin", data);
    const Scene second = loadScene(path);
    EXPECT_EQ(first.hash.size(), 32u);
    EXPECT_EQ(first.hash, again.hash);
    EXPECT_NE(first.hash, second.hash);
    ASSERT_EQ(first.files.size(), 1u);
    EXPECT_TRUE(first.files[0].ends_with("a.bin")) << first.files[0];
    EXPECT_EQ(first.contentHash, again.contentHash);
    EXPECT_NE(first.contentHash, second.contentHash);
}

TEST(GltfAttributes, VertexColoursOfEveryType) {
    const auto check = [](auto values, int componentType, const char* type, bool normalized,
                          float expected) {
        GltfBuilder b;
        const std::size_t width = std::string(type) == "VEC4" ? 4 : 3;
        const std::size_t bytes = width * sizeof(values[0]);
        std::vector<std::remove_cvref_t<decltype(values[0])>> data;
        for (int vertex = 0; vertex < 3; ++vertex) {
            data.insert(data.end(), values.begin(),
                        values.begin() + static_cast<std::ptrdiff_t>(width));
            while (data.size() * sizeof(values[0]) % 4 != 0) data.push_back({});
        }
        const int view = b.view(data, static_cast<int>((bytes + 3) / 4 * 4));
        const int color = b.accessor(view, componentType, type, 3, 0, normalized);
        b.primitive(
            {{"POSITION", b.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})}, {"COLOR_0", color}});
        const Scene scene = testing::loadJson(b);
        ASSERT_EQ(scene.colors.size(), 3u);
        EXPECT_NEAR(scene.colors[1].r, 1, 1e-6) << type << " " << componentType;
        EXPECT_NEAR(scene.colors[1].g, expected, 1e-6) << type << " " << componentType;
        EXPECT_NEAR(scene.colors[1].b, 0, 1e-6) << type << " " << componentType;
        EXPECT_NEAR(scene.colors[1].a, width == 4 ? expected : 1, 1e-6) << type;
    };
    for (const char* type : {"VEC3", "VEC4"}) {
        check(std::vector<float>{1, 0.25f, 0, 0.25f}, testing::kFloat, type, false, 0.25f);
        check(std::vector<std::uint8_t>{255, 51, 0, 51}, testing::kUnsignedByte, type, true, 0.2f);
        check(std::vector<std::uint16_t>{65535, 13107, 0, 13107}, testing::kUnsignedShort, type,
              true, 0.2f);
    }
    // Files that forget to say so mean it all the same.
    check(std::vector<std::uint8_t>{255, 51, 0}, testing::kUnsignedByte, "VEC3", false, 0.2f);
}

TEST(GltfAttributes, AbsentOptionalArraysStayEmptyAndMixedOnesAreFilled) {
    const Scene plain = testing::loadJson(GltfBuilder::square());
    EXPECT_TRUE(plain.colors.empty());
    EXPECT_TRUE(plain.uvs.empty());  // the file has some, but no texture to look up
    EXPECT_TRUE(plain.emissiveUvs.empty());
    ASSERT_EQ(plain.materials.size(), 1u);

    GltfBuilder b = GltfBuilder::square();
    const int color = b.accessor(std::vector<float>(9, 0.5f), testing::kFloat, "VEC3", 3);
    b.primitive({{"POSITION", b.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})}, {"COLOR_0", color}});
    const Scene mixed = testing::loadJson(b);
    EXPECT_EQ(testing::inconsistency(mixed), "");
    EXPECT_EQ(mixed.colors.front(), glm::vec4(1));
    EXPECT_EQ(mixed.colors.back(), glm::vec4(0.5f, 0.5f, 0.5f, 1));
    EXPECT_EQ(mixed.materials.size(), 2u);  // the second primitive has the default one
    EXPECT_EQ(mixed.triangleMaterials.back(), 1u);
}

TEST(GltfAttributes, MissingNormalsAreFlatAndBadOnesAreReplaced) {
    // A tent: two triangles that share an edge, 90 degrees apart.
    const std::vector<glm::vec3> tent = {{0, 0, 0}, {0, 0, 1}, {-1, -1, 0}, {1, -1, 0}};
    const std::vector<std::uint8_t> order = {0, 2, 1, 0, 1, 3};
    GltfBuilder flat;
    int index = flat.accessor(order, testing::kUnsignedByte, "SCALAR", 6);
    flat.primitive({{"POSITION", flat.positions(tent)}}, index);
    const Scene scene = testing::loadJson(flat);
    EXPECT_EQ(testing::inconsistency(scene), "");
    EXPECT_EQ(scene.positions.size(), 6u);
    for (std::size_t t = 0; t < 2; ++t) {
        const glm::dvec3 face = glm::normalize(testing::areaVector(scene, t));
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(glm::dot(face, glm::dvec3(scene.normals[scene.triangles[t][k]])), 1, 1e-6);
        }
    }

    const float nan = std::numeric_limits<float>::quiet_NaN();
    GltfBuilder bad;
    index = bad.accessor(order, testing::kUnsignedByte, "SCALAR", 6);
    const int normal = bad.positions({{0, 0, 0}, {nan, 0, 1}, {0, 5, 0}, {0, 1e-30f, 0}});
    bad.primitive({{"POSITION", bad.positions(tent)}, {"NORMAL", normal}}, index);
    const Scene repaired = testing::loadJson(bad);
    EXPECT_EQ(testing::inconsistency(repaired), "");
    EXPECT_TRUE(testing::anyContains(repaired.warnings, "2 vertex normals"));
    EXPECT_EQ(repaired.positions.size(), 4u);
    EXPECT_NEAR(repaired.normals[0].y, 1, 1e-6);  // the mean of both faces
    EXPECT_EQ(repaired.normals[2], glm::vec3(0, 1, 0));
    EXPECT_EQ(repaired.normals[3], glm::vec3(0, 1, 0));
}

TEST(GltfTransforms, NegativeScaleKeepsTheOutsideOut) {
    // A tetrahedron with outward faces and normals from its centre, under every sign of scale.
    const std::vector<glm::vec3> corners = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    const std::vector<std::uint8_t> order = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
    for (int signs = 0; signs < 8; ++signs) {
        SCOPED_TRACE(signs);
        GltfBuilder b;
        const int index = b.accessor(order, testing::kUnsignedByte, "SCALAR", 12);
        const int position = b.positions(corners);
        b.primitive({{"POSITION", position}, {"NORMAL", position}}, index);
        b.json["nodes"][0]["scale"] = {signs & 1 ? -2 : 2, signs & 2 ? -1 : 1, signs & 4 ? -3 : 3};
        b.json["nodes"][0]["translation"] = {10, 0, 0};
        b.json["nodes"][0]["rotation"] = {0.1, 0.7, -0.2, 0.6782329983125268};
        const Scene scene = testing::loadJson(b);
        EXPECT_EQ(testing::inconsistency(scene), "");
        ASSERT_EQ(scene.triangles.size(), 4u);
        const glm::dvec3 centre(10, 0, 0);
        for (std::size_t t = 0; t < 4; ++t) {
            const glm::dvec3 area = testing::areaVector(scene, t);
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3 out = testing::corner(scene, t, k) - centre;
                EXPECT_GT(glm::dot(area, out), 0);
                EXPECT_GT(glm::dot(glm::dvec3(scene.normals[scene.triangles[t][k]]), out), 0);
            }
        }
    }
}

TEST(GltfTransforms, NormalsStayPerpendicularUnderAnyMatrix) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-2, 2);
    for (int round = 0; round < 50; ++round) {
        GltfBuilder b = GltfBuilder::square();
        const int normal = b.positions(std::vector<glm::vec3>(4, {0, 0, 1}));
        b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normal;
        std::vector<double> matrix(16, 0);
        for (const std::size_t i : {0u, 1u, 2u, 4u, 5u, 6u, 8u, 9u, 10u, 12u, 13u, 14u})
            matrix[i] = number(random);
        matrix[15] = 1;
        b.json["nodes"][0]["matrix"] = matrix;
        const Scene scene = testing::loadJson(b);
        SCOPED_TRACE(Json(matrix).dump());
        ASSERT_EQ(scene.triangles.size(), 2u);
        const glm::dvec3 face = glm::normalize(testing::areaVector(scene, 0));
        // Mirrored or not, the side that was the front still is.
        EXPECT_NEAR(glm::dot(face, glm::dvec3(scene.normals[0])), 1, 1e-4);
    }
}

TEST(GltfTransforms, FlattenedGeometryHasNormals) {
    GltfBuilder b = GltfBuilder::square();
    const int normal = b.positions(std::vector<glm::vec3>(4, {0, 0, 1}));
    b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normal;
    b.json["nodes"][0]["scale"] = {2, 2, 0};
    const Scene scene = testing::loadJson(b);
    expectFacing(scene, {0, 0, 1}, 4);
    EXPECT_EQ(scene.normals[0], glm::vec3(0, 0, 1));
    EXPECT_TRUE(testing::anyContains(scene.warnings, "nodes[0]"));
}

TEST(GltfTransforms, ChildrenStandInTheirParents) {
    GltfBuilder b = GltfBuilder::square();
    // Listed child first: turned a quarter about z, then lifted by its parent's doubled scale.
    b.json["nodes"] = {{{"mesh", 0}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}},
                       {{"children", {0}}, {"scale", {2, 2, 2}}, {"translation", {0, 0, 5}}}};
    b.json["scenes"][0]["nodes"] = {1};
    const auto [min, max] = testing::worldBox(testing::loadJson(b));
    EXPECT_NEAR(glm::length(min - glm::dvec3(-2, 0, 5)), 0, 1e-6);
    EXPECT_NEAR(glm::length(max - glm::dvec3(0, 2, 5)), 0, 1e-6);
}

TEST(GltfTransforms, GpuInstancing) {
    GltfBuilder b = GltfBuilder::square();
    const int translation = b.positions({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}});
    const float h = std::sqrt(0.5f);
    const int rotation = b.accessor(std::vector<float>{0, 0, 0, 1, 0, h, 0, h, 0, 0, 0, 1},
                                    testing::kFloat, "VEC4", 3);
    const int scale = b.positions({{1, 1, 1}, {2, 2, 2}, {-1, 1, 1}});
    b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}, {"_ID", 0}};
    b.json["nodes"][0]["translation"] = {0, 0, 3};
    b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const Scene scene = testing::loadJson(b);
    EXPECT_EQ(testing::inconsistency(scene), "");
    ASSERT_EQ(scene.triangles.size(), 6u);
    // Turned about y by a quarter: +x to -z, front to +x. Mirrored: the front stays the front.
    EXPECT_NEAR(glm::length(glm::normalize(testing::areaVector(scene, 2)) - glm::dvec3(1, 0, 0)), 0,
                1e-5);
    EXPECT_NEAR(glm::length(glm::normalize(testing::areaVector(scene, 4)) - glm::dvec3(0, 0, 1)), 0,
                1e-5);
    const auto [min, max] = testing::worldBox(scene);
    EXPECT_NEAR(glm::length(min - glm::dvec3(0, 0, 1)), 0, 1e-5);
    EXPECT_NEAR(glm::length(max - glm::dvec3(20, 2, 3)), 0, 1e-5);
}

TEST(GltfTransforms, ScenesAreChosen) {
    GltfBuilder b = GltfBuilder::square();
    const int far = b.add("nodes", {{"mesh", 0}, {"translation", {100, 0, 0}}});
    b.json["scenes"].push_back({{"nodes", {0, far}}});
    EXPECT_EQ(testing::loadJson(b).triangles.size(), 2u);
    LoadOptions options;
    options.sceneIndex = 1;
    EXPECT_EQ(testing::loadJson(b, options).triangles.size(), 4u);
    b.json["scene"] = 1;
    EXPECT_EQ(testing::loadJson(b).triangles.size(), 4u);
    options.sceneIndex = 0;
    EXPECT_EQ(testing::loadJson(b, options).triangles.size(), 2u);
}

TEST(GltfTransforms, FarFromTheOriginKeepsItsPrecision) {
    // Random triangles of size 1, once at the origin and once a million units away: the positions
    // in the root cube agree to far better than a float at that distance could.
    std::mt19937 random(3);
    std::uniform_real_distribution<float> number(0, 1);
    std::vector<glm::vec3> corners(300);
    for (glm::vec3& p : corners) p = {number(random), number(random), number(random)};
    GltfBuilder b;
    b.primitive({{"POSITION", b.positions(corners)}});
    const Scene near = testing::loadJson(b);
    for (const double distance : {1e6, -1e6, 1e8}) {
        b.json["nodes"][0]["translation"] = {distance, -distance / 2, distance * 0.1};
        const Scene far = testing::loadJson(b);
        ASSERT_EQ(far.positions.size(), near.positions.size());
        EXPECT_NEAR(far.root.edge, near.root.edge, 1e-6);
        for (std::size_t i = 0; i < far.positions.size(); ++i) {
            ASSERT_LT(glm::length(far.positions[i] - near.positions[i]), 3e-7f)
                << "vertex " << i << " at distance " << distance;
        }
        EXPECT_LT(glm::length(far.normals[7] - near.normals[7]), 1e-4f);
    }
}

TEST(GltfTransforms, ScaleIsFree) {
    for (const double scale : {1e-12, 1e-4, 1.0, 1e6, 1e12}) {
        GltfBuilder b = GltfBuilder::square();
        b.json["nodes"][0]["scale"] = {scale, scale, scale};
        const Scene scene = testing::loadJson(b);
        EXPECT_EQ(testing::inconsistency(scene), "") << scale;
        EXPECT_EQ(scene.triangles.size(), 2u) << scale;
        EXPECT_NEAR(scene.root.edge / scale, 1 / (1 - 2.0 / 64), 1e-6) << scale;
    }
}

TEST(RootCubeAround, HoldsAnyBoxWithItsMargin) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> number(-1, 1), exponent(-6, 6);
    for (int i = 0; i < 1000; ++i) {
        const double scale = std::pow(10, exponent(random));
        const glm::dvec3 a = scale * glm::dvec3(number(random), number(random), number(random));
        const glm::dvec3 size =
            scale *
            glm::abs(glm::dvec3(number(random), i % 3 ? number(random) : 0, number(random)));
        const RootCube root = RootCube::around(a, a + size);
        const glm::dvec3 low = (a - root.origin) / root.edge,
                         high = (a + size - root.origin) / root.edge;
        for (int k = 0; k < 3; ++k) {
            ASSERT_GT(low[k], 1.0 / 64 - 1e-9) << a.x << " " << size.x;
            ASSERT_LT(high[k], 1 - 1.0 / 64 + 1e-9);
            ASSERT_NEAR(low[k] + high[k], 1, 1e-9);
        }
    }
    const double inf = std::numeric_limits<double>::infinity();
    for (const glm::dvec3 p : {glm::dvec3(0), glm::dvec3(1e9, 2, -3)}) {
        const RootCube point = RootCube::around(p, p);
        EXPECT_GT(point.edge, 0);
        EXPECT_NEAR(point.rootFromWorld(p).x, 0.5, 1e-6);
    }
    EXPECT_GT(RootCube::around(glm::dvec3(inf), glm::dvec3(-inf)).edge, 0);
}

}  // namespace
}  // namespace mv
