// What glossy surfaces show in a frame: a mirror against the picture from behind it, gloss of any
// roughness in even light, and what scenes without gloss are spared.

#include <algorithm>
#include <cmath>

#include "gpu/picture_scenes.h"
#include "gpu/reflections_fixture.h"
#include "megaviews/settings/settings_table.h"
#include "shaders/shared/microfacet.glsl"

namespace mv::test {
namespace {

using mv::testing::addFloor;
using mv::testing::addQuad;
using mv::testing::emptyScene;
using mv::testing::fromAbove;

bool isEmpty(const std::vector<float>& picture) {
    return std::all_of(picture.begin(), picture.end(), [](float x) { return x == 0 || x == 1; });
}

// A matt room whose wall at x = 0.2 is the mirror or, seen from behind, absent; a lamp and a block.
Scene room(bool withMirror) {
    Scene s = emptyScene();
    s.materials[0].baseColor = {0.7f, 0.4f, 0.2f, 1};
    Material lamp;
    lamp.emission = {6, 8, 9};
    s.materials.push_back(lamp);
    s.materials.push_back({});
    s.materials[2].metallic = 1;
    s.materials[2].roughness = 0;
    addFloor(s, 0.1f, 0.2f, 0.9f, 0.1f, 0.9f);
    addQuad(
        s,
        {glm::vec3(0.9f, 0.1f, 0.1f), {0.9f, 0.1f, 0.9f}, {0.9f, 0.9f, 0.9f}, {0.9f, 0.9f, 0.1f}});
    addQuad(
        s,
        {glm::vec3(0.5f, 0.8f, 0.3f), {0.7f, 0.8f, 0.3f}, {0.7f, 0.8f, 0.6f}, {0.5f, 0.8f, 0.6f}},
        1);
    addQuad(
        s,
        {glm::vec3(0.6f, 0.1f, 0.5f), {0.8f, 0.1f, 0.4f}, {0.8f, 0.4f, 0.4f}, {0.6f, 0.4f, 0.5f}});
    if (withMirror) {
        addQuad(s,
                {glm::vec3(0.2f, 0.1f, 0.9f),
                 {0.2f, 0.1f, 0.1f},
                 {0.2f, 0.9f, 0.1f},
                 {0.2f, 0.9f, 0.9f}},
                2);
    }
    return s;
}

TEST_F(ReflectionsTest, AMirrorShowsWhatIsSeenFromBehindIt) {
    // Views that are loaded: those of the room with the mirror light both.
    show(room(true));
    FrameCamera camera;
    camera.position = {0.45f, 0.5f, 0.52f};
    camera.forward = {-1, 0, 0};
    camera.up = {0, 1, 0};
    camera.yfovRad = 0.9f;
    input.camera = camera;
    render();
    const ViewSet views = renderer->readViews();
    for (const Method method : {Method::none, Method::shadowRays}) {
        settings.side[0].method = method;
        show(room(true));
        renderer->setViews(views);
        input.camera = camera;
        render();
        const std::vector<float> inMirror = radiance();
        show(room(false));
        renderer->setViews(views);
        input.camera.position.x = 0.4f - camera.position.x;
        input.camera.forward.x = 1;
        render();
        const std::vector<float> behind = radiance();
        ASSERT_FALSE(isEmpty(behind));
        const int size = settings.resolution.width;
        int apart = 0;
        double sum = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                for (int c = 0; c < 3; ++c) {
                    const auto a = static_cast<std::size_t>(4 * (y * size + x) + c);
                    const auto b = static_cast<std::size_t>(4 * (y * size + size - 1 - x) + c);
                    const float most = std::max({inMirror[a], behind[b], 0.01f});
                    apart += std::abs(inMirror[a] - behind[b]) > 0.06f * most;
                    sum += static_cast<double>(behind[b]);
                }
            }
        }
        EXPECT_GT(sum, 100);
        // Edges fall on the other pixel where a ray is a hair off; the mirror's lobe is not a
        // point.
        EXPECT_LT(apart, 3 * size * size / 12) << nameOf(method);
    }
}

TEST_F(ReflectionsTest, WhiteMetalOfAnyRoughnessVanishesInWhiteLight) {
    settings.scene.environment.source = "white";
    settings.gather.skySamples = 64;
    settings.gather.samples = 8;
    settings.gather.filter = true;
    settings.picture.accumulate = 32;
    for (const float roughness : {0.0f, 0.25f, 0.5f, 0.6f, 0.9f, -0.5f}) {
        Scene s = emptyScene();
        s.materials[0] = mirror(std::abs(roughness));
        if (roughness < 0) s.materials[0].coat = 1;
        addFloor(s, 0.5f);
        show(std::move(s));
        input.camera = fromAbove(0.9f, 0.5f);
        input.reuse = true;
        const double mean = meanOfSets();
        // The sky itself.
        Scene nothing = emptyScene();
        addFloor(nothing, 0.01f, 0, 0.01f, 0, 0.01f);
        show(std::move(nothing));
        input.camera.forward = {0, 1, 0};
        input.camera.up = {0, 0, 1};
        render();
        const double sky = static_cast<double>(radiance()[4 * 48 * 24 + 4 * 24]);
        // What the fit of glossAlbedo is good to, and of broad gloss twice.
        EXPECT_NEAR(mean / sky, 1, roughness > kRoughestGloss ? 0.04 : 0.025) << roughness;
    }
}

// A strip of light above a rough metal floor: the mean of many rays and points of the lamp, or
// where gloss is broad of many samples of views, is that of the BRDF. A small lamp takes few of
// them.
TEST_F(ReflectionsTest, SetsAverageTheLobe) {
    const glm::vec3 gold(0.9f, 0.6f, 0.3f);
    struct Case {
        float roughness;
        float width;  // of the lamp
        bool doubleSided;
        int sets;
    };
    for (const Case& c : {Case{0.45f, 0.2f, true, 256},
                          {0.45f, 0.2f, false, 256},
                          {0.6f, 0.2f, true, 256},
                          {0.9f, 0.2f, true, 256},
                          {0.3f, 0.02f, true, 16},
                          {0.45f, 0.02f, false, 16}}) {
        SCOPED_TRACE(c.roughness);
        SCOPED_TRACE(c.width);
        Scene s = emptyScene();
        s.materials[0] = mirror(c.roughness, gold);
        Material lamp;
        lamp.emission = {5, 5, 5};
        lamp.baseColor = {0, 0, 0, 1};
        lamp.doubleSided = c.doubleSided;
        s.materials.push_back(lamp);
        addFloor(s, 0.2f);
        const float x0 = 0.55f, x1 = x0 + c.width, z0 = 0.5f - c.width, z1 = 0.5f + c.width;
        const float lampY = 0.5f;
        addQuad(s, {glm::vec3(x0, lampY, z0), {x1, lampY, z0}, {x1, lampY, z1}, {x0, lampY, z1}},
                1);
        show(std::move(s));
        settings.resolution.width = settings.resolution.height = 8;
        settings.gather.samples = 1;
        settings.views.vpls = 4000;
        settings.picture.accumulate = c.sets;
        settings.picture.view = DebugView::indirect;
        input.camera = fromAbove(0.45f, 0.4f);
        input.camera.position.x = 0.2f;
        input.camera.forward = glm::normalize(glm::vec3(0.3f, -0.25f, 0));
        input.reuse = true;
        for (int i = 0; i < settings.picture.accumulate; ++i) render();
        const std::vector<float> picture = radiance();
        // Over the lamp's area, in the middle of the picture.
        const glm::vec3 eye = input.camera.position;
        glm::dvec3 mean(0), expected(0);
        const std::vector<Receiver> receivers = renderer->readReceivers();
        constexpr int kSteps = 60;
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            for (int k = 0; k < 3; ++k) {
                mean[k] += static_cast<double>(picture[4 * i + static_cast<std::size_t>(k)]);
            }
            const glm::vec3 p = receivers[i].position, n(0, 1, 0);
            for (int k = 0; k < kSteps * kSteps; ++k) {
                const glm::vec3 on(
                    glm::mix(x0, x1, (static_cast<float>(k % kSteps) + 0.5f) / kSteps), lampY,
                    glm::mix(z0, z1, (static_cast<float>(k / kSteps) + 0.5f) / kSteps));
                const glm::vec3 way = on - p;
                const float d2 = glm::dot(way, way);
                const glm::vec3 toLight = way / std::sqrt(d2);
                const float area = (x1 - x0) * (z1 - z0) / (kSteps * kSteps);
                const glm::vec3 toEye = glm::normalize(eye - p);
                expected += glm::dvec3(ggxBrdf(gold, 1, ggxAlpha(c.roughness), n, toEye, toLight) *
                                       glossCompensation(gold, c.roughness, toEye.y)) *
                            static_cast<double>(5 * toLight.y * toLight.y * area / d2);
            }
        }
        for (int k = 0; k < 3; ++k) {
            ASSERT_GT(expected[k], 0);
            EXPECT_NEAR(mean[k] / expected[k], 1, 0.06) << k;
        }
    }
}

// The lamp itself, what mirrors and rough gloss show of it, and the light it gives.
TEST_F(ReflectionsTest, LightScaleDimsWhatGlows) {
    for (const float roughness : {0.0f, 0.3f}) {
        Scene s = room(true);
        s.materials[2].roughness = roughness;
        s.materials[1].doubleSided = true;  // seen from below and in the mirror
        show(std::move(s));
        input.camera = fromAbove(0.4f, 0.5f);
        input.camera.position = {0.75f, 0.5f, 0.8f};
        input.camera.forward = glm::normalize(glm::vec3(-0.4f, 0.3f, -0.6f));
        input.camera.up = {0, 1, 0};
        settings.scene.lightScale = 1;
        render();
        const std::vector<float> full = radiance();
        settings.scene.lightScale = 0.25;
        render();
        const std::vector<float> quarter = radiance();
        float brightest = 0;
        for (std::size_t i = 0; i < full.size(); ++i) {
            if (i % 4 == 3) continue;
            ASSERT_NEAR(quarter[i], full[i] / 4, 1e-4f * (1 + full[i])) << roughness << ' ' << i;
            brightest = std::max(brightest, full[i]);
        }
        EXPECT_GT(brightest, 5);  // the lamp is in sight
    }
}

TEST_F(ReflectionsTest, MattScenesAndLambertPayNothing) {
    const auto hasRow = [](const FrameStatistics& s, std::string_view name) {
        return std::any_of(s.memory.begin(), s.memory.end(),
                           [&](const MemoryUse& use) { return use.name == name; });
    };
    const auto ran = [](const FrameStatistics& s) {
        const auto is = [](const StageTime& t) { return t.stage == Stage::reflections; };
        return std::any_of(s.stagesOfBothSides.begin(), s.stagesOfBothSides.end(), is) ||
               std::any_of(s.methods[0].stages.begin(), s.methods[0].stages.end(), is);
    };
    show(room(false));
    input.camera = fromAbove();
    const FrameStatistics matt = render();
    EXPECT_FALSE(ran(matt));
    EXPECT_FALSE(hasRow(matt, "reflections"));

    show(room(true));
    const FrameStatistics full = render();
    EXPECT_TRUE(ran(full));
    EXPECT_TRUE(hasRow(full, "reflections"));
    settings.scene.materials = Materials::lambert;
    const FrameStatistics lambert = render();
    EXPECT_FALSE(ran(lambert));
    // Metal is then matt in its own colour.
    const std::vector<float> picture = radiance();
    Scene plain = room(true);
    plain.materials[2].metallic = 0;
    settings.scene.materials = Materials::full;
    show(std::move(plain));
    render();
    EXPECT_EQ(picture, radiance());
}

// A pane before the room, through which the camera looks.
Scene behindPane(const Material& pane) {
    Scene s = room(false);
    s.materials.push_back(pane);
    addQuad(
        s,
        {glm::vec3(0.3f, 0.1f, 0.1f), {0.3f, 0.1f, 0.9f}, {0.3f, 0.9f, 0.9f}, {0.3f, 0.9f, 0.1f}},
        3);
    return s;
}

TEST_F(ReflectionsTest, ClearSurfacesShowWhatIsBehindThem) {
    FrameCamera camera;
    camera.position = {0.12f, 0.5f, 0.5f};
    camera.forward = {1, 0, 0};
    camera.up = {0, 1, 0};
    camera.yfovRad = 0.9f;
    const auto shown = [&](Scene made, const ViewSet* views) {
        show(std::move(made));
        if (views) renderer->setViews(*views);
        input.camera = camera;
        render();
        return radiance();
    };
    settings.side[0].method = Method::shadowRays;
    shown(room(false), nullptr);
    const ViewSet views = renderer->readViews();
    const std::vector<float> open = shown(room(false), &views);
    Material blended;
    blended.blends = true;
    blended.alphaCutoff = 0.5f;
    blended.baseColor = {0, 0, 0, 0.25f};
    Material tinted;
    tinted.transmission = 1;
    tinted.roughness = 0;
    tinted.baseColor = {1, 0.5f, 0.25f, 1};
    Material gone = blended;
    gone.baseColor = {1, 1, 1, 0};
    struct Case {
        const char* name;
        Material material;
        glm::vec3 passes;
    };
    for (const Case& c :
         {Case{"blended", blended, glm::vec3(0.75f)}, Case{"tinted", tinted, {1, 0.5f, 0.25f}},
          Case{"nothing", gone, glm::vec3(1)}}) {
        const std::vector<float> seen = shown(behindPane(c.material), &views);
        int apart = 0;
        double sum = 0;
        for (std::size_t i = 0; i < seen.size(); i += 4) {
            for (int k = 0; k < 3; ++k) {
                const float expected = open[i + static_cast<std::size_t>(k)] * c.passes[k];
                const float found = seen[i + static_cast<std::size_t>(k)];
                apart += std::abs(found - expected) > 0.03f * std::max(expected, 0.01f);
                sum += static_cast<double>(found);
            }
        }
        EXPECT_GT(sum, 100) << c.name;
        // Edges fall on the other pixel where a ray is a hair off.
        EXPECT_LT(apart, static_cast<int>(3 * seen.size() / 4 / 20)) << c.name;
    }
}

// The colour near the middle of a picture whose pixels there are all alike, beside the diagonals of
// its surfaces.
glm::vec3 middle(const std::vector<float>& picture, int size) {
    const auto at = static_cast<std::size_t>(4 * (size * (size / 2) + size / 2 + 5));
    return {picture[at], picture[at + 1], picture[at + 2]};
}

// Upright, facing -x.
void addWall(Scene& s, float x, std::uint32_t material) {
    addQuad(s, {glm::vec3(x, 0.1f, 0.1f), {x, 0.1f, 0.9f}, {x, 0.9f, 0.9f}, {x, 0.9f, 0.1f}},
            material);
}

// What closes the wall at x to a body.
void addOtherFaces(Scene& s, float x, std::uint32_t material) {
    const float back = x + 0.05f;
    const glm::vec2 corners[] = {{0.1f, 0.1f}, {0.1f, 0.9f}, {0.9f, 0.9f}, {0.9f, 0.1f}};
    const auto at = [](float depth, glm::vec2 c) { return glm::vec3(depth, c); };
    addQuad(
        s, {at(back, corners[0]), at(back, corners[3]), at(back, corners[2]), at(back, corners[1])},
        material);
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::vec2 from = corners[i], to = corners[(i + 1) % 4];
        addQuad(s, {at(x, to), at(x, from), at(back, from), at(back, to)}, material);
    }
}

Material unlit(glm::vec3 colour) {
    Material m;
    m.unlit = m.doubleSided = true;
    m.baseColor = glm::vec4(colour, 1);
    return m;
}

// What is seen through two panes, the second of them a sheet or a body with two faces, has the
// colours of both, and in a mirror that of the one before it.
TEST_F(ReflectionsTest, EveryPaneOnTheWayTints) {
    const glm::vec3 first(0.9f, 0.5f, 0.3f), second(0.4f, 0.8f, 0.6f);
    input.camera.position = {0.2f, 0.5f, 0.5f};
    input.camera.forward = {1, 0, 0};
    input.camera.up = {0, 1, 0};
    input.camera.yfovRad = 0.3f;
    for (const bool inMirror : {false, true}) {
        for (const bool body : {false, true}) {
            Scene s = emptyScene();
            s.materials[0] = unlit(glm::vec3(1));
            Material pane;
            pane.transmission = 1;
            pane.roughness = 0;
            pane.doubleSided = true;
            pane.baseColor = glm::vec4(first, 1);
            s.materials.push_back(pane);
            pane.baseColor = glm::vec4(second, 1);
            s.materials.push_back(pane);
            s.materials.push_back(mirror());
            s.materials.back().doubleSided = true;
            addWall(s, inMirror ? 0.05f : 0.8f, 0);
            addWall(s, inMirror ? 0.8f : 0.3f, inMirror ? 3 : 1);
            addWall(s, inMirror ? 0.08f : 0.5f, 2);
            if (body) addOtherFaces(s, inMirror ? 0.08f : 0.5f, 2);
            show(std::move(s));
            render();
            const glm::vec3 seen = middle(radiance(), settings.resolution.width);
            const glm::vec3 expected = second * (inMirror ? glm::vec3(1) : first);
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(seen[k], expected[k], 0.03f * expected[k]) << inMirror << body << k;
        }
    }
}

// A periscope: what a mirror shows of a mirror is what that shows, in the colours of both.
TEST_F(ReflectionsTest, MirrorsShowMirrors) {
    const glm::vec3 colour(0.8f, 0.6f, 0.5f);
    settings.scene.environment.source = "none";
    Scene s = emptyScene();
    s.materials[0] = unlit(glm::vec3(1));
    s.materials.push_back(mirror(0, colour));
    s.materials.back().doubleSided = true;
    s.materials.push_back(s.materials.back());
    const auto slanted = [&](float y, float rise, std::uint32_t material) {
        addQuad(s,
                {glm::vec3(0.4f, y - rise, 0.2f),
                 {0.6f, y + rise, 0.2f},
                 {0.6f, y + rise, 0.8f},
                 {0.4f, y - rise, 0.8f}},
                material);
    };
    slanted(0.2f, 0.1f, 1);
    slanted(0.8f, -0.1f, 2);
    addWall(s, 0.05f, 0);
    input.camera.position = {0.2f, 0.2f, 0.5f};
    input.camera.forward = {1, 0, 0};
    input.camera.up = {0, 1, 0};
    input.camera.yfovRad = 0.05f;
    show(s);
    render();
    const glm::vec3 seen = middle(radiance(), settings.resolution.width);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], colour[k] * colour[k], 0.05f) << k;
    // What is rougher is matt there, and dimmer.
    s.materials[2].roughness = 0.5f;
    show(std::move(s));
    render();
    EXPECT_LT(middle(radiance(), settings.resolution.width).r, 0.5f * colour.r * colour.r);
}

TEST_F(ReflectionsTest, FewSamplesOfFaintGlossHaveTheMeanOfAll) {
    Scene made = room(true);
    made.materials[2].metallic = 0;  // reflects 4 %: one of eight samples
    made.materials[2].specular = 0.04f;
    made.materials[2].baseColor = {0, 0, 0, 1};
    show(std::move(made));
    settings.resolution.width = settings.resolution.height = 24;
    settings.side[0].method = Method::shadowRays;
    settings.views.vpls = 64;
    settings.picture.view = DebugView::indirect;
    input.camera.position = {0.45f, 0.5f, 0.52f};
    input.camera.forward = {-1, 0, 0};
    input.camera.up = {0, 1, 0};
    input.camera.yfovRad = 0.9f;
    settings.picture.accumulate = 1;
    const double full = meanOfSets();
    ASSERT_GT(full, 0);
    settings.gather.samples = 8;
    settings.gather.mapCheck = 0;
    settings.picture.accumulate = 64;
    input.reuse = true;
    EXPECT_NEAR(meanOfSets() / full, 1, 0.03);
}

TEST_F(ReflectionsTest, BothSidesAndReferencesReflect) {
    show(room(true));
    input.camera.position = {0.45f, 0.5f, 0.52f};
    input.camera.forward = {-1, 0, 0};
    input.camera.up = {0, 1, 0};
    input.camera.yfovRad = 0.9f;
    settings.compare = true;
    settings.side[0].method = Method::shadowRays;
    settings.side[1].method = Method::exact;
    render();
    // The mirror's light needs no reference: views and rays give it on both sides.
    EXPECT_EQ(renderer->radianceOf(0).readFloats(4), renderer->radianceOf(1).readFloats(4));
}

// Its pixels that no neighbour serves are gathered by a program of their own.
TEST_F(ReflectionsTest, HalfResolutionHasAsMuchLight) {
    for (const float coat : {0.0f, 1.0f}) {
        SCOPED_TRACE(coat);
        Scene made = room(false);
        made.materials[0].metallic = 0.5f;
        made.materials[0].roughness = 0.6f;
        made.materials[0].coat = coat;
        show(std::move(made));
        settings.side[0].method = Method::shadowRays;
        settings.views.vpls = 64;
        settings.picture.view = DebugView::indirect;
        input.camera.position = {0.15f, 0.5f, 0.5f};
        input.camera.forward = glm::normalize(glm::vec3(1, -0.3f, 0));
        input.camera.up = {0, 1, 0};
        input.camera.yfovRad = 0.9f;
        settings.gather.samples = 0;
        settings.gather.filter = false;
        settings.gather.cull.scale = 1;
        const double whole = meanOfSets();
        ASSERT_GT(whole, 0);
        settings.gather.cull.scale = 2;
        EXPECT_NEAR(meanOfSets() / whole, 1, 0.02);
        settings.gather.samples = 16;
        settings.gather.filter = true;
        EXPECT_NEAR(meanOfSets() / whole, 1, 0.1);
        EXPECT_FALSE(renderer->readSamples(24, 12).empty());
    }
}

}  // namespace
}  // namespace mv::test
