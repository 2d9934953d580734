// The pixel that the renderer reads back against the pictures it made.

#include <cmath>

#include "gl/gl_fixture.h"
#include "megaviews/scene/load_scene.h"
#include "renderer/frame_renderer.h"

namespace mv {
namespace {

class FramePixelTest : public GlTest {};

TEST_F(FramePixelTest, ReadsWhatThePictureShows) {
    const Scene scene = makeBuiltin("cornell", {});
    const TriangleBvh bvh = TriangleBvh::build(scene);
    const SceneHierarchy hierarchy = SceneHierarchy::build(scene, bvh, 5);
    FrameRenderer renderer;
    renderer.setScene(scene, bvh, hierarchy);
    Settings settings;
    settings.resolution.width = 40;
    settings.resolution.height = 24;
    settings.views.vpls = 200;
    settings.views.octreeDepth = 5;
    settings.side[0].maps.resolution = 8;
    settings.gather.samples = 16;
    compareWith(settings, Method::manylods);
    FrameInput input;
    input.camera.position = {0.5f, 0.5f, 1.6f};
    FrameStatistics statistics;
    EXPECT_FALSE(renderer.readPixel(1, 1).surface);  // no frame yet
    EXPECT_TRUE(renderer.readSamples(1, 1).empty());
    for (const Traversal traversal : {Traversal::lists, Traversal::queue}) {
        for (const int scale : {1, 2, 3}) {
            settings.side[0].pairs.traversal = traversal;
            settings.gather.nearField = false;  // no sample, and not of their sum
            settings.gather.cull.scale = scale;
            compareWith(settings, scale == 1 ? Method::manylods : Method::none);
            renderer.render(settings, input, statistics);
            const auto radiance = renderer.radiance().readFloats(4);
            const auto display = renderer.display().readBytes(4);
            int surfaces = 0, hidden = 0;
            for (int i = 0; i < settings.resolution.width * settings.resolution.height; i += 7) {
                const int x = i % settings.resolution.width, y = i / settings.resolution.width;
                const auto at = static_cast<std::size_t>(4 * i);
                const PixelValues pixel = renderer.readPixel(x, y);
                ASSERT_EQ(pixel.sideCount, 2);
                const auto shown = static_cast<std::size_t>(x >= settings.resolution.width / 2);
                for (std::size_t c = 0; c < 3; ++c) {
                    EXPECT_EQ(pixel.display[c], display[at + c]);
                    const float want = radiance[at + c];
                    EXPECT_NEAR(pixel.sides[shown].radiance[static_cast<int>(c)], want,
                                1e-5f * std::abs(want) + 1e-12f);
                }
                if (!pixel.surface) continue;
                ++surfaces;
                EXPECT_NEAR(pixel.depth, 1.6f - pixel.position.z, 1e-3f);
                for (int side = 0; side < 2; ++side) {
                    glm::dvec3 sum(0);
                    for (const GatheredSample& s : renderer.readSamples(x, y, side)) {
                        sum += glm::dvec3(s.irradiance);
                        hidden += side == 1 && scale == 2 && s.visible < s.samples;
                    }
                    const glm::dvec3 want(pixel.sides[static_cast<std::size_t>(side)].unfiltered);
                    EXPECT_LT(glm::length(sum - want), 3e-6 * glm::length(want) + 1e-12);
                }
            }
            EXPECT_GT(surfaces, 60);
            EXPECT_EQ(hidden, 0);  // method none hides nothing
        }
    }
    EXPECT_FALSE(renderer.readPixel(-1, 0).surface);
    EXPECT_FALSE(renderer.readPixel(0, settings.resolution.height).surface);
    EXPECT_TRUE(renderer.readSamples(settings.resolution.width, 0).empty());
    EXPECT_TRUE(renderer.readSamples(3, 3, 2).empty());
    expectNoGlErrors();
}

TEST_F(FramePixelTest, WhatGlowsIsScaledAsInThePicture) {
    Scene scene = makeBuiltin("cornell", {});
    for (Material& material : scene.materials) material.emission = {1, 2, 3};
    const TriangleBvh bvh = TriangleBvh::build(scene);
    const SceneHierarchy hierarchy = SceneHierarchy::build(scene, bvh, 5);
    FrameRenderer renderer;
    renderer.setScene(scene, bvh, hierarchy);
    Settings settings;
    settings.resolution = {16, 9};
    settings.views.vpls = 100;
    settings.views.octreeDepth = 5;
    settings.scene.lightScale = 4;
    FrameInput input;
    input.camera.position = {0.5f, 0.5f, 1.6f};
    FrameStatistics statistics;
    renderer.render(settings, input, statistics);
    const auto shown = renderer.radiance().readFloats(4);
    const PixelValues pixel = renderer.readPixel(8, 4);
    ASSERT_TRUE(pixel.surface);
    EXPECT_GT(pixel.sides[0].radiance.b, 12);
    for (int c = 0; c < 3; ++c) {
        const float want = shown[static_cast<std::size_t>(4 * (4 * 16 + 8) + c)];
        EXPECT_NEAR(pixel.sides[0].radiance[c], want, 1e-5f * want);
    }
}

TEST_F(FramePixelTest, DebugViewsOfSharingAreDrawnForBothSides) {
    const Scene scene = makeBuiltin("cornell", {});
    const TriangleBvh bvh = TriangleBvh::build(scene);
    const SceneHierarchy hierarchy = SceneHierarchy::build(scene, bvh, 5);
    FrameRenderer renderer;
    renderer.setScene(scene, bvh, hierarchy);
    Settings settings;
    settings.resolution.width = 32;
    settings.resolution.height = 20;
    settings.views.vpls = 800;
    settings.views.octreeDepth = 6;
    settings.side[0].maps.resolution = 8;
    settings.display.exposureEv = 0;
    compareWith(settings, Method::manylods);
    settings.picture.view = DebugView::sharing;
    FrameInput input;
    input.camera.position = {0.5f, 0.5f, 1.6f};
    FrameStatistics statistics;
    renderer.render(settings, input, statistics);
    EXPECT_GT(statistics.methods[0].meanSharing, 1.0);
    EXPECT_EQ(statistics.methods[1].meanSharing, 1.0);
    const auto first = renderer.display().readBytes(4);
    renderer.render(settings, input, statistics);  // nothing moved
    EXPECT_GT(statistics.methods[0].meanSharing, 1.0);
    EXPECT_EQ(renderer.display().readBytes(4), first);

    settings.picture.view = DebugView::shared;
    renderer.render(settings, input, statistics);
    EXPECT_EQ(statistics.methods[0].meanSharing, 0.0);
    const auto grey = renderer.display().readBytes(4);
    for (std::size_t i = 0; i < grey.size(); i += 4) {
        ASSERT_EQ(grey[i], grey[i + 1]);
        ASSERT_EQ(grey[i], grey[i + 2]);
    }
    for (const View& view : renderer.readViews().views) {
        if (view.flags != kViewDead) settings.inspect.pickA = view.slot;
    }
    renderer.render(settings, input, statistics);
    EXPECT_NE(renderer.display().readBytes(4), grey);
    settings.inspect.pickA.reset();
    renderer.render(settings, input, statistics);
    EXPECT_EQ(renderer.display().readBytes(4), grey);
    expectNoGlErrors();
}

}  // namespace
}  // namespace mv
