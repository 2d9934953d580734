// The scenes made by code: well-formed, the same bytes in every build, closed where they must be,
// with lights and cameras that stand free and move in closed loops.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>

#include "megaviews/core/error.h"
#include "megaviews/scene/builtin_mesh.h"
#include "megaviews/scene/framing_probe.h"
#include "megaviews/scene/load_scene.h"
#include "megaviews/scene/rigged_scene.h"
#include "scene/bvh_test_scene.h"
#include "shaders/shared/tone.glsl"
#include "support/sanitized.h"

namespace mv {
namespace {

struct Built {
    Scene scene;
    TriangleBvh bvh;
};
const Built& built(const std::string& name) {
    static std::map<std::string, std::unique_ptr<Built>> cache;
    std::unique_ptr<Built>& b = cache[name];
    if (!b) {
        b = std::make_unique<Built>();
        b->scene = makeBuiltin("builtin:" + name, {});
        b->bvh = TriangleBvh::build(b->scene);
    }
    return *b;
}

template <class T>
std::uint64_t hashed(const std::vector<T>& v, std::uint64_t h = 0xcbf29ce484222325u) {  // FNV-1a
    const auto* bytes = reinterpret_cast<const unsigned char*>(v.data());
    for (std::size_t i = 0; i < v.size() * sizeof(T); ++i) h = (h ^ bytes[i]) * 0x100000001b3u;
    return h;
}
std::uint64_t hashed(const Scene& s) {
    return hashed(s.triangleMaterials,
                  hashed(s.triangles, hashed(s.colors, hashed(s.normals, hashed(s.positions)))));
}

// The hairball's million triangles take a sanitizers' build a minute.
std::vector<const char*> names() {
    std::vector<const char*> all = {"cornell", "atrium", "cathedral", "door"};
    if (!testing::kSanitized) all.push_back("hairball");
    return all;
}

class Builtin : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenes, Builtin, ::testing::ValuesIn(names()),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(Builtin, IsWellFormed) {
    const Scene& s = built(GetParam()).scene;
    EXPECT_EQ(s.name, std::string("builtin:") + GetParam());
    EXPECT_EQ(s.hash.rfind(s.name + "/", 0), 0u) << s.hash;
    ASSERT_EQ(s.normals.size(), s.positions.size());
    ASSERT_EQ(s.triangleMaterials.size(), s.triangles.size());
    EXPECT_TRUE(s.colors.empty() || s.colors.size() == s.positions.size());
    std::size_t badNormals = 0, outside = 0, flat = 0, badIndices = 0;
    for (const glm::vec3& n : s.normals) badNormals += !(std::abs(length3(n) - 1) < 1e-5f);
    for (const glm::vec3& p : s.positions)
        for (int k = 0; k < 3; ++k) outside += !(p[k] > 0.01f && p[k] < 0.99f);
    for (std::size_t i = 0; i < s.triangles.size(); ++i) {
        glm::uvec3 c = s.triangles[i];
        if (std::max({c.x, c.y, c.z}) >= s.positions.size() ||
            s.triangleMaterials[i] >= s.materials.size()) {
            ++badIndices;
            continue;
        }
        flat += !(length3(cross3(s.positions[c.y] - s.positions[c.x],
                                 s.positions[c.z] - s.positions[c.x])) > 0);
    }
    EXPECT_EQ(badNormals, 0u);
    EXPECT_EQ(outside, 0u);
    EXPECT_EQ(badIndices, 0u);
    EXPECT_EQ(flat, 0u);
    for (const Material& m : s.materials)
        for (int k = 0; k < 3; ++k)
            EXPECT_TRUE(m.baseColor[k] >= 0 && m.baseColor[k] <= 1) << m.name;
    EXPECT_FALSE(s.cameras.empty());
    EXPECT_FALSE(s.lights.empty());
    EXPECT_TRUE(s.warnings.empty());
}

TEST_P(Builtin, ShadingNormalsLookTheWayTheTrianglesDo) {
    const Scene& s = built(GetParam()).scene;
    std::size_t against = 0;  // cloth apart, whose folds are sharper than its mesh
    for (std::size_t i = 0; i < s.triangles.size(); ++i) {
        glm::uvec3 c = s.triangles[i];
        if (s.materials[s.triangleMaterials[i]].doubleSided) continue;
        glm::vec3 n =
            cross3(s.positions[c.y] - s.positions[c.x], s.positions[c.z] - s.positions[c.x]);
        against += dot3(n, s.normals[c.x] + s.normals[c.y] + s.normals[c.z]) < 0;
    }
    EXPECT_LE(against, s.triangles.size() / 5000);
}

TEST_P(Builtin, TwoBuildsAreByteEqual) {
    Scene again = makeBuiltin(std::string("builtin:") + GetParam(), {});
    EXPECT_EQ(hashed(again), hashed(built(GetParam()).scene));
    EXPECT_EQ(again.root.edge, built(GetParam()).scene.root.edge);
}

TEST(BuiltinScenes, HaveTheSizesTheyPromise) {
    EXPECT_EQ(built("cornell").scene.triangles.size(), 30u);
    EXPECT_GE(built("atrium").scene.triangles.size(), 200000u);
    EXPECT_LE(built("atrium").scene.triangles.size(), 320000u);
    EXPECT_GE(built("cathedral").scene.triangles.size(), 80000u);
    if (!testing::kSanitized) {
        EXPECT_GE(built("hairball").scene.triangles.size(), 1000000u);
    }
    EXPECT_GE(built("door").scene.triangles.size(), 5000u);
    EXPECT_LE(built("door").scene.triangles.size(), 20000u);
}

// Caches and golden pictures are keyed by name and version: geometry may change only with it.
TEST(BuiltinScenes, BytesAreThoseOfTheirVersion) {
    std::map<std::string, std::uint64_t> bytes;
    for (const char* name : names()) bytes[built(name).scene.hash] = hashed(built(name).scene);
    const std::map<std::string, std::uint64_t> expected = {
        {"builtin:cornell/1", 0xf39c1e7b73f9eb47u},   {"builtin:atrium/2", 0x3466c7a6a103eddcu},
        {"builtin:cathedral/2", 0x2694cca3ddf0d20bu}, {"builtin:hairball/1", 0x1ecded2a05aa3eedu},
        {"builtin:door/1", 0x731c00a5eac7c0c4u},
    };
    for (const auto& [name, hash] : bytes) {
        ASSERT_TRUE(expected.count(name)) << name << " has hash 0x" << std::hex << hash;
        EXPECT_EQ(hash, expected.at(name))
            << name << ": 0x" << std::hex << hash << "; raise the version if this was meant";
    }
}

TEST(BuiltinScenes, UnknownNamesAreRefusedWithTheChoices) {
    try {
        makeBuiltin("builtin:sponza", {});
        FAIL() << "accepted";
    } catch (const Error& e) {
        EXPECT_EQ(e.code, ExitCode::input);
        EXPECT_NE(std::string(e.what()).find("builtin:atrium"), std::string::npos) << e.what();
    }
}

TEST_P(Builtin, LightsMoveInClosedLoopsAndStandFree) {
    Built b = {makeBuiltin(std::string("builtin:") + GetParam(), {}), {}};
    b.bvh = TriangleBvh::build(b.scene);
    ASSERT_EQ(b.scene.animations.size(), 1u);
    double duration = b.scene.animations[0].duration;
    ASSERT_GT(duration, 1);
    EXPECT_TRUE(b.scene.animated());
    auto start = b.scene.lightsAt(0, 0);
    auto late = b.scene.lightsAt(duration * (1 - 1e-4), 0);
    for (std::size_t i = 0; i < start.size(); ++i) {
        EXPECT_LT(glm::length(start[i].position - late[i].position), 0.02);
        EXPECT_LT(glm::length(start[i].direction - late[i].direction), 0.02);
    }
    double farthest = 0;  // of the first light; another may stand
    for (int k = 0; k < 16; ++k) {
        double t = duration * k / 16;
        poseScene(b.scene, t);
        b.bvh.refit();
        farthest =
            std::max(farthest, glm::length(b.scene.lightsAt(t, 0)[0].position - start[0].position));
        for (const PosedLight& light : b.scene.lightsAt(t, 0)) {
            SCOPED_TRACE(light.light.name + " at " + std::to_string(t) + " s");
            glm::vec3 p = b.scene.root.rootFromWorld(light.position);
            framing::FreePoint f = framing::probe(b.bvh, p);
            EXPECT_GT(static_cast<double>(f.clearance) * b.scene.root.edge, 0.04);
            // Most of the cone falls on the fronts of surfaces.
            int in = 0, lit = 0;
            for (glm::vec3 d : framing::sphereDirections(4000)) {
                if (dot3(d, glm::vec3(light.direction)) <
                    static_cast<float>(std::cos(light.light.outerConeRad)))
                    continue;
                ++in;
                auto hit = b.bvh.intersect(p, d, 1e-5f, 4);
                if (!hit) continue;
                BvhSurface s = b.bvh.surface(*hit);
                glm::vec3 n(s.geometricX, s.geometricY, s.geometricZ);
                lit += (s.flags & kMaterialDoubleSided) || dot3(n, d) < 0;
            }
            EXPECT_GT(in, 20);
            EXPECT_GT(lit, (GetParam() == std::string("cornell") ? 0.75 : 0.9) * in);
        }
    }
    EXPECT_GT(farthest, 0.3);
}

TEST_P(Builtin, CamerasSeeFrontsAndNothingTouchesThem) {
    const Built& b = built(GetParam());
    for (const PosedCamera& camera : b.scene.camerasAt(0, 0)) {
        SCOPED_TRACE(camera.camera.name);
        framing::Viewer v{b.scene.root.rootFromWorld(camera.position), glm::vec3(camera.forward),
                          glm::vec3(camera.up)};
        framing::FreePoint f = framing::probe(b.bvh, v.position);
        EXPECT_GT(static_cast<double>(f.clearance) * b.scene.root.edge, 0.1);
        auto seen = framing::surfacesInView(b.bvh, v);
        EXPECT_GT(seen.size(), 40u * 22u / (GetParam() == std::string("cornell") ? 5 : 2));
        int backs = 0;
        for (glm::vec3 d : framing::sphereDirections(3000)) {
            if (dot3(d, v.forward) < 0.7f) continue;
            auto hit = b.bvh.intersect(v.position, d, 1e-5f, 4);
            if (!hit) continue;
            BvhSurface s = b.bvh.surface(*hit);
            backs += !(s.flags & kMaterialDoubleSided) &&
                     dot3({s.geometricX, s.geometricY, s.geometricZ}, d) > 0;
        }
        EXPECT_LE(backs, 3);
    }
}

using builtin::Vec;

// From free places inside, rays end at fronts of surfaces; what escapes goes through the
// openings meant for light.
void expectClosed(const std::string& name, const std::vector<Vec>& places,
                  const std::function<bool(Vec, Vec)>& mayEscape) {
    const Built& b = built(name);
    int rays = 0, backs = 0;
    for (const Vec& place : places)
        for (glm::vec3 d : framing::sphereDirections(8000)) {
            ++rays;
            auto hit = b.bvh.intersect(b.scene.root.rootFromWorld(place), d, 1e-6f, 4);
            if (!hit) {
                EXPECT_TRUE(mayEscape(place, Vec(d)))
                    << name << ": from " << place.x << " " << place.y << " " << place.z << " along "
                    << d.x << " " << d.y << " " << d.z;
                continue;
            }
            BvhSurface s = b.bvh.surface(*hit);
            backs += !(s.flags & kMaterialDoubleSided) &&
                     dot3({s.geometricX, s.geometricY, s.geometricZ}, d) > 0;
        }
    EXPECT_LE(backs, rays / 1000) << name;
}

TEST(BuiltinScenes, HairballsRoomIsClosed) {
    if (testing::kSanitized) GTEST_SKIP() << "too large for a sanitizers' build";
    expectClosed("hairball", {{1.5, 1.5, 1.5}, {-2, 0.2, 2}, {2, 3.2, -2}},
                 [](Vec, Vec) { return false; });
}

TEST(BuiltinScenes, AtriumOpensOnlyThroughTheSkylight) {
    expectClosed(
        "atrium",
        {{0, 4, 0}, {-9, 1, 3.5}, {-12.6, 1.7, -6.9}, {12, 7.2, 7}, {0.5, 7, -7}, {13, 2, 0}},
        [](Vec p, Vec d) {
            if (d.y <= 0) return false;
            Vec at = p + d * ((12.9 - p.y) / d.y);
            return std::abs(at.x) < 6.01 && std::abs(at.z) < 2.01;
        });
}

TEST(BuiltinScenes, CathedralOpensOnlyThroughThreeWindows) {
    expectClosed("cathedral", {{0, 3, 0}, {-14, 1.8, -8.3}, {10, 2, 8.2}, {13, 10, -3}, {0, 17, 0}},
                 [](Vec p, Vec d) {
                     if (d.z <= 0) return false;
                     Vec at = p + d * ((5.5 - p.z) / d.z);
                     return at.y > 10 && at.y < 17.2 && at.x > -6 && at.x < 12;
                 });
}

TEST(BuiltinScenes, OwnSinesAndColoursAgreeWithTheLibrary) {
    for (double t : {-3.7, -1.0, -0.25, 0.0, 0.1, 0.125, 0.25, 0.3, 0.5, 0.99, 17.3}) {
        EXPECT_NEAR(builtin::sinTurns(t), std::sin(2 * 3.141592653589793 * t), 1e-13) << t;
        EXPECT_NEAR(builtin::cosTurns(t), std::cos(2 * 3.141592653589793 * t), 1e-13) << t;
    }
    for (int c = 0; c < 256; ++c)
        EXPECT_NEAR(builtin::srgb(c, 0, 0).r, linearFromSrgbChannel(static_cast<float>(c) / 255.0f),
                    1e-6);
}

TEST(MeshBuilder, BoxesAndLathesFaceOutwards) {
    Scene s;
    builtin::MeshBuilder mesh(s);
    mesh.use(mesh.addMaterial("white", glm::vec3(1)));
    mesh.box({-1, -1, -1}, {1, 1, 1});
    mesh.lathe({{0, -1}, {1, -0.5}, {1, 0.5}, {0, 1}}, 16);
    std::size_t boxEnd = 12;
    mesh.finish();
    for (std::size_t i = 0; i < s.triangles.size(); ++i) {
        glm::uvec3 c = s.triangles[i];
        glm::vec3 a = s.positions[c.x], b = s.positions[c.y], d = s.positions[c.z];
        glm::vec3 outwards = (a + b + d) / 3.0f - 0.5f;
        EXPECT_GT(dot3(cross3(b - a, d - a), outwards), 0)
            << (i < boxEnd ? "box" : "lathe") << " triangle " << i;
    }
}

}  // namespace
}  // namespace mv
