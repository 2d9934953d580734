// A scene that moves, in the window: scrubbed, played, under references, kept in states.

#include "app/temp_folder.h"
#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

class MovingScene : public ViewerTest {
  protected:
    static Settings small() {
        Settings s = Viewer::smallSettings();
        s.scene.octreeDepth = 6;
        return s;
    }
    // There is one window at a time.
    Viewer& open(double timeS, Settings settings = small()) {
        settings.scene.timeS = timeS;
        viewer_.reset();
        viewer_ = std::make_unique<Viewer>(480, 320, settings, "builtin:door");
        return *viewer_;
    }
    std::vector<float> light() {
        viewer_->run("wait-still");
        return viewer_->session->picture().renderer().radiance().readFloats(4);
    }
    std::unique_ptr<Viewer> viewer_;
};

TEST_F(MovingScene, ScrubbedStandsWhereItWouldHaveBeenOpened) {
    Viewer& viewer = open(4);
    const std::vector<float> wide = light();
    viewer.run("time 9");
    const std::vector<float> shut = light();
    EXPECT_NE(shut, wide);
    viewer.run("time 4");
    EXPECT_EQ(light(), wide);
    viewer.run("time 16");  // the loop lasts 12 s
    EXPECT_EQ(light(), wide);
    open(9);
    EXPECT_EQ(light(), shut);
}

TEST_F(MovingScene, PlayedItStandsAtTheTimeThatIsShown) {
    Viewer& viewer = open(4);
    viewer.run("play-or-pause; wait 7; play-or-pause");
    const double paused = viewer.session->timeS();
    EXPECT_NE(paused, 4);
    const std::vector<float> first = light();
    viewer.run("step-forward");
    const double stepped = viewer.session->timeS();
    const std::vector<float> second = light();
    EXPECT_NE(first, second);
    open(paused);
    EXPECT_EQ(light(), first);
    open(stepped);
    EXPECT_EQ(light(), second);
}

TEST_F(MovingScene, AReferenceIsThatOfTheTimeThatIsShown) {
    Settings settings = small();
    settings.views.vpls = 16;
    settings.side[0].method = Method::pathtraced;
    settings.side[0].referenceSamples = 1;
    settings.picture.accumulate = 1;
    Viewer& viewer = open(4, settings);
    viewer.frames(2);
    viewer.run("time 9; wait 1; time 2; wait 1; time 9");  // while rays are on their way
    EXPECT_EQ(viewer.model().error, "");
    const std::vector<float> wandered = light();
    open(9, settings);
    EXPECT_EQ(light(), wandered);
}

TEST_F(MovingScene, AStateBringsItsTimeBack) {
    const test::TempFolder folder;
    const std::string file = folder.file("state.json");
    Viewer& viewer = open(7.25);
    const std::vector<float> before = light();
    viewer.run("save-state " + file + "; time 1; wait 2; load-state " + file + "; wait-loading");
    EXPECT_EQ(light(), before);
}

}  // namespace
}  // namespace mv
