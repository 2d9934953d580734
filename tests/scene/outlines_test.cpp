// Hulls that draw outlines, told from rooms and from what is only thick.

#include "megaviews/scene/outlines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "megaviews/scene/builtin_mesh.h"
#include "scene/gltf_builder.h"

namespace mv {
namespace {

using builtin::MeshBuilder;
using Vec = glm::dvec3;

// Of 2400 quads.
void addBall(MeshBuilder& mesh, double radius, bool insideOut) {
    constexpr int kAround = 60, kUp = 40;
    const auto at = [&](int i, int j) {
        const double a = 2 * std::numbers::pi * i / kAround, b = std::numbers::pi * j / kUp;
        return radius * Vec(std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a));
    };
    for (int j = 0; j < kUp; ++j) {
        for (int i = 0; i < kAround; ++i) {
            const Vec a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            insideOut ? mesh.quad(d, c, b, a) : mesh.quad(a, b, c, d);
        }
    }
}

// A body of material 0 and, if they are above 0, a hull of material 1 of that radius.
std::vector<std::uint32_t> outlinesOf(double body, double hull, bool insideOut = true,
                                      bool doubleSided = false) {
    Scene scene;
    MeshBuilder mesh(scene);
    const auto inner = mesh.addMaterial("body", glm::vec3(0.8f));
    const auto outer = mesh.addMaterial("hull", glm::vec3(0));
    mesh.use(inner);
    addBall(mesh, body, false);
    mesh.use(outer);
    if (hull > 0) addBall(mesh, hull, insideOut);
    mesh.finish();
    scene.materials[1].doubleSided = doubleSided;
    return outlineMaterials(TriangleBvh::build(scene));
}

TEST(Outlines, AHullThatFacesInwardsCloselyAroundABodyIsOne) {
    EXPECT_EQ(outlinesOf(1, 1.02), std::vector<std::uint32_t>{1});
    EXPECT_TRUE(outlinesOf(1, 0).empty());
    EXPECT_TRUE(outlinesOf(1, 1.02, false).empty()) << "it faces outwards: a lacquer";
    EXPECT_TRUE(outlinesOf(1, 1.02, true, true).empty()) << "its outside is seen";
    EXPECT_TRUE(outlinesOf(1, 1.5).empty()) << "a room";
}

TEST(Outlines, MaterialsAreLeftOutOfAFile) {
    testing::GltfBuilder b = testing::GltfBuilder::square();
    b.json["materials"] = {{{"name", "body"}}, {{"name", "hull"}}};
    auto& primitives = b.json["meshes"][0]["primitives"];
    primitives.push_back(testing::Json(primitives[0]));
    primitives[0]["material"] = 0;
    primitives[1]["material"] = 1;
    const Scene whole = testing::loadJson(b);
    LoadOptions options;
    options.without = {1};
    const Scene part = testing::loadJson(b, options);
    EXPECT_EQ(whole.triangles.size(), 2 * part.triangles.size());
    EXPECT_EQ(part.triangleMaterials, std::vector<std::uint32_t>(part.triangles.size(), 0));
    EXPECT_EQ(part.materials.at(1).name, "hull");
}

}  // namespace
}  // namespace mv
