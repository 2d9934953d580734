// The sky in a frame: its light at every pixel against rays on the CPU, the background, and what
// makes a frame anew.

#include <algorithm>
#include <cmath>

#include "gpu/frame_fixture.h"
#include "megaviews/references/exact_gather.h"

namespace mv::test {
namespace {

class FrameSkyTest : public FrameTest {
  protected:
    void SetUp() override {
        FrameTest::SetUp();
        settings.gather.filter = false;
        settings.gather.skySamples = 128;
        settings.side[0].method = Method::none;
        settings.views.bounces = 1;
        settings.views.vpls = 16;
        // Back and up, so that there is sky in the picture.
        input.camera.position -= 0.6f * input.camera.forward;
        input.camera.position.y += 0.1f;
    }
    // Irradiance from the sky alone, by pixel: what views give is taken away.
    std::vector<glm::vec3> skyOnly() {
        ViewSet dark;
        View view{};
        view.flags = kViewHemisphere;
        view.positionX = view.positionY = view.positionZ = 0.5f;
        view.normalY = 1;
        view.fluxR = view.fluxG = view.fluxB = 1e-12f;
        dark.views = {view};
        renderer->setViews(dark);
        settings.picture.view = DebugView::indirect;
        render();
        const std::vector<float> light = radiance();
        settings.picture.view = DebugView::albedo;
        render();
        const std::vector<float> albedo = radiance();
        std::vector<glm::vec3> out;
        for (std::size_t i = 0; i < light.size(); i += 4) {
            glm::vec3 e(0);
            for (int c = 0; c < 3; ++c) {
                const std::size_t k = i + static_cast<std::size_t>(c);
                if (albedo[k] > 0) e[c] = light[k] * glm::pi<float>() / albedo[k];
            }
            out.push_back(e);
        }
        return out;
    }
    std::vector<glm::vec3> expected(int rays) {
        const Emitters emitters = makeEmitters(
            scene(), bvh(), {.environment = {settings.scene.environment, input.environment}});
        const EmbreeScene embree(bvh());
        ExactGatherOptions options;
        options.sky = emitters.sky;
        options.skyRays = rays;
        const std::vector<Receiver> receivers = renderer->readReceivers();
        IrradianceImage image;
        exactGather(embree, {}, receivers, settings.resolution.width, settings.resolution.height,
                    options, image);
        return image.mean;
    }
};

std::shared_ptr<const EnvironmentImage> brightCell() {
    auto image = std::make_shared<EnvironmentImage>();
    image->width = 16;
    image->height = 8;
    image->radiance.assign(128, glm::vec3(0.2f, 0.3f, 0.5f));
    image->radiance[16 * 3 + 4] = {40, 30, 20};  // in front of the box
    image->hash = "bright cell";
    return image;
}

TEST_F(FrameSkyTest, LightIsThatOfRaysOnTheCpu) {
    for (const bool withImage : {false, true}) {
        settings.scene.environment.source = withImage ? "image" : "white";
        input.environment = withImage ? brightCell() : nullptr;
        render();
        const std::vector<glm::vec3> rays = expected(512);
        // By rays; by all maps of many views, fine and coarse; by a few of them at a time.
        for (const auto& [views, res, samples] :
             {std::tuple{0, 8, 128}, {256, 128, 256}, {256, 32, 256}, {256, 128, 128}}) {
            settings.gather.skyViews = views;
            settings.gather.skyMapRes = res;
            settings.gather.skySamples = samples;
            const std::vector<glm::vec3> found = skyOnly();
            double sum = 0, expectedSum = 0, error = 0, square = 0;
            for (std::size_t i = 0; i < found.size(); ++i) {
                if (rays[i] == glm::vec3(0)) continue;
                sum += found[i].y;
                expectedSum += rays[i].y;
                error += std::pow(double{found[i].y} - double{rays[i].y}, 2);
                square += std::pow(double{rays[i].y}, 2);
            }
            SCOPED_TRACE(::testing::Message() << "image " << withImage << ", " << views << " x "
                                              << res << ", samples " << samples);
            EXPECT_GT(expectedSum, 0);
            EXPECT_NEAR(sum / expectedSum, 1, 0.01);
            EXPECT_LT(error / square, 0.03);  // noise of 128 rays, or steps of 128 views
        }
    }
}

// Views of a sky and their maps are made once, and anew where geometry, sky or their number change.
TEST_F(FrameSkyTest, MapsAreKept) {
    settings.scene.environment.source = "white";
    settings.gather.skyViews = 16;
    FrameStatistics statistics;
    const auto made = [&] {
        statistics = render();
        return std::any_of(statistics.stagesOfBothSides.begin(), statistics.stagesOfBothSides.end(),
                           [](const StageTime& s) { return s.stage == Stage::skyMaps; });
    };
    const auto row = [&] {
        return std::any_of(statistics.memory.begin(), statistics.memory.end(),
                           [](const MemoryUse& use) { return use.name == "sky maps"; });
    };
    EXPECT_TRUE(made());
    EXPECT_TRUE(row());
    EXPECT_GT(statistics.skyPoints, 100u);
    input.camera.position.y += 0.01f;
    EXPECT_FALSE(made());
    settings.gather.skySamples = 2;
    EXPECT_FALSE(made());
    settings.gather.skyMapRes = 64;
    EXPECT_TRUE(made());
    input.reuse = false;
    EXPECT_TRUE(made());
    input.reuse = true;
    EXPECT_FALSE(made());
    settings.scene.environment.scale = 2;
    EXPECT_TRUE(made());
    settings.gather.skyViews = 0;
    EXPECT_FALSE(made());
    EXPECT_FALSE(row());
    EXPECT_EQ(statistics.skyPoints, 0u);
}

TEST_F(FrameSkyTest, HalfResolutionHasAsMuch) {
    settings.scene.environment.source = "white";
    const auto total = [&] {
        double sum = 0;
        for (const glm::vec3& e : skyOnly()) sum += double{e.y};
        return sum;
    };
    const double whole = total();
    settings.gather.cull.scale = 2;
    EXPECT_NEAR(total() / whole, 1, 0.02);
}

TEST_F(FrameSkyTest, StandsBehindTheSurfacesAlone) {
    render();
    const std::vector<float> without = radiance();
    settings.scene.environment = {.source = "white", .rotationDeg = 0, .scale = 0.75};
    render();
    const std::vector<float> with = radiance();
    settings.picture.view = DebugView::albedo;
    render();
    const std::vector<float> albedo = radiance();
    std::size_t background = 0, lit = 0;
    for (std::size_t i = 0; i < with.size(); i += 4) {
        if (albedo[i] == 0 && without[i] == 0) {
            ++background;
            EXPECT_NEAR(with[i], 0.75f, 1e-4f);
        } else {
            lit += with[i] > without[i];
        }
    }
    EXPECT_GT(background, 100u);
    EXPECT_GT(lit, 300u);
}

// The direction of each pixel: where an image has its one bright cell, the picture has it.
TEST_F(FrameSkyTest, AnImageStandsWhereItsDirectionsAre) {
    auto image = std::make_shared<EnvironmentImage>();
    image->width = 64;
    image->height = 32;
    image->radiance.assign(64 * 32, glm::vec3(0));
    const FrameCamera& camera = input.camera;
    // Up and right of the middle of the picture.
    const PickRay ray = rayThrough(camera, 75, 43, 70, 40, 0);
    const vec2 place = skyPlace(32, ray.direction);
    image->radiance[static_cast<std::size_t>(place.y) * 64 + static_cast<std::size_t>(place.x)] =
        glm::vec3(1);
    input.environment = image;
    settings.scene.environment.source = "image";
    render();
    const std::vector<float> picture = radiance();
    EXPECT_GT(picture[4 * (40 * 75 + 70)], 0.2f);
    EXPECT_EQ(picture[4 * (40 * 75 + 3)], 0);
}

TEST_F(FrameSkyTest, WhatChangesItMakesANewPicture) {
    settings.scene.environment.source = "white";
    std::vector<float> before;
    const auto changes = [&](const std::function<void()>& change) {
        change();
        render();
        const std::vector<float> now = radiance();
        const bool changed = now != before;
        before = now;
        return changed;
    };
    EXPECT_TRUE(changes([] {}));
    EXPECT_FALSE(changes([] {}));
    EXPECT_TRUE(changes([&] { settings.scene.environment.scale = 2; }));
    EXPECT_TRUE(changes([&] { settings.scene.environment.source = "sky"; }));
    EXPECT_TRUE(changes([&] {
        settings.scene.environment.source = "image";
        input.environment = brightCell();
    }));
    EXPECT_TRUE(changes([&] { settings.scene.environment.rotationDeg = 90; }));
    EXPECT_TRUE(changes([&] { settings.gather.skySamples = 3; }));
    EXPECT_TRUE(changes([&] { settings.gather.skyViews = 16; }));
    EXPECT_TRUE(changes([&] { settings.gather.skyMapRes = 8; }));
    EXPECT_TRUE(changes([&] { settings.views.particles = 10; }));  // which shine alone
    EXPECT_FALSE(changes([&] { settings.scene.environment.source = "white"; }));
}

}  // namespace
}  // namespace mv::test
