#pragma once
// A frame of a small scene whose surfaces reflect or let sight through.

#include <memory>
#include <utility>
#include <vector>

#include "gpu/frame_fixture.h"
#include "gpu/picture_scenes.h"

namespace mv::test {

class ReflectionsTest : public FrameTest {
  protected:
    void SetUp() override {
        FrameTest::SetUp();
        if (IsSkipped()) return;
        settings.resolution.width = settings.resolution.height = 48;
        settings.gather.samples = 0;  // no noise
        settings.gather.filter = false;
        settings.side[0].method = Method::none;
        settings.views.bounces = 1;
    }
    void show(Scene made) {
        renderer.reset();
        shown_ = std::make_unique<Shown>(std::move(made));
        renderer = std::make_unique<FrameRenderer>();
        renderer->setScene(shown_->scene, shown_->bvh, shown_->hierarchy);
    }
    // Red of the picture that all sets of samples make.
    double meanOfSets() {
        for (int i = 0; i < settings.picture.accumulate; ++i) render();
        const std::vector<float> picture = radiance();
        double sum = 0;
        for (std::size_t i = 0; i < picture.size(); i += 4) sum += static_cast<double>(picture[i]);
        return sum / static_cast<double>(picture.size() / 4);
    }
    static Material mirror(float roughness = 0, glm::vec3 colour = glm::vec3(1)) {
        Material m;
        m.metallic = 1;
        m.roughness = roughness;
        m.baseColor = glm::vec4(colour, 1);
        return m;
    }

  private:
    struct Shown {
        explicit Shown(Scene made) : scene(std::move(made)) {}
        Scene scene;
        TriangleBvh bvh = TriangleBvh::build(scene);
        SceneHierarchy hierarchy = SceneHierarchy::build(scene, bvh, 5);
    };
    std::unique_ptr<Shown> shown_;

  protected:
    void TearDown() override {
        FrameTest::TearDown();
        shown_.reset();
    }
};

}  // namespace mv::test
