// The sky's table against closed forms, where there is one, and the light paths that start in it.

#include "megaviews/views/sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "megaviews/core/error.h"
#include "megaviews/views/view_guide.h"
#include "views/rooms.h"

namespace mv {
namespace {

using glm::dvec3;
using testing::fluxOf;

// A floor of 4 x 5 m, and perhaps a wall that light of its views reaches; no light.
Scene floorScene(float albedo = 1, bool wall = false) {
    testing::RoomBuilder room;
    const int stone = room.material(glm::vec3(albedo));
    room.quad({0, 0, 0}, {0, 0, 5}, {4, 0, 0}, stone);
    if (wall) room.quad({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, stone);
    return room.finish();
}

Environment named(const std::string& source, double scale = 1) {
    return {.settings = {.source = source, .scale = scale}, .image = nullptr};
}

// Black but for one pixel of radiance `bright`.
Environment spotImage(int width, int height, int x, int y, glm::vec3 bright,
                      double rotationDeg = 0) {
    auto image = std::make_shared<EnvironmentImage>();
    image->width = width;
    image->height = height;
    image->radiance.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                           glm::vec3(0));
    image->radiance[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(x)] = bright;
    return {.settings = {.source = "image.exr", .rotationDeg = rotationDeg}, .image = image};
}

std::shared_ptr<const Sky> skyOf(const Environment& environment,
                                 const std::vector<PosedLight>& lights = {}) {
    return makeSky(floorScene(), lights, environment, 1);
}

PosedLight sunLight(dvec3 direction, glm::vec3 irradiance, bool isDefault = true) {
    PosedLight sun;
    sun.light.type = LightType::directional;
    sun.light.intensity = irradiance;
    sun.light.isDefault = isDefault;
    sun.position = dvec3(0);
    sun.direction = glm::normalize(direction);
    return sun;
}

// A mean over the sphere of what is drawn, each weighed by the inverse of its density.
struct Drawn {
    dvec3 irradiance{0}, direction{0};
    double sphere = 0;
};
Drawn drawn(const Sky& sky, int count) {
    Drawn mean;
    for (int i = 0; i < count; ++i) {
        const vec4 r = random4(7, static_cast<uint>(i), 0, 0);
        vec3 direction, radiance;
        const double density{
            skySample(sky.texels.data(), sky.rows, r.x, r.y, r.z, direction, radiance)};
        mean.irradiance += dvec3(radiance) / density / double(count);
        mean.direction += dvec3(direction) / double(count);
        mean.sphere += 1 / density / count;
    }
    return mean;
}

TEST(Sky, DirectionsAreDrawnWithTheDensityThatIsSaid) {
    const std::vector<PosedLight> sun = {sunLight({-1, -1, 0.5}, {3, 3, 3})};
    for (const auto& sky : {skyOf(named("sky"), sun), skyOf(named("white")),
                            skyOf(spotImage(8, 4, 5, 1, {1, 2, 3}))}) {
        for (uint i = 0; i < 2000; ++i) {
            const vec4 r = random4(3, i, 0, 0);
            vec3 direction, radiance, again;
            const float density =
                skySample(sky->texels.data(), sky->rows, r.x, r.y, r.z, direction, radiance);
            EXPECT_NEAR(glm::length(direction), 1, 1e-5);
            EXPECT_GT(density, 0);
            // A direction on the edge of a cell may be found in its neighbour.
            const vec2 place = glm::fract(skyPlace(sky->rows, direction));
            if (std::min(std::min(place.x, 1 - place.x), std::min(place.y, 1 - place.y)) < 1e-2f) {
                continue;
            }
            EXPECT_NEAR(skyRadiance(sky->texels.data(), sky->rows, direction, again), density,
                        1e-4f * density);
            EXPECT_EQ(again, radiance);
        }
        const Drawn mean = drawn(*sky, 200000);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(mean.irradiance[c], double{sky->irradiance[c]},
                        0.01 * double{sky->irradiance[c]});
        }
    }
    EXPECT_NEAR(drawn(*skyOf(named("white")), 1000).sphere, 4 * std::numbers::pi, 1e-3);
}

// E = pi under radiance 1, whatever the share of rays that follow the table.
TEST(Sky, AWhiteSkyGivesEverySurfacePi) {
    const auto white = skyOf(named("white"));
    EXPECT_FLOAT_EQ(white->tableShare, 0);
    EXPECT_NEAR(white->irradiance.x, 4 * std::numbers::pi, 1e-4);
    for (const float share : {0.0f, 0.5f, 1.0f}) {
        for (const vec3 normal : {vec3(0, 1, 0), vec3(0.6f, 0, -0.8f), vec3(0, -1, 0)}) {
            double sum = 0;
            constexpr int kCount = 40000;
            for (uint i = 0; i < kCount; ++i) {
                const vec4 r = random4(11, i, 0, 0);
                vec3 direction;
                sum += double{skyIrradiance(white->texels.data(), white->rows, share, normal,
                                            vec3(r), r.w, direction)
                                  .y};
            }
            EXPECT_NEAR(sum / kCount, std::numbers::pi, 0.03) << share;
        }
    }
}

TEST(Sky, TheGradientHasAQuarterOfItsSun) {
    const dvec3 travels(0.5, -1, 0.2);
    const auto sky = skyOf(named("sky"), {sunLight(travels, {4, 4, 4})});
    ASSERT_TRUE(sky);
    double level = 0;
    constexpr int kCount = 100000;
    for (uint i = 0; i < kCount; ++i) {
        const vec4 r = random4(5, i, 0, 0);
        vec3 direction;
        level += double{luminance(skyIrradiance(sky->texels.data(), sky->rows, sky->tableShare,
                                                vec3(0, 1, 0), vec3(r), r.w, direction))};
    }
    EXPECT_NEAR(level / kCount, 0.25 * 4, 0.01);
    vec3 atSun, opposite;
    const vec3 toSun = -vec3(glm::normalize(travels));
    skyRadiance(sky->texels.data(), sky->rows, toSun, atSun);
    skyRadiance(sky->texels.data(), sky->rows, vec3(-toSun.x, toSun.y, -toSun.z), opposite);
    EXPECT_GT(luminance(atSun), 2 * luminance(opposite));
    EXPECT_GT(opposite.z, opposite.x);  // blue
}

// One pixel of a large image keeps its power in the coarser table, and stands where it should.
TEST(Sky, AnImageKeepsItsPowerAndItsPlace) {
    const int width = 4096, height = 2048, x = 3 * width / 4 + 8, y = height / 4 + 3;
    const glm::vec3 bright(1e5f, 2e5f, 4e4f);
    const double solidAngle =
        2 * std::numbers::pi / width *
        (std::cos(std::numbers::pi * y / height) - std::cos(std::numbers::pi * (y + 1) / height));
    for (const double rotation : {0.0, 90.0, -45.0, 360.0}) {
        const auto sky = skyOf(spotImage(width, height, x, y, bright, rotation));
        ASSERT_EQ(sky->rows, 512u);
        EXPECT_GT(sky->tableShare, 0.99f);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(sky->irradiance[c], bright[c] * solidAngle, 1e-4 * bright[c] * solidAngle);
        }
        // The middle column lies towards +x, the one a quarter right of it towards +z; a positive
        // rotation turns towards smaller columns, which is counter-clockwise from above.
        const double azimuth = 2 * std::numbers::pi * ((x + 0.5) / width - 0.5 - rotation / 360);
        const double polar = std::numbers::pi * (y + 0.5) / height;
        const dvec3 expected(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                             std::sin(polar) * std::sin(azimuth));
        EXPECT_LT(glm::length(drawn(*sky, 500).direction - expected), 0.01) << rotation;
    }
}

TEST(Sky, StandsWhereItIsWantedOnly) {
    const std::vector<PosedLight> placedSun = {sunLight({0, -1, 0}, {3, 3, 3})};
    const std::vector<PosedLight> ownSun = {sunLight({0, -1, 0}, {3, 3, 3}, false)};
    std::vector<PosedLight> lamp = placedSun, beam = placedSun;
    lamp[0].light.type = LightType::point;
    beam[0].light.type = LightType::spot;
    EXPECT_TRUE(skyOf(named("auto"), placedSun));
    EXPECT_TRUE(skyOf(named("auto"), beam));
    EXPECT_FALSE(skyOf(named("auto"), ownSun));
    EXPECT_FALSE(skyOf(named("auto"), lamp));
    EXPECT_FALSE(skyOf(named("auto")));
    EXPECT_FALSE(skyOf(named("none"), placedSun));
    EXPECT_TRUE(skyOf(named("sky"), lamp));
    EXPECT_TRUE(skyOf(named("sky")));
    EXPECT_FALSE(skyOf(named("sky", 0), placedSun));
    EXPECT_FALSE(skyOf(spotImage(4, 2, 0, 0, {0, 0, 0})));
    EXPECT_THROW(skyOf(named("missing.exr")), Error);
    // The same input is the same sky.
    const auto sky = skyOf(named("auto"), placedSun);
    EXPECT_EQ(makeSky(floorScene(), placedSun, named("auto"), 1, sky), sky);
    EXPECT_NE(makeSky(floorScene(), placedSun, named("auto"), 2, sky), sky);
}

TEST(Sky, WhiteAndImagesStandInsteadOfAPlacedLight) {
    Scene scene = floorScene();
    Light light = sunLight({0, -1, 0}, {3, 3, 3}).light;
    scene.nodes.push_back({});
    light.node = static_cast<int>(scene.nodes.size()) - 1;
    scene.lights = {light};
    const TriangleBvh bvh = TriangleBvh::build(scene);
    const auto flux = [&](const Environment& environment) {
        const Emitters e = makeEmitters(scene, bvh, {.environment = environment});
        return e.lights.front().fluxG;
    };
    EXPECT_GT(flux(named("none")), 0);
    EXPECT_GT(flux(named("sky")), 0);
    EXPECT_EQ(flux(named("white")), 0);
    EXPECT_EQ(flux(spotImage(4, 2, 1, 1, {1, 1, 1})), 0);
    scene.lights.front().isDefault = false;
    EXPECT_GT(flux(named("white")), 0);
}

struct Sent {
    double flux = 0, sigma = 0;  // W
};
// What the first VPLs of paths from the sky send on, by all paths alike or where a guide says.
Sent sentOn(const Scene& scene, const Environment& environment, bool guided) {
    const TriangleBvh bvh = TriangleBvh::build(scene);
    const Emitters emitters = makeEmitters(scene, bvh, {.environment = environment});
    ImportanceCamera camera;
    camera.camera.position = scene.root.rootFromWorld(dvec3(2, 2, 4.5));
    camera.camera.forward = glm::normalize(glm::vec3(0, -0.3f, -1));
    const ViewGuide guide = makeViewGuide(bvh, emitters, camera, 1, 1);
    EXPECT_FALSE(guided && guide.cells.empty());
    const ViewSet set = traceVpls(bvh, emitters, {40000, 1, 1}, guided ? &guide : nullptr);
    Sent sent;
    for (const View& view : set.views) {
        sent.flux += fluxOf(view).y;
        sent.sigma += fluxOf(view).y * fluxOf(view).y;
    }
    sent.sigma = std::sqrt(sent.sigma);
    return sent;
}

// Of a white sky each side of a floor receives pi W/m^2.
TEST(Sky, PathsBringWhatTheFloorReceives) {
    const Sent sent = sentOn(floorScene(0.5f), named("white"), false);
    EXPECT_NEAR(sent.flux, std::numbers::pi * 2 * 4 * 5 * 0.5, 4 * sent.sigma);
    EXPECT_LT(sent.sigma, 0.01 * sent.flux);
}

TEST(Sky, AGuideFindsWhatIsInSightAndLosesNothing) {
    const Scene scene = floorScene(0.5f, true);
    for (const char* source : {"white", "sky"}) {
        const Sent plain = sentOn(scene, named(source), false);
        const Sent guided = sentOn(scene, named(source), true);
        EXPECT_NE(plain.flux, guided.flux);
        EXPECT_NEAR(plain.flux, guided.flux, 4 * std::hypot(plain.sigma, guided.sigma)) << source;
    }
}

}  // namespace
}  // namespace mv
