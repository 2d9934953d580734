// Shadows of lights that have a size, an emissive quad and the sky, against the path tracer's: by
// default, and by depth maps alone, many views of the lamp rasterised at once [Marrs17].

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "megaviews/core/error.h"
#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/measure/metrics.h"
#include "megaviews/references/path_tracer.h"
#include "megaviews/settings/settings_table.h"
#include "megaviews/views/sky.h"
#include "renderer/frame_renderer.h"
#include "renderer/gl/context.h"
#include "views/rooms.h"

namespace mv {
namespace {

using glm::dvec3;

// A block, a thin pole, a board on nothing and five bars above a floor. Where it reflects next to
// nothing, what is seen is the lamp's own light.
Scene yard(double lampEdge, float albedo = 0.03f) {
    testing::RoomBuilder room;
    const int stone = room.material(glm::vec3(albedo));
    room.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, stone);
    room.box({-1.6, 0, -0.6}, {-0.8, 1.2, 0.1}, stone);
    room.box({1.8, 0, -1.1}, {1.92, 2, -0.98}, stone);
    room.box({-1.2, 1.06, -2.1}, {1.2, 1.14, -1.1}, stone);
    for (int k = 0; k < 5; ++k) {
        const double x = -0.6 + 0.3 * k;
        room.box({x - 0.05, 0.75, 1.2}, {x + 0.05, 0.85, 2.2}, stone);
    }
    if (lampEdge > 0) {
        room.quad({-lampEdge / 2, 3, -lampEdge / 2}, {lampEdge, 0, 0}, {0, 0, lampEdge},
                  room.material(glm::vec3(0), glm::vec3(10)));
    }
    return room.finish();
}

// Radiance 1 from everywhere, and a patch of 6 degrees half way up that gives as much light again.
std::shared_ptr<const EnvironmentImage> skyWithDisc() {
    auto image = std::make_shared<EnvironmentImage>();
    image->width = 64;
    image->height = 32;
    image->radiance.assign(64 * 32, glm::vec3(1));
    image->radiance[8 * 64 + 37] = glm::vec3(500);
    return image;
}

class SoftShadows : public ::testing::Test {
  protected:
    static constexpr int kWidth = 160, kHeight = 90;
    void SetUp() override {
        try {
            context_ = std::make_unique<gl::HeadlessContext>();
        } catch (const Error& e) {
            GTEST_SKIP() << e.what();
        }
        settings.resolution = {kWidth, kHeight};
        settings.views.bounces = 1;
        settings.display.exposureEv = 0;
    }
    void TearDown() override {
        renderer_.reset();
        if (!context_) return;
        EXPECT_EQ(gl::reportedErrors(), 0u);
    }
    void show(Scene scene) {
        scene_ = std::move(scene);
        bvh_ = TriangleBvh::build(scene_);
        hierarchy_ = SceneHierarchy::build(scene_, bvh_, 9);
        settings.scene.octreeDepth = settings.views.octreeDepth = 9;
        renderer_ = std::make_unique<FrameRenderer>();
        renderer_->setScene(scene_, bvh_, hierarchy_);
        const dvec3 eye(0, 3.2, 6.2), at(0, 0.4, 0);
        input.camera.position = scene_.root.rootFromWorld(eye);
        input.camera.forward = glm::vec3(glm::normalize(at - eye));
        input.camera.yfovRad = 0.75f;
        input.animation = -1;
        truth_ = pathTraced();
    }
    // Of the whole picture, as `--reference FILE --metrics relmse` measures it; and for
    // docs/results-earlier.md, under a name in the file of --gtest_output.
    double relMse(const std::string& name) {
        const double error = relMse(render(settings));
        RecordProperty(name, std::to_string(error));
        return error;
    }
    double relMse(const RgbImage& picture) const {
        const Metric metric = Metric::relMse;
        return evaluate(compared({picture, *truth_, true, 0, ToneMap::aces}), {&metric, 1})
            .front()
            .value;
    }
    RgbImage pathTraced(std::uint32_t seed = 1) {
        Settings with = settings;
        with.side[0].method = Method::pathtraced;
        render(with);
        const Emitters emitters = makeEmitters(
            scene_, bvh_, {.environment = {settings.scene.environment, input.environment}});
        const EmbreeScene embree(bvh_);
        IrradianceImage image;
        pathTrace(embree, emitters, renderer_->readReceivers(), kWidth, kHeight, {1, 256, seed},
                  image);
        renderer_->setReference(0, renderer_->wantedReference(0), image.mean, true);
        return render(with);
    }
    Settings settings;
    FrameInput input;

  private:
    RgbImage render(const Settings& with) {
        FrameStatistics statistics;
        renderer_->render(with, input, statistics);
        const std::vector<float> texels = renderer_->radiance().readFloats(4);
        RgbImage image{kWidth, kHeight, {}};
        for (std::size_t i = 0; i < texels.size(); ++i) {
            if (i % 4 != 3) image.rgb.push_back(texels[i]);
        }
        return image;
    }
    std::unique_ptr<gl::HeadlessContext> context_;
    Scene scene_;
    TriangleBvh bvh_;
    SceneHierarchy hierarchy_;
    std::unique_ptr<FrameRenderer> renderer_;
    std::optional<RgbImage> truth_;
};

TEST_F(SoftShadows, OfAQuadAreThePathTracersByDefault) {
    for (const double edge : {1.4, 0.3}) {
        show(yard(edge));
        const std::string lamp = edge > 1 ? "-wide" : "-small";
        EXPECT_LT(relMse(pathTraced(2)), 0.004) << "the paths' own noise, twice";
        for (const Method method : {Method::megaviews, Method::shadowRays, Method::vir}) {
            settings.side[0].method = method;
            EXPECT_LT(relMse(std::string(nameOf(method)) + lamp), 0.02) << nameOf(method) << lamp;
        }
        settings.side[0].method = Method::none;
        EXPECT_GT(relMse("none" + lamp), 0.2) << "shadows matter here";
    }
}

TEST_F(SoftShadows, OfASkyAreThePathTracersByDefault) {
    for (const bool disc : {false, true}) {
        const std::string sky = disc ? "disc" : "white";
        settings.gather = {};
        settings.scene.environment.source = disc ? "image.exr" : "white";
        if (disc) input.environment = skyWithDisc();
        show(yard(0, 0.6f));
        EXPECT_LT(relMse(sky), 0.02) << sky;
        settings.gather.skySamples = 1;
        settings.gather.filter = false;
        EXPECT_GT(relMse(sky + "-one-ray"), 0.04) << "one ray, not filtered; " << sky;
    }
}

TEST_F(SoftShadows, OfASkyAreThePathTracersByMapsOfManyViewsAtOnce) {
    settings.gather.skyViews = settings.gather.skySamples = 128;
    for (const bool disc : {false, true}) {
        const std::string sky = disc ? "disc-maps" : "white-maps";
        settings.scene.environment.source = disc ? "image.exr" : "white";
        if (disc) input.environment = skyWithDisc();
        show(yard(0, 0.6f));
        EXPECT_LT(relMse(sky), 0.02) << sky;
    }
}

// Every pixel asks all maps of the lamp, and no ray: docs/baselines.md.
TEST_F(SoftShadows, OfAQuadAreThePathTracersByMapsOfManyViewsAtOnce) {
    show(yard(1.4));
    settings.views.vpls = 128;
    settings.gather.samples = 0;
    settings.gather.undecided = Undecided::off;
    settings.gather.filter = false;
    for (const Method method : {Method::vir, Method::raster}) {
        settings.side[0].method = method;
        settings.side[0].maps.resolution = 128;
        EXPECT_LT(relMse(std::string(nameOf(method)) + "-128"), 0.01) << nameOf(method);
        settings.side[0].maps.resolution = 16;
        EXPECT_GT(relMse(std::string(nameOf(method)) + "-16"), 0.05) << "too coarse for the bars";
    }
}

}  // namespace
}  // namespace mv
