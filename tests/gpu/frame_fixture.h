#pragma once
// The Cornell box through FrameRenderer, small: for tests of what a frame shares, keeps and shows.

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "megaviews/core/error.h"
#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/scene/load_scene.h"
#include "megaviews/scene/triangle_bvh.h"
#include "renderer/frame_renderer.h"
#include "renderer/gl/context.h"

namespace mv::test {

struct Cornell {
    Scene scene = makeBuiltin("cornell", {});
    TriangleBvh bvh = TriangleBvh::build(scene);
    SceneHierarchy hierarchy = SceneHierarchy::build(scene, bvh, 6);
};

class FrameTest : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        try {
            context_ = std::make_unique<gl::HeadlessContext>();
            cornell_ = std::make_unique<Cornell>();
        } catch (const Error& e) {
            reason_ = e.what();
        }
    }
    static void TearDownTestSuite() {
        cornell_.reset();
        context_.reset();
    }
    void SetUp() override {
        if (!context_) GTEST_SKIP() << reason_;
        startAfresh();
        settings.resolution.width = 75;
        settings.resolution.height = 43;
        settings.views.vpls = 200;
        settings.gather.samples = 8;
        // What the CPU's references make as well; the tests of the rest choose it.
        settings.views.placement = Placement::traced;
        settings.picture.freshViews = false;
        settings.gather.clampDistance = 0.01;
        settings.gather.nearField = false;
        settings.gather.undecided = Undecided::off;
        settings.views.octreeDepth = settings.scene.octreeDepth = 6;
        settings.display.exposureEv = 0;
        input.camera = frameCamera(cornell_->scene.camerasAt(0, -1).front(), cornell_->scene.root);
        input.animation = -1;
    }
    void TearDown() override {
        if (!context_) return;
        EXPECT_EQ(gl::reportedErrors(), 0u);
        renderer.reset();
    }

    void startAfresh() {
        renderer = std::make_unique<FrameRenderer>();
        renderer->setScene(cornell_->scene, cornell_->bvh, cornell_->hierarchy);
    }
    FrameStatistics render() { return render(settings); }
    FrameStatistics render(const Settings& with) {
        FrameStatistics statistics;
        renderer->render(with, input, statistics);
        return statistics;
    }
    std::vector<float> radiance() const { return renderer->radiance().readFloats(4); }
    std::vector<std::uint8_t> display() const { return renderer->display().readBytes(4); }

    static const Scene& scene() { return cornell_->scene; }
    static const TriangleBvh& bvh() { return cornell_->bvh; }
    static const SceneHierarchy& hierarchy() { return cornell_->hierarchy; }

    std::unique_ptr<FrameRenderer> renderer;
    Settings settings;
    FrameInput input;

  private:
    static inline std::unique_ptr<gl::HeadlessContext> context_;
    static inline std::unique_ptr<Cornell> cornell_;
    static inline std::string reason_;
};

}  // namespace mv::test
