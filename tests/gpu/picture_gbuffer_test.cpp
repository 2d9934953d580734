// GBufferPass against positions, normals and colours known by construction.

#include <random>

#include "gl/gl_fixture.h"
#include "gpu/picture_scenes.h"
#include "renderer/passes/gbuffer_pass.h"
#include "renderer/passes/scene_geometry.h"
#include "renderer/passes/sky_pass.h"
#include "shaders/shared/microfacet.glsl"

namespace mv {
namespace {

using testing::addFloor;
using testing::addQuad;
using testing::emptyScene;
using testing::fromAbove;

class GBufferTest : public GlTest {
  protected:
    // The texels of the last render, bottom row first.
    std::vector<float> position, normal, albedo, emission, depth;
    int width = 0, height = 0;

    void render(const Scene& scene, const FrameCamera& camera, int w, int h) {
        GBufferPass pass;
        pass.setScene(scene);
        render(pass, camera, w, h);
    }
    void render(GBufferPass& pass, const FrameCamera& camera, int w, int h) {
        gl::Profiler profiler;
        GBuffer g;
        pass.render(camera, w, h, Materials::full, profiler, g);
        read(g);
    }
    void read(const GBuffer& g) {
        width = g.width;
        height = g.height;
        position = g.position.readFloats(4);
        normal = g.normal.readFloats(4);
        albedo = g.albedo.readFloats(4);
        emission = g.emission.readFloats(4);
        depth = g.depth.readFloats(1);
    }
    std::size_t at(int x, int y) const { return 4 * static_cast<std::size_t>(y * width + x); }
    int covered() const {
        int n = 0;
        for (std::size_t i = 3; i < position.size(); i += 4) n += position[i] == 1.0f;
        return n;
    }
};

TEST_F(GBufferTest, WhatHasNoGlossIsTheSameBesideGloss) {
    // Unlit, matt and a mirror side by side: the mirror's layer and edge are its own.
    const auto floors = [](bool withMirror) {
        Scene s = emptyScene();
        s.materials[0].baseColor = {0.2f, 0.4f, 0.6f, 1};
        s.materials[0].unlit = true;
        s.materials.push_back({});
        s.materials[1].baseColor = {0.3f, 0.5f, 0.7f, 1};
        s.materials.push_back({});
        s.materials[2].metallic = withMirror ? 1.0f : 0.0f;
        s.materials[2].roughness = 0;
        addFloor(s, 0.2f, 0, 0.4f, 0, 1, 0);
        addFloor(s, 0.2f, 0.4f, 0.6f, 0, 1, 1);
        addFloor(s, 0.2f, 0.6f, 1, 0, 1, 2);
        return s;
    };
    render(floors(false), fromAbove(), 64, 48);
    const std::vector<float> alone = albedo;
    render(floors(true), fromAbove(), 64, 48);
    int matt = 0;
    for (std::size_t i = 0; i < albedo.size(); i += 4) {
        if (position[i + 3] == 0 || position[i] >= 0.6f) continue;
        ++matt;
        for (std::size_t c = i; c < i + 3; ++c) EXPECT_EQ(albedo[c], alone[c]);
    }
    EXPECT_GT(matt, 100);
}

TEST_F(GBufferTest, NormalsInTheTrianglesPlaneStay) {
    Scene s = emptyScene();
    addFloor(s, 0.2f);
    const glm::vec3 along = glm::normalize(glm::vec3(0.6f, 0, 0.8f));
    for (glm::vec3& n : s.normals) n = along;
    FrameCamera slanted = fromAbove();
    slanted.forward = glm::normalize(glm::vec3(0.3f, -0.8f, 0.2f));
    slanted.up = glm::normalize(glm::cross(glm::vec3(0.9f, 0.1f, 0.3f), slanted.forward));
    for (const FrameCamera& camera : {fromAbove(), slanted}) {
        render(s, camera, 64, 48);
        EXPECT_GT(covered(), 0);
        for (std::size_t i = 0; i < normal.size(); i += 4) {
            if (position[i + 3] == 0) continue;
            EXPECT_GT(glm::dot(glm::vec3(normal[i], normal[i + 1], normal[i + 2]), along), 0.999f);
        }
    }
}

TEST_F(GBufferTest, AnEmptySceneIsClearedAtAwkwardSizes) {
    for (const auto& [w, h] : {std::pair(1, 1), std::pair(7, 3), std::pair(65, 64)}) {
        render(emptyScene(), fromAbove(), w, h);
        EXPECT_EQ(covered(), 0);
        for (const float x : position) EXPECT_EQ(x, 0.0f);
        for (const float x : emission) EXPECT_EQ(x, 0.0f);
        for (const float x : depth) EXPECT_EQ(x, 0.0f);
    }
    GBufferPass without;
    render(without, fromAbove(), 4, 4);
    EXPECT_EQ(covered(), 0);
    expectNoGlErrors();
}

TEST_F(GBufferTest, AFloorHasTheTexelsPositionsItsRaysSay) {
    Scene s = emptyScene();
    s.materials[0].baseColor = {0.25f, 0.5f, 0.75f, 1};
    s.materials[0].emission = {1e5f, 2, 3};
    addFloor(s, 0.2f);
    const FrameCamera camera = fromAbove();
    render(s, camera, 40, 30);
    EXPECT_EQ(covered(), 40 * 30);
    const float t = std::tan(camera.yfovRad / 2) * 0.7f;  // half the height of the picture on it
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t i = at(x, y);
            EXPECT_NEAR(position[i], 0.5f + t * (2 * (static_cast<float>(x) + 0.5f) - 40) / 30,
                        1e-5f);
            EXPECT_NEAR(position[i + 1], 0.2f, 1e-6f);
            EXPECT_NEAR(position[i + 2], 0.5f - t * (2 * (static_cast<float>(y) + 0.5f) - 30) / 30,
                        1e-5f);
            EXPECT_EQ(normal[i + 1], 1.0f);
            EXPECT_NEAR(normal[i + 3], 0.7f, 1e-3f);
            EXPECT_EQ(albedo[i], 0.25f);
            EXPECT_EQ(albedo[i + 2], 0.75f);
            EXPECT_EQ(emission[i], 1e5f);
        }
    }
    expectNoGlErrors();
}

TEST_F(GBufferTest, RaysThroughPixelsMeetTheirPositions) {
    Scene s = emptyScene();
    addFloor(s, 0.2f);
    FrameCamera slanted;
    slanted.position = {0.3f, 0.8f, 0.9f};
    slanted.forward = glm::normalize(glm::vec3(0.2f, -1, -0.7f));
    FrameCamera parallel = slanted;
    parallel.orthoHalfHeight = 0.2f;
    for (const FrameCamera& camera : {slanted, parallel}) {
        render(s, camera, 31, 17);
        EXPECT_GT(covered(), 100);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const std::size_t i = at(x, y);
                if (position[i + 3] == 0) continue;
                const glm::vec3 p(position[i], position[i + 1], position[i + 2]);
                const PickRay ray = rayThrough(camera, width, height, static_cast<float>(x) + 0.5f,
                                               static_cast<float>(y) + 0.5f, 1);
                EXPECT_NEAR(glm::length(ray.direction), 1, 1e-5f);
                const float along = glm::dot(p - ray.origin, ray.direction);
                EXPECT_LT(glm::distance(p, ray.origin + ray.direction * along), 2e-5f);
                // A pixel's radius reaches its neighbour and not the one beyond.
                const PickRay beside =
                    rayThrough(camera, width, height, static_cast<float>(x) + 1.5f,
                               static_cast<float>(y) + 0.5f, 1);
                const glm::vec3 q = beside.origin + beside.direction * along;
                const glm::vec3 way = q - ray.origin;
                const float aside = glm::length(way - ray.direction * glm::dot(way, ray.direction));
                EXPECT_NEAR(aside, ray.radiusAt(along), 0.3f * ray.radiusAt(along));
            }
        }
    }
}

TEST_F(GBufferTest, OneTriangleCoversWhatItCovers) {
    Scene s = emptyScene();
    s.positions = {{0, 0.5f, 1}, {1, 0.5f, 1}, {0, 0.5f, 0}};
    s.normals.assign(3, {0, 1, 0});
    s.triangles = {{0, 1, 2}};
    s.triangleMaterials = {0};
    FrameCamera c = fromAbove();
    c.orthoHalfHeight = 0.5f;
    render(s, c, 64, 64);
    EXPECT_NEAR(covered(), 64 * 64 / 2, 64);
    // Lower left in the picture: x from 0, z from 1.
    EXPECT_EQ(position[at(1, 1) + 3], 1.0f);
    EXPECT_EQ(position[at(62, 62) + 3], 0.0f);
    EXPECT_NEAR(normal[at(1, 1) + 3], 0.4f, 1e-3f);
}

TEST_F(GBufferTest, SingleSidedBacksAreNotSeenAndDoubleSidedOnesFaceTheCamera) {
    Scene s = emptyScene();
    addFloor(s, 0.5f);
    FrameCamera below = fromAbove();
    below.position = {0.5f, 0.1f, 0.5f};
    below.forward = {0, 1, 0};
    render(s, below, 8, 8);
    EXPECT_EQ(covered(), 0);
    s.materials[0].doubleSided = true;
    render(s, below, 8, 8);
    EXPECT_EQ(covered(), 64);
    EXPECT_EQ(normal[at(3, 3) + 1], -1.0f);
    // A file whose normals contradict its winding is turned as well.
    for (glm::vec3& n : s.normals) n = -n;
    render(s, below, 8, 8);
    EXPECT_EQ(normal[at(3, 3) + 1], -1.0f);
    render(s, fromAbove(), 8, 8);
    EXPECT_EQ(normal[at(3, 3) + 1], 1.0f);
}

TEST_F(GBufferTest, TheNearerSurfaceWinsAtAnyDistance) {
    // Two floors a hair apart, far away: 2e-6 of the root edge at distance 0.9.
    Scene s = emptyScene();
    s.materials.push_back({});
    s.materials[1].baseColor = {1, 0, 0, 1};
    addFloor(s, 1e-4f, 0, 1, 0, 1, 0);
    addFloor(s, 1e-4f + 2e-6f, 0, 1, 0, 1, 1);
    render(s, fromAbove(), 50, 50);
    for (int i = 0; i < 2500; ++i) EXPECT_EQ(albedo[static_cast<std::size_t>(4 * i + 1)], 0.0f);
    // And close by.
    FrameCamera close = fromAbove(3e-4f);
    render(s, close, 50, 50);
    EXPECT_EQ(covered(), 2500);
    for (int i = 0; i < 2500; ++i) EXPECT_EQ(albedo[static_cast<std::size_t>(4 * i + 1)], 0.0f);
}

TEST_F(GBufferTest, TexturesAreDecodedMaskedAndWrapped) {
    Scene s = emptyScene();
    // Left half: sRGB 188 (0.5029 linear), opaque. Right half: cut out.
    Image image;
    image.width = 2;
    image.height = 1;
    image.rgba = {188, 0, 255, 255, 10, 10, 10, 0};
    s.images.push_back(image);
    Texture texture;
    texture.image = 0;
    texture.nearest = true;
    s.textures.push_back(texture);
    s.materials[0].baseTexture = 0;
    s.materials[0].baseColor = {0.5f, 1, 1, 1};
    addFloor(s, 0);
    // u runs along x from -1 to 1: the picture repeats.
    s.uvs = {{-1, 0}, {1, 0}, {1, 0}, {-1, 0}};
    FrameCamera c = fromAbove();
    c.orthoHalfHeight = 0.5f;
    render(s, c, 64, 16);
    EXPECT_EQ(covered(), 16 * 16);  // the floor is a square in the middle
    EXPECT_NEAR(albedo[at(25, 8)], 0.5f * 0.5029f, 1e-3f);
    EXPECT_NEAR(albedo[at(25, 8) + 2], 1.0f, 1e-3f);
    EXPECT_NEAR(albedo[at(30, 8) + 2], 0.00304f, 1e-4f);
    EXPECT_NEAR(albedo[at(34, 8)], 0.5f * 0.5029f, 1e-3f);
    s.materials[0].alphaCutoff = 0.5f;
    render(s, c, 64, 16);
    EXPECT_EQ(covered(), 16 * 16 / 2);
    // Emission by a texture; unlit: a base colour that shines and reflects nothing.
    s.materials[0].alphaCutoff = 0;
    s.materials[0].emission = {2, 2, 2};
    s.materials[0].emissiveTexture = 0;
    s.emissiveUvs = s.uvs;
    s.colors.assign(4, {0.5f, 0.5f, 0.5f, 1});
    render(s, c, 64, 16);
    EXPECT_NEAR(albedo[at(25, 8)], 0.25f * 0.5029f, 1e-3f);
    EXPECT_NEAR(emission[at(25, 8)], 2 * 0.5029f, 3e-3f);
    s.materials[0].unlit = true;
    s.materials[0].emission = {};
    s.materials[0].emissiveTexture = -1;
    render(s, c, 64, 16);
    EXPECT_EQ(albedo[at(25, 8)], 0.0f);
    EXPECT_NEAR(emission[at(25, 8)], 0.25f * 0.5029f, 1e-3f);
    expectNoGlErrors();
}

TEST_F(GBufferTest, ParticlesAreDiscsInFrontOfWhatTheyHide) {
    Scene s = emptyScene(2);
    addFloor(s, 0.2f);
    GBufferPass pass;
    pass.setScene(s);
    gl::Profiler profiler;
    GBuffer g;
    FrameCamera c = fromAbove();
    pass.render(c, 101, 101, Materials::full, profiler, g);
    std::vector<View> views(3);
    views[0] = {0.5f, 0.6f, 0.5f, kViewOmnidirectional, 0, 0, 0, 0, 1, 2, 4, 0};
    views[1] = {0.6f, 0.1f, 0.5f, kViewOmnidirectional, 0, 0, 0, 0, 1, 1, 1, 1};  // below the floor
    views[2] = {0.4f, 0.6f, 0.5f, kViewDead, 0, 0, 0, 0, 1, 1, 1, 2};
    GpuViews gpu;
    gpu.views = {"views", views};
    gpu.count = 3;
    pass.drawParticles(gpu, s.root, c, profiler, g);
    read(g);
    // Of the three only the live one above the floor is seen, in the middle.
    int hidden = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (position[at(x, y) + 3] == 1.0f) continue;
            ++hidden;
            EXPECT_LE(std::max(std::abs(x - 50), std::abs(y - 50)), 3) << x << ' ' << y;
        }
    }
    EXPECT_GE(hidden, 1);
    const std::size_t center = at(50, 50);
    EXPECT_EQ(position[center + 3], 0.0f);
    EXPECT_GT(emission[center], 0.0f);
    EXPECT_FLOAT_EQ(emission[center + 1], 2 * emission[center]);
    EXPECT_FLOAT_EQ(emission[center + 2], 4 * emission[center]);
    // flux / (4 pi^2 r^2) with the radius of the disc that was drawn, in metres.
    const float radius = std::sqrt(1 / (4 * kPi * kPi * emission[center]));
    const float pixelM = 2 * 0.3f * 2 * std::tan(0.5f) / 101;
    EXPECT_GE(radius, 0.5f * pixelM);
    EXPECT_LE(radius, 3 * pixelM);
    gpu.count = 0;
    pass.drawParticles(gpu, s.root, c, profiler, g);
    expectNoGlErrors();
}

// Sky and particles leave no gloss, coat or glass where no surface is: rays would follow them.
TEST_F(GBufferTest, SkyAndParticlesWriteEveryTarget) {
    Scene s = emptyScene();
    s.materials[0].coat = 1;
    s.materials[0].specular = kSpecularOfGlass;
    s.materials.push_back(s.materials[0]);
    s.materials[1].transmission = 1;
    addFloor(s, 0.2f, 0.3f, 0.5f);
    addFloor(s, 0.3f, 0.5f, 0.7f, 0, 1, 1);
    GBufferPass pass;
    pass.setScene(s);
    gl::Profiler profiler;
    GBuffer g;
    const FrameCamera c = fromAbove();
    Environment white;
    white.settings.source = "white";
    GpuSky sky;
    sky.set(makeSky(s, {}, white, 1));
    const std::vector<View> views = {
        {0.5f, 0.6f, 0.5f, kViewOmnidirectional, 0, 0, 0, 0, 1, 2, 4, 0}};
    GpuViews gpu;
    gpu.views = {"views", views};
    gpu.count = 1;
    for (const bool particles : {false, true}) {
        pass.render(c, 64, 64, Materials::full, profiler, g);
        pass.drawSky(sky, c, profiler, g);
        if (particles) pass.drawParticles(gpu, s.root, c, profiler, g);
        read(g);
        int empty = 0;
        for (const gl::Texture* target : {&g.gloss, &g.clear, &g.coat}) {
            ASSERT_TRUE(*target);
            const std::vector<float> texels = target->readFloats(4);
            for (std::size_t i = 0; i < texels.size(); ++i) {
                if (position[i / 4 * 4 + 3] != 0.0f) continue;
                ++empty;
                ASSERT_EQ(texels[i], 0.0f) << i << ' ' << particles;
            }
        }
        EXPECT_GT(empty, 1000);
    }
    expectNoGlErrors();
}

// What is left out by frustum and chunks is never seen: a picture of many triangles equals one in
// which each chunk was drawn.
TEST_F(GBufferTest, CullingNeverHidesATriangle) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-1, 1);
    int outside = 0, touching = 0;
    for (int round = 0; round < 200; ++round) {
        FrameCamera c;
        c.position = {uniform(random), uniform(random), uniform(random)};
        c.forward = glm::normalize(glm::vec3(uniform(random), uniform(random), uniform(random)) +
                                   glm::vec3(0, 0, 1e-3f));
        c.yfovRad = 0.3f + std::abs(uniform(random));
        if (round % 4 == 0) c.orthoHalfHeight = 0.2f;
        const glm::mat4 m = c.clipFromWorld(1.5f);
        const Frustum frustum(m);
        for (int i = 0; i < 50; ++i) {
            const glm::vec3 center(uniform(random), uniform(random), uniform(random));
            const glm::vec3 half =
                0.2f * glm::abs(glm::vec3(uniform(random), uniform(random), uniform(random)));
            bool seen = false;
            for (int k = 0; k < 64 && !seen; ++k) {
                const glm::vec3 p =
                    center + half * glm::vec3(uniform(random), uniform(random), uniform(random));
                const glm::vec4 q = m * glm::vec4(p, 1);
                seen = std::abs(q.x) <= q.w && std::abs(q.y) <= q.w && q.z >= 0 && q.z <= q.w;
            }
            const bool kept = frustum.touches(center - half, center + half);
            EXPECT_TRUE(kept || !seen) << "round " << round << " box " << i;
            outside += !kept;
            touching += kept;
        }
    }
    EXPECT_GT(outside, 1000);
    EXPECT_GT(touching, 1000);
}

TEST_F(GBufferTest, ChunksHoldEachTriangleOnceAndTheSameBytesComeTwice) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (const int count : {0, 1, 127, 128, 129, 5000}) {
        Scene s = emptyScene();
        s.materials.resize(3);
        for (int i = 0; i < 3; ++i) {
            s.materials[static_cast<std::size_t>(i)].doubleSided = true;
            s.materials[static_cast<std::size_t>(i)].baseColor[i] = 0.1f;
        }
        for (int i = 0; i < count; ++i) {
            const glm::vec3 p(uniform(random), uniform(random), uniform(random));
            const auto first = static_cast<std::uint32_t>(s.positions.size());
            for (int k = 0; k < 3; ++k) {
                s.positions.push_back(
                    p + 0.05f * glm::vec3(uniform(random), uniform(random), uniform(random)));
                s.normals.push_back({0, 1, 0});
            }
            s.triangles.push_back({first, first + 1, first + 2});
            s.triangleMaterials.push_back(static_cast<std::uint32_t>(i % 3));
        }
        const SceneGeometry geometry(s);
        std::uint32_t triangles = 0;
        for (const GeometryChunk& chunk : geometry.chunks()) {
            EXPECT_EQ(chunk.firstTriangle, triangles);
            triangles += chunk.triangles;
        }
        EXPECT_EQ(triangles, static_cast<std::uint32_t>(count));
        FrameCamera c;
        c.position = {0.5f, 0.5f, 2};
        render(s, c, 97, 61);
        const std::vector<float> firstPosition = position, firstAlbedo = albedo;
        if (count == 5000) {
            EXPECT_GT(covered(), 1000);
        }
        render(s, c, 97, 61);
        EXPECT_EQ(position, firstPosition);
        EXPECT_EQ(albedo, firstAlbedo);
    }
    expectNoGlErrors();
}

}  // namespace
}  // namespace mv
