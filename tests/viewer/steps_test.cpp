// The Steps instrument in a window: pairs picked and explained, nodes picked to start from,
// outcomes hidden.

#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

class StepsTest : public ViewerTest {
  protected:
    static bool says(const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    }
    static std::uint64_t countOf(const Viewer& viewer, const std::string& outcome) {
        for (const ui::LegendEntry& d : viewer.model().steps.decisions) {
            if (d.label == outcome) return d.count.value_or(0);
        }
        return 0;
    }
};

TEST_F(StepsTest, APairIsPickedInThePictureAndSaysWhatDecidedIt) {
    Viewer viewer(1280, 720);
    viewer.run("steps; step=4; wait-still; wait 2");
    EXPECT_FALSE(viewer.model().steps.picked);
    const auto before = viewer.pixels();
    viewer.run("click 50%,50%; wait 2");
    const InspectSettings& inspect = viewer.settings().inspect;
    ASSERT_TRUE(inspect.pairScene && inspect.pairView);
    const ui::StepsData& steps = viewer.model().steps;
    ASSERT_TRUE(steps.picked);
    EXPECT_TRUE(says(steps.picked->scene, "node " + std::to_string(*inspect.pairScene)));
    EXPECT_TRUE(says(steps.picked->view, "node " + std::to_string(*inspect.pairView)));
    EXPECT_FALSE(steps.picked->reason.empty());
    EXPECT_FALSE(steps.picked->comparisons.empty());
    EXPECT_NE(viewer.pixels(), before) << "it is seen in the picture";
    EXPECT_EQ(viewer.model().legends[0].entries.back().label, "picked pair");

    // Clicked again, each pair that passes there has its turn.
    const auto picked = [&] { return std::pair(*inspect.pairScene, *inspect.pairView); };
    const auto first = picked();
    int turns = 0;
    do {
        viewer.run("click 50%,50%; wait 2");
        ++turns;
    } while (turns < 500 && picked() != first);
    EXPECT_GT(turns, 1);
    EXPECT_LT(turns, 500);

    const std::string decision = steps.picked->decision;
    const std::int64_t scene = *inspect.pairScene, view = *inspect.pairView;
    viewer.run("click @steps.from-pair; wait 2");
    EXPECT_EQ(inspect.step, 1);
    EXPECT_EQ(inspect.stepScene, scene);
    EXPECT_EQ(inspect.stepView, view);
    EXPECT_EQ(steps.pairs, 1u);
    EXPECT_EQ(countOf(viewer, decision), 1u) << "the one pair of the first step is the picked one";

    viewer.run("profiler; wait 2");
    EXPECT_TRUE(viewer.model().legends.empty()) << "drawn while the panel is open";
}

TEST_F(StepsTest, NothingIsPickedWhereNothingIsDrawn) {
    Viewer viewer(1280, 720);
    viewer.run(
        "steps; step=4; step-hide=culled,rendered,forced,split-scene,split-view,skipped; "
        "wait 2; click 50%,50%; wait 2");
    EXPECT_FALSE(viewer.settings().inspect.pairScene);
    ASSERT_FALSE(viewer.model().toasts.empty());
    EXPECT_EQ(viewer.model().toasts.back().text, "there is no pair here");
}

TEST_F(StepsTest, StartNodesArePickedInThePicture) {
    Settings settings = Viewer::smallSettings();
    settings.views.vpls = 1024;
    settings.scene.octreeDepth = settings.views.octreeDepth = 8;
    Viewer viewer(1280, 720, settings);
    const InspectSettings& inspect = viewer.settings().inspect;
    const ui::StepsData& steps = viewer.model().steps;
    viewer.run("steps; wait 2; click @steps.pick-scene; wait 1; click 50%,60%; wait 2");
    EXPECT_EQ(viewer.model().picking, ui::Picking::none) << "one click";
    EXPECT_GT(inspect.stepScene, 0);
    EXPECT_EQ(inspect.step, 1);
    EXPECT_TRUE(says(steps.sceneNode, "level 8, a leaf")) << steps.sceneNode;
    viewer.run("show-octree=3; click @steps.pick-scene; wait 1; click 50%,60%; wait 2");
    EXPECT_TRUE(says(steps.sceneNode, "level 3")) << "of the level that is drawn";

    const auto pickView = [&] {
        for (int y = 80; y > 40 && inspect.stepView == 0; y -= 2) {
            viewer.run("click @steps.pick-view; wait 1; click 50%," + std::to_string(y) +
                       "%; wait 2");
        }
        return steps.viewNode;
    };
    EXPECT_TRUE(says(pickView(), "a leaf")) << steps.viewNode;
    viewer.run("step-view=0; show-view-octree=2; wait 1");
    EXPECT_TRUE(says(pickView(), "level 2")) << steps.viewNode;
    viewer.run("steps; wait 1; click 50%,60%; wait 1");
    EXPECT_FALSE(inspect.pairScene) << "a closed panel picks nothing";
}

TEST_F(StepsTest, OutcomesAreHiddenAndPairsChosen) {
    Viewer viewer(1280, 720);
    viewer.run("steps; step=7; wait-still; wait 2");
    const ui::StepsData& steps = viewer.model().steps;
    const std::uint64_t split = countOf(viewer, "split scene"), all = steps.pairs;
    ASSERT_GT(split, 0u);
    EXPECT_EQ(steps.eligible, all);
    const auto before = viewer.pixels();
    viewer.run("click @outcome:split-scene; wait 2");
    EXPECT_EQ(steps.pairs, all);
    EXPECT_EQ(steps.eligible, all - split);
    EXPECT_NE(viewer.pixels(), before);
    viewer.run("step-pairs=largest; wait 2");
    EXPECT_LE(steps.drawn, 120u);
    EXPECT_EQ(steps.links, steps.drawn) << "each with its link";
    viewer.run("step-hide=; step-pairs=pair; wait 2");
    EXPECT_EQ(steps.drawn, 0u) << "none is picked";
    viewer.run("pair-scene=0; pair-view=0; wait 2");
    EXPECT_EQ(steps.eligible, all) << "all pairs come from that of the roots";
    viewer.run("step-pairs=views; pick-a=8; wait 2");
    EXPECT_GT(steps.eligible, 0u);
    EXPECT_LT(steps.eligible, all);
}

}  // namespace
}  // namespace mv
