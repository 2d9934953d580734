// References through FrameRenderer: the same receivers, composition and exposure as the GPU's.

#include <cmath>

#include "gpu/frame_fixture.h"
#include "megaviews/references/exact_gather.h"
#include "shaders/shared/microfacet.glsl"
#include "shaders/shared/near_field.glsl"

namespace mv {
namespace {

class FrameReference : public test::FrameTest {
  protected:
    // Renders with the exact gather where a frame wants it, and counts how often it does.
    FrameStatistics renderWhole(bool visibility = true) {
        FrameStatistics statistics = render();
        for (const int side : {0, 1}) {
            const std::uint64_t wanted = renderer->wantedReference(side);
            if (wanted == 0) continue;
            ++made;
            const TriangleBvh bvh = TriangleBvh::build(scene());
            const EmbreeScene embree(bvh);
            IrradianceImage image;
            exactGather(embree, renderer->readViews().views, renderer->readReceivers(),
                        settings.resolution.width, settings.resolution.height,
                        {.visibility = visibility}, image);
            renderer->setReference(side, wanted, image.mean, true);
            statistics = render();
        }
        return statistics;
    }
    int made = 0;
};

TEST_F(FrameReference, WithoutVisibilityIsTheFullSumOfTheGpu) {
    settings.side[0].method = Method::none;
    settings.gather.samples = 0;
    settings.gather.filter = false;
    render();
    const std::vector<float> gpu = radiance();
    settings.side[0].method = Method::exact;
    renderWhole(false);
    const std::vector<float> open = radiance();
    startAfresh();
    renderWhole();
    const std::vector<float> exact = radiance();
    double worst = 0, sum = 0, darker = 0;
    for (std::size_t i = 0; i < gpu.size(); ++i) {
        worst = std::max(worst, std::abs(double{open[i]} - double{gpu[i]}) / (gpu[i] + 1e-3));
        sum += double{gpu[i]};
        darker += double{open[i]} - double{exact[i]};
        ASSERT_LE(exact[i], open[i]);
    }
    EXPECT_GT(sum, 0);
    EXPECT_LT(worst, 2e-3);  // packed normals and fluxes
    EXPECT_GT(darker, 0.002 * sum);
}

// What near surfaces give back, by the same numbers: lit by lamps and views, by a sky, glowing.
TEST_F(FrameReference, NearFieldIsTheSameToBoth) {
    settings.side[0].method = Method::none;
    settings.gather.samples = 0;
    settings.gather.filter = false;
    settings.gather.clampDistance = 0.05;
    const auto sumOf = [&](bool nearField) {
        settings.picture.view = DebugView::indirect;
        settings.gather.nearField = nearField;
        render();
        double sum = 0;
        for (const float x : radiance()) sum += double{x};
        return sum;
    };
    for (const std::string kind : {"lamps", "sky", "glow"}) {
        Scene lit = scene();
        if (kind == "glow") {
            for (Material& material : lit.materials) material.emission = glm::vec3(0.02f);
        }
        settings.scene.environment.source = kind == "sky" ? "white" : "none";
        const TriangleBvh bvh = TriangleBvh::build(lit);
        renderer->setScene(lit, bvh, hierarchy());
        const double clamped = sumOf(false), whole = sumOf(true);
        settings.picture.view = DebugView::albedo;
        render();
        const std::vector<float> albedo = radiance();
        const auto views = renderer->readViews().views;
        const auto receivers = renderer->readReceivers();
        const EmbreeScene embree(bvh);
        const Emitters emitters =
            makeEmitters(lit, bvh,
                         {.scale = settings.scene.lightScale,
                          .environment = {settings.scene.environment, nullptr}});
        const auto expected = [&](int rays) {
            ExactGatherOptions options{.clampDistance = 0.05f, .visibility = false};
            options.nearFieldRays = rays;
            options.lights = emitters.lights;
            options.sky = rays > 0 ? emitters.sky : nullptr;
            options.skyRays = 0;
            options.emissionScale = kind == "glow" ? 1.0f : 0.0f;
            options.bounces = settings.views.bounces;
            IrradianceImage image;
            exactGather(embree, views, receivers, settings.resolution.width,
                        settings.resolution.height, options, image);
            double sum = 0;
            for (std::size_t i = 0; i < image.mean.size(); ++i) {
                for (int c = 0; c < 3; ++c) {
                    sum += double{image.mean[i][c]} *
                           double{albedo[4 * i + static_cast<std::size_t>(c)]} / 3.14159265;
                }
            }
            return sum;
        };
        const double ofClamped = expected(0), added = expected(kNearFieldRays) - ofClamped;
        EXPECT_GT(added, 1e-3 * ofClamped) << kind;
        EXPECT_NEAR((whole - clamped) / added, 1, 0.02) << kind;
        startAfresh();
    }
}

TEST_F(FrameReference, BroadGlossIsTheSameToBoth) {
    Scene glossy = scene();
    for (Material& material : glossy.materials) {
        material.specular = kSpecularOfGlass;
        material.roughness = 0.8f;
    }
    const TriangleBvh bvh = TriangleBvh::build(glossy);
    settings.side[0].method = Method::none;
    settings.gather.samples = 0;
    settings.gather.filter = false;
    settings.picture.view = DebugView::indirect;
    render();
    const std::vector<float> matt = radiance();
    renderer->setScene(glossy, bvh, hierarchy());
    render();
    const std::vector<float> gpu = radiance();
    settings.side[0].method = Method::exact;
    render();
    const std::uint64_t wanted = renderer->wantedReference(0);
    const std::vector<Receiver> receivers = renderer->readReceivers();
    const ViewSet views = renderer->readViews();
    IrradianceImage whole;
    exactGather(EmbreeScene(bvh), views.views, receivers, settings.resolution.width,
                settings.resolution.height, {.visibility = false}, whole);
    renderer->setReference(0, wanted, whole.mean, true);
    render();
    const std::vector<float> exact = radiance();
    double worst = 0, changed = 0;
    for (std::size_t i = 0; i < gpu.size(); ++i) {
        worst = std::max(worst, std::abs(double{exact[i]} - double{gpu[i]}) / (gpu[i] + 1e-3));
        changed = std::max(changed, std::abs(double{gpu[i]} - double{matt[i]}) / (gpu[i] + 1e-3));
    }
    EXPECT_LT(worst, 4e-3);  // packed normals and fluxes
    EXPECT_GT(changed, 0.02);
    renderer.reset();
}

TEST_F(FrameReference, IsMadeOnceForAllThatShowsIt) {
    compareWith(settings, Method::exact);
    settings.picture.accumulate = 3;
    EXPECT_EQ(renderWhole().accumulatedFrames, 2);
    EXPECT_EQ(renderWhole().accumulatedFrames, 3);
    settings.display.difference = Difference::absolute;
    settings.display.exposureEv = 2;
    settings.picture.view = DebugView::indirect;
    renderWhole();
    EXPECT_EQ(made, 1);
    const PixelValues pixel = renderer->readPixel(37, 10);
    ASSERT_TRUE(pixel.surface);
    EXPECT_EQ(pixel.sides[1].unfiltered.x * pixel.albedo.x / kPi, pixel.sides[1].indirect.x);
    EXPECT_TRUE(renderer->readSamples(37, 10, 1).empty());
    settings.seed = 5;
    renderWhole();
    EXPECT_EQ(made, 2);
}

TEST_F(FrameReference, IsMissedUntilItIsThere) {
    for (const Method method : {Method::exact, Method::pathtraced}) {
        settings.side[0].method = method;
        render();
        EXPECT_TRUE(renderer->awaitsReferences());
        EXPECT_NE(renderer->wantedReference(0), 0u);
        EXPECT_EQ(renderer->wantedReference(1), 0u);
    }
    settings.side[0].method = Method::none;
    render();
    EXPECT_FALSE(renderer->awaitsReferences());
    EXPECT_EQ(renderer->wantedReference(0), 0u);
}

// Exposure is that of the whole picture, whenever it comes.
TEST_F(FrameReference, ExposureIsFittedToTheWhole) {
    settings.side[0].method = Method::exact;
    settings.display.exposureEv.reset();
    render();
    const double early = renderer->exposureEv();
    const double whole = renderWhole().exposureEv;
    EXPECT_LT(whole, early);
    renderer->forgetExposure();
    render();
    EXPECT_EQ(renderer->exposureEv(), whole);
    settings.side[0].method = Method::none;  // and then stays
    render();
    EXPECT_EQ(renderer->exposureEv(), whole);
}

}  // namespace
}  // namespace mv
