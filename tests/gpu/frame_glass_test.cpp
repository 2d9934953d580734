// What is seen through glass in a frame: as bright as it must be, and bent as Snell's law says.

#include <algorithm>
#include <cmath>
#include <functional>

#include "gpu/reflections_fixture.h"
#include "shaders/shared/microfacet.glsl"

namespace mv::test {
namespace {

using mv::testing::addFloor;
using mv::testing::addQuad;
using mv::testing::emptyScene;
using mv::testing::fromAbove;

// A pane over a floor in white light, seen from above.
class PanesTest : public ReflectionsTest {
  protected:
    double meanThrough(const Material& pane, int sets) {
        settings.scene.environment.source = "white";
        settings.gather.skySamples = 64;
        settings.gather.samples = 8;
        settings.picture.accumulate = sets;
        Scene s = emptyScene();
        s.materials[0] = pane;
        addFloor(s, 0.5f);
        show(std::move(s));
        input.camera = fromAbove(0.9f, 0.5f);
        input.reuse = true;
        return meanOfSets();
    }
    // A floor under a sun or a white sky, below a pane of that colour if there is one, and a mirror
    // as material 2, so that the scene has gloss either way.
    Scene floorUnder(bool pane, bool sky, glm::vec3 colour) {
        settings.scene.environment.source = sky ? "white" : "none";
        settings.gather.samples = sky ? 8 : 0;
        settings.gather.skySamples = 64;
        Scene s = emptyScene();
        s.nodes.push_back({});
        s.nodes.back().rotation = glm::angleAxis(-1.4, glm::dvec3(1, 0, 0));
        if (!sky) s.lights.push_back({.name = "sun", .type = LightType::directional});
        Material glass;
        glass.baseColor = glm::vec4(colour, 1);
        glass.transmission = 1;
        s.materials.push_back(glass);
        s.materials.push_back(mirror());
        addFloor(s, 0.2f);
        if (pane) addFloor(s, 0.22f, 0, 1, 0, 1, 1);
        return s;
    }
    glm::vec3 sumOfPicture() {
        render();
        glm::vec3 sum(0);
        const std::vector<float> picture = radiance();
        for (std::size_t i = 0; i < picture.size(); i += 4) {
            sum += glm::vec3(picture[i], picture[i + 1], picture[i + 2]);
        }
        return sum;
    }
};

TEST_F(PanesTest, GlassLosesNoLight) {
    // A white pane, glossy, rough or clear in part, is as bright as what is behind.
    Material pane;
    pane.specular = 0.04f;
    for (const float roughness : {0.0f, 0.4f, 1.0f}) {
        for (const float transmission : {0.4f, 1.0f}) {
            pane.roughness = roughness;
            pane.transmission = transmission;
            EXPECT_NEAR(meanThrough(pane, 32), 1, 0.03) << roughness << ' ' << transmission;
        }
    }
}

TEST_F(PanesTest, TheSkyShinesThoughNoViewLives) {
    settings.scene.environment.source = "white";
    settings.gather.skySamples = 64;
    settings.gather.samples = 8;
    settings.views.vpls = 1;
    Scene s = emptyScene();
    addFloor(s, 0.5f);
    show(std::move(s));
    input.camera = fromAbove(0.9f, 0.5f);
    for (const int scale : {1, 2}) {
        settings.gather.cull.scale = scale;
        for (const bool filter : {false, true}) {
            settings.gather.filter = filter;
            settings.seed = 0;
            while (settings.seed < 100 && render().viewsAlive > 0) ++settings.seed;
            ASSERT_LT(settings.seed, 100u);
            EXPECT_NEAR(meanOfSets(), 1, 0.02) << scale << filter;
        }
    }
}

TEST_F(PanesTest, ThickGlassLeavesItsColour) {
    Material pane;
    pane.specular = 0.04f;
    pane.specularColor = glm::vec3(0);  // it reflects nothing
    pane.transmission = 1;
    pane.absorption = glm::vec3(0.7f);
    const double thin = meanThrough(pane, 8);
    EXPECT_NEAR(thin, 1, 0.03);
    pane.thickness = 2;
    EXPECT_NEAR(meanThrough(pane, 8), thin * std::exp(-1.4), 1e-3);
}

// A point light below rough glass, which no ray of sight meets: by the density of those that go its
// way, and not at all past what stands between, nor through smooth glass.
TEST_F(PanesTest, RoughGlassGlowsFromALightBehindIt) {
    const glm::vec3 colour(0.81f, 0.25f, 0.04f), lamp(0.5f, 0.3f, 0.5f);
    settings.picture.view = DebugView::direct;
    settings.scene.environment.source = "none";
    input.camera = fromAbove(0.9f);
    input.camera.orthoHalfHeight = 0.2f;
    const auto seen = [&](float roughness, bool wall) {
        Scene s = emptyScene();
        s.nodes.push_back({});
        s.nodes.back().translation = glm::dvec3(lamp);
        s.lights.push_back({.name = "lamp", .type = LightType::point, .intensity = glm::vec3(2)});
        Material glass;
        glass.baseColor = glm::vec4(colour, 1);
        glass.transmission = 1;
        glass.roughness = roughness;
        s.materials.push_back(glass);
        s.materials.push_back(mirror());
        addFloor(s, 0.5f, 0, 1, 0, 1, 1);
        addFloor(s, 0.1f, 0, 1, 0, 1, 2);
        if (wall) addFloor(s, 0.4f);
        show(std::move(s));
        render();
        std::vector<glm::vec3> out;
        const std::vector<float> picture = radiance();
        for (std::size_t i = 0; i < picture.size(); i += 4) {
            out.emplace_back(picture[i], picture[i + 1], picture[i + 2]);
        }
        return out;
    };
    const float roughness = 0.4f;
    const std::vector<glm::vec3> glows = seen(roughness, false), blocked = seen(roughness, true),
                                 smooth = seen(0, false);
    const int size = settings.resolution.width;
    float most = 0;
    for (int i = 0; i < size * size; ++i) {
        const PickRay ray =
            rayThrough(input.camera, size, size, static_cast<float>(i % size) + 0.5f,
                       static_cast<float>(i / size) + 0.5f, 1);
        const glm::vec3 to = lamp - glm::vec3(ray.origin.x, 0.5f, ray.origin.z);
        const glm::vec3 mirrored = glm::normalize(to * glm::vec3(1, -1, 1));
        const glm::vec3 expected =
            colour * 2.0f / glm::dot(to, to) *
            ggxReflectionDensity(ggxAlpha(roughness), {0, 1, 0}, {0, 1, 0}, mirrored);
        const auto at = static_cast<std::size_t>(i);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(glows[at][c], expected[c], 0.01f * expected[c] + 1e-3f) << i;
            EXPECT_EQ(blocked[at][c], 0) << i;
            EXPECT_EQ(smooth[at][c], 0) << i;
        }
        most = std::max(most, expected.r);
    }
    EXPECT_GT(most, 1);
}

// A floor below a coloured pane, seen from between them, relative to the floor alone.
TEST_F(PanesTest, TheLightOfASunAndOfASkyPassesInItsColour) {
    const glm::vec3 colour(0.81f, 0.25f, 0.04f);
    const auto seen = [&](bool pane, bool sky, Materials materials) {
        settings.scene.materials = materials;
        Scene s = floorUnder(pane, sky, colour);
        addFloor(s, 0.1f, 0, 1, 0, 1, 2);
        show(std::move(s));
        input.camera = fromAbove(0.215f, 0.5f);
        return sumOfPicture();
    };
    for (const bool sky : {false, true}) {
        for (const Materials materials : {Materials::full, Materials::lambert}) {
            const glm::vec3 share = seen(true, sky, materials) / seen(false, sky, materials);
            for (int i = 0; i < 3; ++i) {
                const float expected = materials == Materials::full ? colour[i] : 1;
                EXPECT_NEAR(share[i], expected, sky ? 0.01f : 1e-4f) << sky << i;
            }
        }
    }
}

// The same light on a floor that is seen in a mirror.
TEST_F(PanesTest, LightIsTintedInMirrorsToo) {
    const glm::vec3 colour(0.81f, 0.25f, 0.04f);
    const auto seen = [&](bool pane, bool sky) {
        Scene s = floorUnder(pane, sky, colour);
        // Between both an upright mirror, seen along the floor and a little from above.
        addQuad(
            s,
            {glm::vec3(0.3f, 0.201f, 1), {0.3f, 0.201f, 0}, {0.3f, 0.219f, 0}, {0.3f, 0.219f, 1}},
            2);
        show(std::move(s));
        input.camera.position = {0.35f, 0.215f, 0.5f};
        input.camera.forward = glm::normalize(glm::vec3(-0.05f, -0.007f, 0));
        input.camera.up = {0, 1, 0};
        input.camera.yfovRad = 0.1f;
        return sumOfPicture();
    };
    for (const bool sky : {false, true}) {
        const glm::vec3 bare = seen(false, sky), share = seen(true, sky) / bare;
        EXPECT_GT(bare.r, 10) << sky;
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(share[i], colour[i], sky ? 0.02f : 1e-3f) << sky << i;
    }
}

// Unlit surfaces whose colour says where they are in x, seen from the side through glass by
// parallel rays, 45 degrees down.
class BentSightTest : public ReflectionsTest {
  protected:
    void SetUp() override {
        ReflectionsTest::SetUp();
        if (IsSkipped()) return;
        scene = emptyScene();
        scene.materials[0].unlit = true;
        Material glass;
        glass.transmission = 1;
        glass.roughness = 0;
        glass.thickness = 0.1f;
        glass.index = kIndex;
        scene.materials.push_back(glass);
        camera.position = {0.1f, 0.65f, 0.5f};
        camera.forward = glm::normalize(glm::vec3(1, -1, 0));
        camera.up = glm::normalize(glm::vec3(1, 1, 0));
        camera.orthoHalfHeight = 0.03f;
    }
    // Looks from the camera; calls with each pixel's ray and the x that it sees.
    void look(const std::function<void(const PickRay&, float)>& check) {
        scene.colors.clear();
        for (const glm::vec3& p : scene.positions) {
            scene.colors.emplace_back(glm::vec3(scene.colors.size() < ofGlass ? p.x : 1), 1);
        }
        show(scene);
        input.camera = camera;
        render();
        const std::vector<float> seen = radiance();
        const int size = settings.resolution.width;
        for (int i = 0; i < size * size; ++i) {
            const float x = static_cast<float>(i % size), y = static_cast<float>(i / size);
            check(rayThrough(camera, size, size, x + 0.5f, y + 0.5f, 1),
                  seen[static_cast<std::size_t>(4 * i)]);
        }
    }
    // Where a ray of 45 degrees down reaches a height.
    static float at(const PickRay& ray, float height) {
        return ray.origin.x + ray.origin.y - height;
    }
    static constexpr float kIndex = 1.5f;
    static constexpr float kTolerance = 2e-3f;    // colours are halves
    const float sine = std::sqrt(0.5f) / kIndex;  // inside
    const float slope = sine / std::sqrt(1 - sine * sine);
    Scene scene;
    std::size_t ofGlass = 0;  // its first vertex
    FrameCamera camera;
};

TEST_F(BentSightTest, APlateShiftsWhatIsBehindIt) {
    addFloor(scene, 0.2f);
    ofGlass = scene.positions.size();
    addFloor(scene, 0.5f, 0, 1, 0, 1, 1);
    addQuad(scene, {glm::vec3(0, 0.4f, 0), {1, 0.4f, 0}, {1, 0.4f, 1}, {0, 0.4f, 1}}, 1);
    // Goes 0.1 down inside.
    look([&](const PickRay& ray, float x) {
        EXPECT_NEAR(x, at(ray, 0.2f) - 0.1f * (1 - slope), kTolerance);
    });
    scene.materials[1].thickness = 0;
    look([&](const PickRay& ray, float x) { EXPECT_NEAR(x, at(ray, 0.2f), kTolerance); });
    // The floor right below is met, not missed where the faces lie on each other.
    scene.materials[1].thickness = 0.1f;
    for (glm::vec3& p : scene.positions) p.y = p.y == 0.2f ? 0.4f : p.y;
    look([&](const PickRay& ray, float x) {
        EXPECT_NEAR(x, at(ray, 0.5f) + 0.1f * slope, kTolerance);
    });
}

// A rough pane that bends nothing shows what is behind it as it is.
TEST_F(BentSightTest, RoughnessSpreadsLessWhereLightBendsLess) {
    addFloor(scene, 0.2f);
    ofGlass = scene.positions.size();
    addFloor(scene, 0.5f, 0, 1, 0, 1, 1);
    scene.materials[1].thickness = 0;
    scene.materials[1].roughness = 0.3f;
    const auto spread = [&](float index) {
        scene.materials[1].index = index;
        double sum = 0;
        look([&](const PickRay& ray, float x) { sum += std::abs(x - at(ray, 0.2f)); });
        return sum / (settings.resolution.width * settings.resolution.width);
    };
    EXPECT_LT(spread(1), kTolerance);
    const double ofGlassItself = spread(1.5f);
    EXPECT_GT(ofGlassItself, 10 * kTolerance);
    EXPECT_LT(spread(1.25f), 0.6 * ofGlassItself);
    EXPECT_EQ(spread(2), ofGlassItself);
}

// A mirror before the camera shows the bent sight, in the colour of what fills.
TEST_F(BentSightTest, AMirrorShowsItToo) {
    scene.materials.push_back(mirror());
    scene.materials[1].baseColor = {0.5f, 1, 1, 1};
    addFloor(scene, 0.2f);
    ofGlass = scene.positions.size();
    addFloor(scene, 0.5f, 0.2f, 0.6f, 0, 1, 1);
    addQuad(scene, {glm::vec3(0.2f, 0.4f, 0), {0.6f, 0.4f, 0}, {0.6f, 0.4f, 1}, {0.2f, 0.4f, 1}},
            1);
    // Upright at x = 0.8, it sends the rays, 45 degrees down, back through the plate.
    addQuad(scene, {glm::vec3(0.8f, 0.5f, 0), {0.8f, 0.5f, 1}, {0.8f, 1, 1}, {0.8f, 1, 0}}, 2);
    camera.position = {0.65f, 0.95f, 0.5f};
    // Mirrors are not quite smooth: a few rays go elsewhere.
    std::vector<float> errors;
    look([&](const PickRay& ray, float x) {
        errors.push_back(std::abs(2 * x - (1.6f - at(ray, 0.2f) + 0.1f * (1 - slope))));
    });
    const auto most = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() * 9 / 10);
    std::nth_element(errors.begin(), most, errors.end());
    EXPECT_LT(*most, 0.02f);
}

TEST_F(BentSightTest, NothingGetsOutAtAFlatAngle) {
    // In through a side, back up from the bottom, out of the other side, and up to the ceiling.
    addQuad(scene, {glm::vec3(0.6f, 0.6f, 0), {1, 0.6f, 0}, {1, 0.6f, 1}, {0.6f, 0.6f, 1}});
    ofGlass = scene.positions.size();
    const auto side = [&](float x, bool right) {
        std::array<glm::vec3, 4> corners = {
            glm::vec3(x, 0.3f, 0), {x, 0.3f, 1}, {x, 0.5f, 1}, {x, 0.5f, 0}};
        if (right) std::swap(corners[1], corners[3]);
        addQuad(scene, corners, 1);
    };
    side(0.4f, false);
    side(0.6f, true);
    addQuad(scene, {glm::vec3(0.4f, 0.3f, 0), {0.6f, 0.3f, 0}, {0.6f, 0.3f, 1}, {0.4f, 0.3f, 1}},
            1);
    int compared = 0;
    look([&](const PickRay& ray, float x) {
        const float enters = ray.origin.x + ray.origin.y - 0.4f;  // its height
        const float turns = 0.4f + (enters - 0.3f) / slope;
        const float leaves = 0.3f + (0.6f - turns) * slope;
        if (enters < 0.305f || turns > 0.595f) return;
        EXPECT_NEAR(x, 0.6f + 0.6f - leaves, kTolerance);
        ++compared;
    });
    EXPECT_GT(compared, 500);
}

}  // namespace
}  // namespace mv::test
