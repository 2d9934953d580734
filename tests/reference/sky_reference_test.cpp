// Light of the sky in both references: against a furnace, and against each other.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "megaviews/references/path_tracer.h"
#include "reference/reference_scenes.h"

namespace mv {
namespace {

using glm::dvec3;
using testing::Lit;
using testing::receiversInside;
using testing::traced;

// A court of 4 x 5 m with walls of 3 m, a roof over half of it, and a block on its floor.
Scene court(float albedo) {
    testing::RoomBuilder room;
    const int stone = room.material(glm::vec3(albedo));
    const dvec3 x(4, 0, 0), y(0, 3, 0), z(0, 0, 5);
    room.quad({0, 0, 0}, z, x, stone);
    room.quad({0, 0, 0}, x, y, stone);
    room.quad(z, y, x, stone);
    room.quad({0, 0, 0}, y, z, stone);
    room.quad(x, z, y, stone);
    room.quad(y, x, z * 0.5, stone);
    room.box({1, 0, 3}, {2, 1, 4}, stone);
    return room.finish();
}

Environment image(int width, int height, const std::vector<glm::vec3>& radiance) {
    auto pixels = std::make_shared<EnvironmentImage>();
    pixels->width = width;
    pixels->height = height;
    pixels->radiance = radiance;
    return {.settings = {.source = "image.exr"}, .image = pixels};
}

// Dim all around, with one bright cell high up.
Environment brightCell() {
    std::vector<glm::vec3> radiance(16 * 8, glm::vec3(0.2f, 0.3f, 0.5f));
    radiance[16 * 1 + 5] = {40, 30, 20};
    return image(16, 8, radiance);
}

// Where nothing is absorbed light of radiance 1 stays light of radiance 1, whatever it meets.
TEST(SkyReferences, ALosslessCourtUnderAWhiteSkyIsAFurnace) {
    const Environment white{.settings = {.source = "white"}, .image = nullptr};
    const Lit lit(court(1), 1, white);
    const std::vector<Receiver> receivers = receiversInside(3, 12, 0.3f);
    const IrradianceImage found = traced(lit, receivers, {200, 4000, 1});
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const double sigma = std::sqrt(double{found.variance[i].x});
        EXPECT_LT(sigma, 0.01 * std::numbers::pi);
        EXPECT_NEAR(found.mean[i].x, std::numbers::pi, 4 * sigma + 0.005 * std::numbers::pi);
    }
}

// All light of the sky, straight and reflected: by paths, and by views and rays.
TEST(SkyReferences, PathsAndViewsAgree) {
    const Environment gradient{.settings = {.source = "sky", .scale = 2}, .image = nullptr};
    for (const Environment& environment : {gradient, brightCell()}) {
        const Lit lit(court(0.6f), 1, environment);
        const std::vector<Receiver> receivers = receiversInside(4, 30, 0.3f);
        const IrradianceImage expected = traced(lit, receivers, {3, 4000, 1});
        const ViewSet views = lit.trace(60000, 3, 5);
        const EmbreeScene embree(lit.bvh);
        IrradianceImage found;
        ExactGatherOptions options;
        options.clampDistance = 1e-4f;
        options.sky = lit.emitters.sky;
        options.skyRays = 4000;
        exactGather(embree, views.views, receivers, static_cast<int>(receivers.size()), 1, options,
                    found);
        dvec3 paths(0), gathered(0);
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            paths += dvec3(expected.mean[i]);
            gathered += dvec3(found.mean[i]);
            EXPECT_NEAR(found.mean[i].y / expected.mean[i].y, 1, 0.12) << i;
        }
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(gathered[c] / paths[c], 1, 0.02);
    }
}

// Straight from the sky alone, with and without the cell's shadow: rays against paths.
TEST(SkyReferences, SoftShadowsAgree) {
    const Lit lit(court(0), 1, brightCell());  // black: nothing is reflected
    std::vector<Receiver> receivers;
    for (int i = 0; i < 40; ++i) {  // a row on the floor, from the open half to below the roof
        const dvec3 x(0.5, 0.001, 4.8 - 0.11 * i);
        receivers.push_back({lit.scene.root.rootFromWorld(x), {0, 1, 0}});
    }
    const IrradianceImage expected = traced(lit, receivers, {1, 20000, 1});
    const EmbreeScene embree(lit.bvh);
    IrradianceImage found;
    ExactGatherOptions options;
    options.sky = lit.emitters.sky;
    options.skyRays = 20000;
    exactGather(embree, {}, receivers, static_cast<int>(receivers.size()), 1, options, found);
    float least = 1e9f, most = 0;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        EXPECT_NEAR(found.mean[i].x, expected.mean[i].x,
                    0.02f * expected.mean[i].x + 5 * std::sqrt(2 * expected.variance[i].x));
        least = std::min(least, expected.mean[i].x);
        most = std::max(most, expected.mean[i].x);
    }
    EXPECT_GT(most, 5 * least);  // there is a shadow
}

}  // namespace
}  // namespace mv
