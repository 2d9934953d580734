// DirectLightPass in scenes whose radiance has a closed form.

#include <array>

#include "gl/gl_fixture.h"
#include "gpu/picture_scenes.h"
#include "renderer/passes/direct_light_pass.h"
#include "renderer/passes/gbuffer_pass.h"
#include "shaders/shared/microfacet.glsl"

namespace mv {
namespace {

using testing::addFloor;
using testing::addQuad;
using testing::emptyScene;
using testing::fromAbove;
using testing::pointLight;
using testing::spotLight;
using testing::sunLight;

class DirectLightTest : public GlTest {
  protected:
    int width = 64, height = 64;
    std::vector<float> position, radiance;
    std::uint32_t shining = 0;

    void render(const Scene& scene, const FrameCamera& camera,
                const std::vector<LightRecord>& lights) {
        GBufferPass pass;
        pass.setScene(scene);
        BvhTables triangles;
        const TriangleBvh bvh = TriangleBvh::build(scene);
        triangles.setScene(scene, bvh);
        DirectLightPass direct;
        gl::Profiler profiler;
        GBuffer g;
        gl::Texture out;
        pass.render(camera, width, height, Materials::full, profiler, g);
        GpuLights strongest;
        strongest.set(lights);
        shining = strongest.count();
        direct.render(strongest, scene.root, triangles, g, profiler, out);
        position = g.position.readFloats(4);
        radiance = out.readFloats(4);
    }
    glm::vec3 positionAt(std::size_t i) const {
        return {position[4 * i], position[4 * i + 1], position[4 * i + 2]};
    }
    glm::vec3 radianceAt(std::size_t i) const {
        return {radiance[4 * i], radiance[4 * i + 1], radiance[4 * i + 2]};
    }
    std::size_t texels() const { return static_cast<std::size_t>(width * height); }
};

// albedo/pi * I * cos / r^2, r in metres.
glm::vec3 expected(glm::vec3 albedo, glm::vec3 intensity, glm::vec3 light, glm::vec3 p,
                   double edge) {
    const glm::vec3 d = light - p;
    const float r = glm::length(d);
    const float meters = r * static_cast<float>(edge);
    return albedo / kPi * intensity * (d.y / r) / (meters * meters);
}

TEST_F(DirectLightTest, APointLightOverAFloorFollowsTheInverseSquareLawInMetres) {
    const glm::vec3 albedo(0.25f, 0.5f, 0.75f), intensity(100, 200, 50), light(0.4f, 0.35f, 0.6f);
    for (const double edge : {1.0, 25.0, 0.01}) {
        Scene s = emptyScene(edge);
        s.materials[0].baseColor = glm::vec4(albedo, 1);
        addFloor(s, 0.1f);
        render(s, fromAbove(), {pointLight(light, intensity)});
        for (std::size_t i = 0; i < texels(); ++i) {
            const glm::vec3 e = expected(albedo, intensity, light, positionAt(i), edge);
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(radianceAt(i)[k], e[k], 2e-3f * e[k]) << i;
        }
    }
    expectNoGlErrors();
}

TEST_F(DirectLightTest, GlossOfAnyRoughnessShinesAsItsBrdfSays) {
    const glm::vec3 base(0.6f, 0.3f, 0.1f), intensity(10, 20, 30), light(0.85f, 0.3f, 0.5f);
    // 6: the coat has normals of its own; 7: what is below it has; 8: the layer is dimmed.
    for (const int i : {0, 1, 2, 3, 4, 5, 6, 7, 8}) {
        const float roughness = std::array{0.3f, 0.6f, 0.9f}[static_cast<std::size_t>(i % 3)];
        const float strength = i < 3 || i == 8 ? 0.0f : 0.75f, coatRoughness = 0.2f;
        const float factor = i == 8 ? 0.1f : 1.0f;
        Scene s = emptyScene();
        s.materials[0].baseColor = glm::vec4(base, 1);
        s.materials[0].specular = kSpecularOfGlass;
        s.materials[0].specularFactor = factor;
        s.materials[0].roughness = roughness;
        s.materials[0].coat = strength;
        s.materials[0].coatRoughness = coatRoughness;
        addFloor(s, 0.1f);
        glm::vec3 n(0, 1, 0), coated = n;
        if (i == 6 || i == 7) {
            s.images.push_back({"lean", 1, 1, {191, 64, 255, 255}});
            s.textures.push_back({0, Wrap::repeat, Wrap::repeat, false});
            (i == 6 ? s.materials[0].coatNormalTexture : s.materials[0].normalTexture) = 0;
            (i == 6 ? s.materials[0].coatNormalScale : s.materials[0].normalScale) = 0.5f;
            for (const glm::vec3& p : s.positions) s.uvs.emplace_back(p.x, p.z);
            const glm::vec2 lean = glm::vec2(191, 64) / 255.0f * 2.0f - 1.0f;
            const float up = std::sqrt(1 - glm::dot(lean, lean));
            (i == 6 ? coated : n) = glm::normalize(glm::vec3(0.5f * lean.x, up, -0.5f * lean.y));
        }
        FrameCamera camera = fromAbove();
        camera.position = {0.1f, 0.3f, 0.5f};
        camera.forward = glm::normalize(glm::vec3(0.8f, -0.3f, 0));
        camera.up = {0, 1, 0};
        render(s, camera, {pointLight(light, intensity)});
        const glm::vec3 f0(kSpecularOfGlass);
        // Normals of 16 bits tell where light grazes the leaning ones.
        const float near = i == 7 ? 0.025f : 0.02f;
        int lit = 0;
        for (std::size_t t = 0; t < texels(); ++t) {
            if (position[4 * t + 3] == 0) continue;
            const glm::vec3 p = positionAt(t), d = light - p;
            const glm::vec3 toEye = glm::normalize(camera.position - p);
            const float r = glm::length(d), cosEye = glm::clamp(glm::dot(n, toEye), 0.0f, 1.0f);
            const glm::vec3 layer = factor * f0;
            const glm::vec3 matt =
                base * (1 - glossReflectance(layer, factor, roughness, cosEye).x);
            const glm::vec3 gloss = ggxBrdf(layer, factor, ggxAlpha(roughness), n, toEye, d / r) *
                                    glossCompensation(layer, roughness, cosEye);
            const float cosCoat = glm::clamp(glm::dot(coated, toEye), 0.0f, 1.0f);
            const glm::vec3 coat = strength *
                                   ggxBrdf(f0, 1, ggxAlpha(coatRoughness), coated, toEye, d / r) *
                                   glossCompensation(f0, coatRoughness, cosCoat);
            const glm::vec3 below = matt / kPi + gloss;
            const glm::vec3 under = below * underCoat(strength, coatRoughness, cosCoat);
            const glm::vec3 e = intensity / (r * r * r) *
                                (under * std::max(glm::dot(n, d), 0.0f) +
                                 coat * std::max(glm::dot(coated, d), 0.0f));
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(radianceAt(t)[k], e[k], near * e[k]) << i;
            ++lit;
        }
        EXPECT_GT(lit, 1000);
    }
    expectNoGlErrors();
}

// Light from any side: a closed room lit from inside has no shadow anywhere, also at grazing
// angles.
TEST_F(DirectLightTest, ARoomLitFromInsideHasNeitherAcneNorSeams) {
    Scene s = emptyScene();
    const float a = 0.1f, b = 0.9f;
    addQuad(s, {glm::vec3(a, a, b), {b, a, b}, {b, a, a}, {a, a, a}});
    addQuad(s, {glm::vec3(a, b, a), {b, b, a}, {b, b, b}, {a, b, b}});
    addQuad(s, {glm::vec3(a, a, a), {b, a, a}, {b, b, a}, {a, b, a}});
    addQuad(s, {glm::vec3(b, a, b), {a, a, b}, {a, b, b}, {b, b, b}});
    addQuad(s, {glm::vec3(a, a, b), {a, a, a}, {a, b, a}, {a, b, b}});
    addQuad(s, {glm::vec3(b, a, a), {b, a, b}, {b, b, b}, {b, b, a}});
    const glm::vec3 light(0.3f, 0.55f, 0.62f);
    for (const glm::vec3 forward : {glm::vec3(0, 0, -1), glm::vec3(0, 0, 1), glm::vec3(1, 0, 0),
                                    glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, -1, 0)}) {
        FrameCamera c;
        c.position = {0.5f, 0.5f, 0.5f};
        c.forward = forward;
        c.yfovRad = 2.0f;
        render(s, c, {pointLight(light, {1, 1, 1})});
        for (std::size_t i = 0; i < texels(); ++i) {
            const glm::vec3 p = positionAt(i), d = light - p;
            glm::vec3 n(0);  // of the wall p lies on
            for (int k = 0; k < 3; ++k) {
                if (std::abs(p[k] - a) < 1e-4f) n[k] = 1;
                if (std::abs(p[k] - b) < 1e-4f) n[k] = -1;
            }
            if (std::abs(n.x) + std::abs(n.y) + std::abs(n.z) != 1) continue;
            const float e = glm::dot(n, d) / std::pow(glm::length(d), 3.0f) / kPi;
            EXPECT_NEAR(radianceAt(i).x, e, 3e-3f * e) << p.x << ' ' << p.y << ' ' << p.z;
        }
    }
}

TEST_F(DirectLightTest, ShadowsFallWhereTheyMustForEveryKindOfLight) {
    // A plate over the floor; light from straight above shadows the square below it, wider by the
    // light's distance.
    Scene s = emptyScene();
    addFloor(s, 0.1f);
    s.materials.push_back({});
    s.materials[1].doubleSided = true;
    addFloor(s, 0.4f, 0.4f, 0.6f, 0.4f, 0.6f, 1);
    FrameCamera c;  // from the side, below the plate
    c.position = {0.5f, 0.25f, 1.4f};
    c.forward = glm::normalize(glm::vec3(0, -0.15f, -0.9f));
    c.yfovRad = 0.8f;
    const glm::vec3 light(0.5f, 0.7f, 0.5f);
    struct Case {
        const char* name;
        LightRecord light;
        float half;  // of the shadow on the floor
    };
    const std::vector<Case> cases = {
        {"point", pointLight(light, {1, 1, 1}), 0.2f},
        {"spot", spotLight(light, {0, -1, 0}, {1, 1, 1}, 0.9f, 0.95f), 0.2f},
        {"wide spot", spotLight(light, {0, -1, 0}, {1, 1, 1}, 1.3f, 1.5f), 0.2f},
        {"sun", sunLight({0, -1, 0}, {1, 1, 1}), 0.1f},
    };
    width = height = 128;
    for (const Case& test : cases) {
        render(s, c, {test.light});
        int lit = 0, dark = 0;
        for (std::size_t i = 0; i < texels(); ++i) {
            const glm::vec3 p = positionAt(i);
            if (position[4 * i + 3] == 0 || std::abs(p.y - 0.1f) > 1e-4f) continue;
            const float outside = std::max(std::abs(p.x - 0.5f), std::abs(p.z - 0.5f)) - test.half;
            if (outside < -1e-4f) {
                ++dark;
                EXPECT_EQ(radianceAt(i).x, 0.0f) << test.name << ' ' << p.x << ' ' << p.z;
            }
            if (outside > 1e-4f && glm::length(glm::vec2(p.x - 0.5f, p.z - 0.5f)) < 0.5f) {
                ++lit;
                EXPECT_GT(radianceAt(i).x, 0.0f) << test.name << ' ' << p.x << ' ' << p.z;
            }
        }
        EXPECT_GT(lit, 100) << test.name;
        EXPECT_GT(dark, 50) << test.name;
    }
    expectNoGlErrors();
}

TEST_F(DirectLightTest, AThinObjectOnTheFloorTouchesItsShadow) {
    // A wall that stands on the floor, sun from the left at 45 degrees: no lit gap at its foot.
    Scene s = emptyScene();
    addFloor(s, 0.1f);
    s.materials[0].doubleSided = true;
    addQuad(s, {glm::vec3(0.5f, 0.1f, 1), {0.5f, 0.1f, 0}, {0.5f, 0.3f, 0}, {0.5f, 0.3f, 1}});
    const std::vector<LightRecord> sun = {sunLight(glm::normalize(glm::vec3(1, -1, 0)), {1, 1, 1})};
    width = height = 256;
    render(s, fromAbove(), sun);
    for (std::size_t i = 0; i < texels(); ++i) {
        const glm::vec3 p = positionAt(i);
        if (std::abs(p.y - 0.1f) > 1e-4f || p.z < 0.05f || p.z > 0.95f) continue;
        if (p.x > 0.5001f && p.x < 0.6999f) {
            EXPECT_EQ(radianceAt(i).x, 0) << p.x;
        }
        if (p.x < 0.4999f || p.x > 0.7001f) {
            EXPECT_NEAR(radianceAt(i).x, std::sqrt(0.5f) / kPi, 1e-3f) << p.x;
        }
    }
}

TEST_F(DirectLightTest, ASpotFallsOffAsTheExtensionSays) {
    Scene s = emptyScene();
    addFloor(s, 0.1f);
    const glm::vec3 light(0.5f, 0.6f, 0.5f);
    for (const auto& [inner, outer] : {std::pair(0.2f, 0.5f), std::pair(0.0f, 1.2f)}) {
        render(s, fromAbove(), {spotLight(light, {0, -1, 0}, {1, 1, 1}, inner, outer)});
        for (std::size_t i = 0; i < texels(); ++i) {
            const glm::vec3 d = light - positionAt(i);
            const float cosine = d.y / glm::length(d);
            // lightAngleScale and lightAngleOffset of KHR_lights_punctual.
            const float scale = 1 / std::max(0.001f, std::cos(inner) - std::cos(outer));
            const float t = std::clamp(cosine * scale - std::cos(outer) * scale, 0.0f, 1.0f);
            const float e = t * t * expected({1, 1, 1}, {1, 1, 1}, light, positionAt(i), 1).x;
            EXPECT_NEAR(radianceAt(i).x, e, 5e-3f * e + 1e-5f) << outer;
        }
    }
}

TEST_F(DirectLightTest, ALightOnASurfaceOrInANastyPlaceGivesFiniteNumbers) {
    Scene s = emptyScene();
    addFloor(s, 0.1f);
    FrameCamera c = fromAbove();
    width = height = 65;
    render(s, c, {});
    const glm::vec3 onTexel = positionAt(texels() / 2);  // bit for bit
    for (const glm::vec3 p : {onTexel, onTexel + glm::vec3(0, 1e-7f, 0),
                              onTexel - glm::vec3(0, 0.4f, 0), glm::vec3(0.9f, 0.1f, 0.9f)}) {
        render(s, c,
               {pointLight(p, {1, 1, 1}), spotLight(p, {0, 1, 0}, {1, 1, 1}, 0.1f, 0.1f),
                spotLight(p, {0, 0, 1}, {1, 1, 1}, 0.0f, kPi / 2), sunLight({0, 1, 0}, {1, 1, 1})});
        for (std::size_t i = 0; i < radiance.size(); ++i) {
            ASSERT_TRUE(std::isfinite(radiance[i])) << i << " light at " << p.y;
        }
    }
}

// Nearer than 1e-4 of the edge a light counts as that far away.
TEST_F(DirectLightTest, ALightNextToASurfaceIsBounded) {
    Scene s = emptyScene(2);
    addFloor(s, 0.1f);
    FrameCamera c = fromAbove(0.1f + 2e-3f, 0.02f);  // a patch of 4e-5
    width = height = 33;
    render(s, c, {});
    const glm::vec3 foot = positionAt(texels() / 2);
    const glm::vec3 albedo = glm::vec3(s.materials[0].baseColor);
    for (const float above : {5e-5f, 3e-4f}) {
        render(s, c, {spotLight(foot + glm::vec3(0, above, 0), {0, -1, 0}, {1, 1, 1}, 0.5f, 1.0f)});
        const double metres = 2 * std::max(double{above}, 1e-4);
        const double expected = double{albedo.x} / kPi / (metres * metres);
        EXPECT_NEAR(radianceAt(texels() / 2).x / expected, 1, 0.01) << above;
    }
}

TEST_F(DirectLightTest, TheStrongestShine) {
    Scene s = emptyScene();
    addFloor(s, 0.1f);
    std::vector<LightRecord> lights(1026, sunLight({0, -1, 0}, {1, 1, 1}));
    lights[3] = sunLight({0, -1, 0}, {0.25f, 0.25f, 0.25f});
    lights[7] = sunLight({0, -1, 0}, {0.5f, 0.5f, 0.5f});
    lights.push_back(sunLight({0, -1, 0}, {0, 0, 0}));
    render(s, fromAbove(), lights);
    EXPECT_EQ(shining, 1024u);
    for (std::size_t i = 0; i < texels(); ++i) EXPECT_NEAR(radianceAt(i).x, 1024 / kPi, 1e-2f);
    render(s, fromAbove(), {});
    EXPECT_EQ(shining, 0u);
    for (std::size_t i = 0; i < texels(); ++i) EXPECT_EQ(radianceAt(i).x, 0.0f);
    render(emptyScene(), fromAbove(), lights);
    for (std::size_t i = 0; i < texels(); ++i) EXPECT_EQ(radianceAt(i).x, 0.0f);
    expectNoGlErrors();
}

TEST_F(DirectLightTest, AMaskLetsLightThroughItsHoles) {
    Scene s = emptyScene();
    addFloor(s, 0.1f);
    s.uvs.assign(4, {0, 0});
    Image image;
    image.width = 2;
    image.height = 1;
    image.rgba = {255, 255, 255, 255, 255, 255, 255, 0};
    s.images.push_back(image);
    Texture texture;
    texture.image = 0;
    texture.nearest = true;
    s.textures.push_back(texture);
    s.materials.push_back({});
    s.materials[1].baseTexture = 0;
    s.materials[1].alphaCutoff = 0.5f;
    addFloor(s, 0.95f, 0, 1, 0, 1, 1);  // above the camera: not seen
    s.uvs.insert(s.uvs.end(), {{0, 0}, {1, 0}, {1, 0}, {0, 0}});
    render(s, fromAbove(), {sunLight({0, -1, 0}, {1, 1, 1})});
    for (std::size_t i = 0; i < texels(); ++i) {
        const float x = positionAt(i).x;
        if (x < 0.4999f) {
            EXPECT_EQ(radianceAt(i).x, 0.0f) << x;
        } else if (x > 0.5001f) {
            EXPECT_NEAR(radianceAt(i).x, 1 / kPi, 1e-3f) << x;
        }
    }
}

}  // namespace
}  // namespace mv
