// Frames of a scene that moves: the same as those of a renderer that never saw another pose.

#include <algorithm>

#include "gpu/frame_fixture.h"
#include "megaviews/scene/rigged_scene.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

struct Door {
    Scene scene = makeBuiltin("door", {});
    TriangleBvh bvh = TriangleBvh::build(scene);
    SceneHierarchy hierarchy = SceneHierarchy::build(scene, bvh, 7);
    Door() { hierarchy.joinMoving(scene, bvh, 7); }
    void pose(double timeS) {
        if (!poseScene(scene, timeS)) return;
        bvh.refit();
        hierarchy.refit(scene);
    }
};

class FramePose : public test::FrameTest {
  protected:
    void SetUp() override {
        FrameTest::SetUp();
        if (IsSkipped()) return;
        settings.scene.octreeDepth = 7;
        settings.gather.nearField = true;
        settings.gather.undecided = Undecided::rays;
        input.camera = frameCamera(door_.scene.camerasAt(0, 0).front(), door_.scene.root);
        input.animation = 0;
    }
    FrameStatistics renderAt(double timeS) {
        input.timeS = timeS;
        input.pose = [this, timeS] { door_.pose(timeS); };
        return render();
    }
    Door door_;
};

bool hasStage(const FrameStatistics& statistics, Stage stage) {
    for (const StageTime& time : statistics.stagesOfBothSides) {
        if (time.stage == stage) return true;
    }
    return false;
}

TEST_F(FramePose, IsThatOfASceneThatStandsThere) {
    for (const Method method : {Method::megaviews, Method::manylods, Method::shadowRays,
                                Method::raster, Method::ism, Method::vir}) {
        SCOPED_TRACE(nameOf(method));
        settings.side[0].method = method;
        door_.pose(0);
        renderer = std::make_unique<FrameRenderer>();
        renderer->setScene(door_.scene, door_.bvh, door_.hierarchy);
        renderAt(0);
        const std::vector<float> first = radiance();
        EXPECT_TRUE(hasStage(renderAt(4), Stage::pose));
        const std::vector<float> posed = radiance();
        EXPECT_NE(posed, first);

        renderer = std::make_unique<FrameRenderer>();
        renderer->setScene(door_.scene, door_.bvh, door_.hierarchy);
        renderAt(4);
        EXPECT_EQ(radiance(), posed);
        renderAt(0);  // and back
        EXPECT_EQ(radiance(), first);
    }
}

TEST_F(FramePose, ADoorThatOpensLetsTheLightIn) {
    door_.scene.lights.pop_back();  // the one in the hall itself
    renderer->setScene(door_.scene, door_.bvh, door_.hierarchy);
    settings.picture.view = DebugView::indirect;
    // The median: a sum would be that of a few pixels beside a view.
    const auto lightAt = [&](double timeS) {
        renderAt(timeS);
        const std::vector<float> all = radiance();
        std::vector<float> green;
        for (std::size_t i = 1; i < all.size(); i += 4) green.push_back(all[i]);
        std::ranges::nth_element(green,
                                 green.begin() + static_cast<std::ptrdiff_t>(green.size() / 2));
        return green[green.size() / 2];
    };
    const float shut = lightAt(9), open = lightAt(4);
    EXPECT_GT(open, 10 * shut);
    EXPECT_EQ(lightAt(9), shut);
}

TEST_F(FramePose, ASceneThatStandsHasNoSuchStage) {
    startAfresh();
    settings.scene.octreeDepth = 6;
    input.camera = frameCamera(scene().camerasAt(0, -1).front(), scene().root);
    EXPECT_FALSE(hasStage(render(), Stage::pose));
}

}  // namespace
}  // namespace mv
