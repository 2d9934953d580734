// The method shadow-rays: its light is the exact gather's, with masks and in as many draws as a
// software renderer's loops take; its CPU twin gives the same answers.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "gl/gl_fixture.h"
#include "megaviews/gather/gather.h"
#include "megaviews/methods/shadow_rays/shadow_ray.h"
#include "megaviews/references/exact_gather.h"
#include "renderer/frame_renderer.h"
#include "views/rooms.h"

namespace mv {
namespace {

class ShadowRays : public GlTest {
  protected:
    static constexpr int kWidth = 48, kHeight = 30;

    // The irradiance of every pixel of a frame that sums all views; light comes from the ceiling,
    // and a masked screen stands in its way.
    void render(const testing::Lit& lit, int samples = 0) {
        hierarchy = SceneHierarchy::build(lit.scene, lit.bvh, 5);
        renderer = std::make_unique<FrameRenderer>();
        renderer->setScene(lit.scene, lit.bvh, hierarchy);
        renderer->setViews(lit.trace(150, 2));
        settings.side[0].method = Method::shadowRays;
        settings.views.octreeDepth = 5;
        settings.gather.samples = samples;
        settings.gather.filter = false;
        settings.gather.cull.level = 0;
        settings.resolution.width = kWidth;
        settings.resolution.height = kHeight;
        settings.display.exposureEv = 0;
        const SceneBounds bounds = sceneBounds(lit.scene);
        const glm::vec3 size = bounds.max - bounds.min;
        FrameInput input;
        input.camera.position = bounds.min + size * glm::vec3(0.9f, 0.6f, 0.9f);
        input.camera.forward = normalize(glm::vec3(-1, -0.3f, -1));
        settings.views.placement = Placement::traced;
        settings.gather.clampDistance = 0.01;
        settings.gather.nearField = false;
        renderer->render(settings, input, statistics);
        ASSERT_EQ(gl::reportedErrors(), 0u);
    }
    glm::vec3 irradianceAt(std::size_t pixel) const {
        const auto x = static_cast<int>(pixel) % kWidth, y = static_cast<int>(pixel) / kWidth;
        return renderer->readPixel(x, y).sides[0].unfiltered;
    }

    Settings settings;
    SceneHierarchy hierarchy;
    std::unique_ptr<FrameRenderer> renderer;
    FrameStatistics statistics;
};

TEST_F(ShadowRays, GiveTheExactGathersLight) {
    const testing::Lit lit(testing::furnishedRoom(1, testing::everything));
    render(lit);
    EXPECT_EQ(statistics.badPixels, 0u);
    EXPECT_EQ(statistics.methods.at(0).mapBytes, 0u);
    EXPECT_EQ(statistics.methods.at(0).pairs, PairCounts{});

    const auto receivers = renderer->readReceivers();
    const auto views = renderer->readViews().views;
    const float clamp = 0.01f;
    const auto gathered = [&](const TriangleBvh& bvh, bool visibility) {
        IrradianceImage image;
        exactGather(EmbreeScene(bvh), views, receivers, kWidth, kHeight, {clamp, visibility},
                    image);
        return image.mean;
    };
    const auto exact = gathered(lit.bvh, true), open = gathered(lit.bvh, false);
    // The same room with a screen that lets nothing through.
    testing::Lit solid(testing::furnishedRoom(1, testing::everything));
    for (Material& material : solid.scene.materials) material.alphaCutoff = 0;
    solid.bvh = TriangleBvh::build(solid.scene);
    const auto unmasked = gathered(solid.bvh, true);

    int surfaces = 0, different = 0, shadowed = 0, behindMask = 0;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        if (receivers[i].normal == glm::vec3(0)) continue;
        const glm::vec3 got = irradianceAt(i);
        ++surfaces;
        // Normals are packed, so that a ray may graze an edge on the other side: in few pixels.
        different += glm::length(got - exact[i]) > 2e-3f * glm::length(exact[i]) + 1e-7f;
        shadowed += glm::length(got - open[i]) > 0.05f * glm::length(open[i]);
        behindMask += glm::length(got - unmasked[i]) > 0.01f * glm::length(got);
    }
    EXPECT_GT(surfaces, kWidth * kHeight / 2);
    EXPECT_LE(different, surfaces / 50);
    EXPECT_GT(shadowed, surfaces / 4);
    EXPECT_GT(behindMask, 0) << "masks change nothing";
}

TEST_F(ShadowRays, AnswerSamplesAsTheirTwinOnTheCpu) {
    const testing::Lit lit(testing::furnishedRoom(2, testing::everything));
    render(lit, 16);
    const auto receivers = renderer->readReceivers();
    int asked = 0, hidden = 0, different = 0;
    for (int x = 1; x < kWidth; x += 5) {
        const int y = kHeight / 3;
        const Receiver& r = receivers[static_cast<std::size_t>(y * kWidth + x)];
        if (r.normal == glm::vec3(0)) continue;
        for (const GatheredSample& s : renderer->readSamples(x, y)) {
            if (s.unoccluded == glm::vec3(0)) continue;  // nobody asks
            const bool blocked = shadowRayBlocked(lit.bvh, r.position, r.normal, s.position);
            ++asked;
            hidden += s.visible == 0;
            different += blocked != (s.visible == 0);
        }
    }
    EXPECT_GT(asked, 50);
    EXPECT_GT(hidden, 5);
    EXPECT_LE(different, asked / 50);
}

// A floor under a sheet that faces it, as the two sides of a carton whose positions are packed may
// lie: the camera looks through the sheet's back, and so must rays.
TEST_F(ShadowRays, BeginAboveBothOfTwoSheetsOnAGrid) {
    const auto floorLight = [&](bool sheet, float step) {
        testing::RoomBuilder room = testing::whiteRoom(0.5f);
        room.light(LightType::point, {2, 2.5, 2.5}, {0, -1, 0}, glm::vec3(100));
        if (sheet) {
            room.quad({0, 0.001, 0}, {4, 0, 0}, {0, 0, 5}, room.material(glm::vec3(0.5f)));
        }
        Scene scene = room.finish();
        scene.positionStep = step;
        const testing::Lit lit(std::move(scene));
        render(lit);
        const auto receivers = renderer->readReceivers();
        IrradianceImage exact;
        exactGather(EmbreeScene(lit.bvh), renderer->readViews().views, receivers, kWidth, kHeight,
                    {0.01f, true}, exact);
        double light = 0, exactLight = 0;
        int pixels = 0;
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            if (!(receivers[i].normal.y > 0.9f)) continue;
            ++pixels;
            light += irradianceAt(i).y;
            exactLight += exact.mean[i].y;
        }
        EXPECT_GT(pixels, 100);
        EXPECT_NEAR(light, exactLight, 0.01 * exactLight + 1e-9);
        return light / pixels;
    };
    const double bare = floorLight(false, 0);
    EXPECT_GT(bare, 0);
    EXPECT_LT(floorLight(true, 0), 0.01 * bare);
    EXPECT_NEAR(floorLight(true, 3e-4f), bare, 0.05 * bare);
}

}  // namespace
}  // namespace mv
