// The scenes kept beside the checkout (or in $MEGAVIEWS_SCENES): all load, or are refused with the
// reason; counts and boxes are those that were measured from the files by other means.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "scene/gltf_builder.h"

namespace mv {
namespace {

std::filesystem::path scenesFolder() {
    if (const char* folder = std::getenv("MEGAVIEWS_SCENES")) return folder;
    return std::filesystem::path(MEGAVIEWS_SOURCE_DIR) / "../shared/scenes";
}

#define REQUIRE_SCENES(part)                                      \
    const std::filesystem::path folder = scenesFolder() / (part); \
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no scenes in " << folder

std::vector<std::filesystem::path> gltfFiles(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const auto extension = entry.path().extension();
        if (extension == ".gltf" || extension == ".glb") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

// How many triangles a warning says were dropped for having no area.
std::size_t droppedTriangles(const Scene& scene) {
    for (const std::string& warning : scene.warnings) {
        const std::size_t end = warning.find(" triangles have no area");
        if (end == std::string::npos) continue;
        return std::stoul(warning.substr(warning.rfind(' ', end - 1) + 1));
    }
    return 0;
}

TEST(GltfScenes, EveryBrokenFileGetsTheAnswerOfItsTable) {
    REQUIRE_SCENES("bad");
    // | `file` | what is wrong | expected | what a robust loader does |
    std::map<std::string, std::string> expected;
    std::ifstream table(folder / "README.md");
    for (std::string line; std::getline(table, line);) {
        if (!line.starts_with("| `")) continue;
        std::vector<std::string> cells;
        for (std::size_t at = 2; at < line.size();) {
            const std::size_t end = line.find(" | ", at);
            cells.push_back(line.substr(at, end - at));
            at = end == std::string::npos ? line.size() : end + 3;
        }
        ASSERT_GE(cells.size(), 4u) << line;
        expected[cells[0].substr(1, cells[0].size() - 2)] = cells[2];
    }
    ASSERT_EQ(expected.size(), 41u);
    for (const auto& [file, answer] : expected) {
        SCOPED_TRACE(file);
        const std::string path = (folder / file).string();
        if (answer == "error") {
            const std::string message = testing::inputError(path);
            EXPECT_NE(message.find(file), std::string::npos) << message;
            continue;
        }
        const Scene scene = loadScene(path);
        EXPECT_EQ(testing::inconsistency(scene), "");
        EXPECT_EQ(scene.warnings.empty(), answer == "valid");
        for (const std::string& warning : scene.warnings) {
            EXPECT_NE(warning.find(file), std::string::npos) << warning;
        }
    }
}

TEST(GltfScenes, ConformanceFilesLoad) {
    REQUIRE_SCENES("gltf-conformance");
    const std::map<std::string, std::size_t> triangles = {{"Triangle.gltf", 1},
                                                          {"TriangleWithoutIndices.gltf", 1},
                                                          {"MeshPrimitiveModes.gltf", 16},
                                                          {"Box With Spaces.gltf", 12},
                                                          {"BoxInterleaved.gltf", 12},
                                                          {"BoxVertexColors.glb", 12},
                                                          {"BoxTextured.gltf", 12},
                                                          {"SimpleSparseAccessor.gltf", 12},
                                                          {"MultipleScenes.gltf", 2},
                                                          {"Box.gltf", 12},
                                                          {"MorphPrimitivesTest.gltf", 32},
                                                          {"CesiumMilkTruck-meshopt.glb", 3624},
                                                          {"AnimatedMorphCube.gltf", 12},
                                                          {"Cameras.gltf", 2},
                                                          {"AnimatedTriangle.gltf", 1},
                                                          {"BoxAnimated.glb", 254},
                                                          {"InterpolationTest.glb", 110},
                                                          {"SimpleSkin.gltf", 8},
                                                          {"CesiumMan.glb", 4672},
                                                          {"Fox.glb", 576},
                                                          {"SimpleMorph.gltf", 1},
                                                          {"LightsPunctualLamp.gltf", 6000},
                                                          {"EmissiveStrengthTest.glb", 90},
                                                          {"AlphaBlendModeTest.glb", 61},
                                                          {"GlassVaseFlowers.glb", 14036},
                                                          {"NegativeScaleTest.glb", 7724},
                                                          {"OrientationTest.glb", 524},
                                                          {"TextureCoordinateTest.glb", 10},
                                                          {"TextureSettingsTest.glb", 72},
                                                          {"TextureTransformTest.gltf", 24},
                                                          {"UnlitTest.glb", 88},
                                                          {"Unicode❤♻Test.gltf", 2},
                                                          {"VC.glb", 8383}};
    std::size_t seen = 0;
    for (const auto& path : gltfFiles(folder)) {
        const std::string file = path.filename().string();
        SCOPED_TRACE(file);
        const Scene scene = loadScene(path.string());
        EXPECT_EQ(testing::inconsistency(scene), "");
        if (const auto it = triangles.find(file); it != triangles.end()) {
            EXPECT_EQ(scene.triangles.size() + droppedTriangles(scene), it->second);
            ++seen;
        }
    }
    EXPECT_GE(seen, triangles.size());
}

struct Expected {
    const char* file;
    std::size_t triangles;
    glm::dvec3 min, max;
    std::size_t lights, cameras;
};

TEST(GltfScenes, CountsBoxesLightsAndCameras) {
    REQUIRE_SCENES("");
    const std::vector<Expected> expected = {
        {"sponza/sponza.glb", 262267, {-15.37, -1.01, -9.46}, {14.40, 11.44, 8.84}, 0, 0},
        {"sponza-draco-webp/sponza-draco-webp.glb",
         262267,
         {-15.37, -1.01, -9.46},
         {14.40, 11.44, 8.84},
         0,
         0},
        {"sibenik/sibenik.glb", 73564, {-20.14, -15.31, -8.50}, {20.14, 15.30, 8.50}, 0, 2},
        {"san-miguel/san-miguel.glb",
         1746617,
         {-37.97, -0.46, -36.95},
         {46.77, 14.60, 36.94},
         1,
         5},
        {"living-room/living-room.glb", 143163, {-0.51, 0, -3.64}, {5.12, 2.88, 0.59}, 0, 1},
        {"breakfast-room/breakfast-room.glb",
         269538,
         {-6.35, -1.52, -4.71},
         {5.26, 8.03, 10.04},
         1,
         1},
        {"bathroom/bathroom.glb", 380290, {-2.90, -0.01, -2.50}, {2.50, 2.79, -0.05}, 0, 1},
        {"cornell-box/cornell-box-original.glb", 36, {-1.02, 0, -1.04}, {1.00, 1.99, 0.99}, 0, 1},
        {"cornell-box/cornell-box-water.glb", 7088, {-1.02, 0, -1.04}, {1.00, 1.59, 0.99}, 0, 1},
        {"pica-pica-diorama/pica-pica-diorama.glb",
         76274,
         {-36.92, -1.17, -32.19},
         {27.37, 18.53, 18.17},
         0,
         0},
        {"stanford-bunny/stanford-bunny.glb",
         69451,
         {-0.09, 0.03, -0.06},
         {0.06, 0.19, 0.06},
         0,
         0},
        {"stanford-dragon/stanford-dragon.glb",
         100000,
         {-1.00, -0.45, -0.71},
         {1.00, 0.45, 0.71},
         0,
         0},
        {"spot/spot.glb", 5856, {-0.47, -0.74, -0.67}, {0.47, 0.95, 1.05}, 0, 0}};
    for (const Expected& e : expected) {
        SCOPED_TRACE(e.file);
        ASSERT_TRUE(std::filesystem::exists(folder / e.file));
        const Scene scene = loadScene((folder / e.file).string());
        EXPECT_EQ(testing::inconsistency(scene), "");
        EXPECT_EQ(scene.triangles.size() + droppedTriangles(scene), e.triangles);
        EXPECT_LT(droppedTriangles(scene), e.triangles / 500 + 1);
        const auto [min, max] = testing::worldBox(scene);
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(min[k], e.min[k], 0.0051);  // the table has two decimals
            EXPECT_NEAR(max[k], e.max[k], 0.0051);
        }
        EXPECT_EQ(scene.lights.size(), e.lights);
        EXPECT_EQ(scene.cameras.size(), e.cameras);
    }
}

TEST(GltfScenes, LoadingTwiceGivesTheSameBytes) {
    REQUIRE_SCENES("living-room");
    const std::string path = (folder / "living-room.glb").string();
    const Scene a = loadScene(path), b = loadScene(path);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.normals, b.normals);
    EXPECT_EQ(a.uvs, b.uvs);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.triangleMaterials, b.triangleMaterials);
    EXPECT_EQ(a.contentHash, b.contentHash);
}

// Colour of a texture at a coordinate, the nearest texel, clamped.
glm::ivec3 texelAt(const Scene& scene, int texture, glm::vec2 uv) {
    const Image& image = scene.images[static_cast<std::size_t>(
        scene.textures[static_cast<std::size_t>(texture)].image)];
    const int x = glm::clamp(static_cast<int>(std::floor(uv.x * static_cast<float>(image.width))),
                             0, image.width - 1);
    const int y = glm::clamp(static_cast<int>(std::floor(uv.y * static_cast<float>(image.height))),
                             0, image.height - 1);
    const auto at = 4 * static_cast<std::size_t>(y * image.width + x);
    return {image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]};
}

TEST(GltfScenes, TheRotatedArrowPointsToItsMarker) {
    // Khronos' own test of KHR_texture_transform: on the quad "Rotation" a black arrow starts at
    // the upper left corner and must point to the marker "Correct", 22.5 degrees off "Not
    // Supported".
    REQUIRE_SCENES("gltf-conformance/TextureTransformTest");
    const Scene scene = loadScene((folder / "TextureTransformTest.gltf").string());
    std::size_t onArrow = 0, samples = 0;
    const glm::dvec2 corner(-1.1 - 0.5, -0.55 + 0.5);
    const glm::dvec2 marker(-1.1 - 0.07904822439840126, -0.55 - 0.5162674857624154);
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const Material& material = scene.materials[scene.triangleMaterials[t]];
        if (material.name != "Rotation") continue;
        const glm::dvec2 a(testing::corner(scene, t, 0)), b(testing::corner(scene, t, 1)),
            c(testing::corner(scene, t, 2));
        for (double s = 0.2; s < 0.75; s += 0.01) {
            const glm::dvec2 p = glm::mix(corner, marker, s);
            // Barycentric weights of p.
            const glm::dmat2 edges(b - a, c - a);
            const glm::dvec2 w = glm::inverse(edges) * (p - a);
            if (w.x < 0 || w.y < 0 || w.x + w.y > 1) continue;
            const auto uvOf = [&](int k) { return scene.uvs[scene.triangles[t][k]]; };
            const glm::vec2 uv = static_cast<float>(1 - w.x - w.y) * uvOf(0) +
                                 static_cast<float>(w.x) * uvOf(1) +
                                 static_cast<float>(w.y) * uvOf(2);
            ++samples;
            if (texelAt(scene, material.baseTexture, uv).x < 100) ++onArrow;
        }
    }
    EXPECT_GT(samples, 40u);
    EXPECT_EQ(onArrow, samples);
}

TEST(GltfScenes, InterpolatedBoxesReturnAfterALoop) {
    REQUIRE_SCENES("gltf-conformance");
    LoadOptions start, later;
    const std::string path = (folder / "InterpolationTest/InterpolationTest.glb").string();
    const Scene first = loadScene(path, start);
    ASSERT_EQ(first.animations.size(), 10u);  // nine boxes', and all of them at once
    EXPECT_TRUE(first.moving);
    later.timeS = 3 * first.animations.back().duration;
    EXPECT_EQ(loadScene(path, later).positions, first.positions);
    later.timeS = 0.9 * first.animations.back().duration;
    const Scene then = loadScene(path, later);
    std::size_t moved = 0;
    for (std::size_t i = 0; i < then.positions.size(); ++i) {
        moved += then.positions[i] != first.positions[i];
    }
    EXPECT_GT(moved, first.positions.size() / 2);
}

}  // namespace
}  // namespace mv
