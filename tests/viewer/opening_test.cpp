// Another scene is opened while one stands: what of the window goes over to it, and what does not.

#include <fstream>
#include <nlohmann/json.hpp>

#include "app/temp_folder.h"
#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

class Opening : public ViewerTest {};

TEST_F(Opening, SettingsOfTheWindowGoOverAlsoWhileItLoads) {
    Viewer viewer;
    viewer.run("lights=0:::60,30,10; exposure=3; open builtin:door; method=manylods");
    viewer.waitForScene();
    viewer.frames(3);
    EXPECT_EQ(viewer.model().sceneName, "builtin:door");
    EXPECT_EQ(viewer.settings().side[0].method, Method::manylods);
    EXPECT_EQ(viewer.settings().scene.lights, "");
    EXPECT_FALSE(viewer.settings().display.exposureEv);
    EXPECT_FALSE(viewer.model().canUndo);
}

// A state whose first picture fails leaves the new scene without lights and time of the old one.
TEST_F(Opening, AFirstPictureThatFailsHasNothingOfTheOldScene) {
    const test::TempFolder folder;
    const std::string file = folder.file("state.json");
    Viewer viewer;
    viewer.run("save-state " + file);
    auto state = nlohmann::ordered_json::parse(std::ifstream(file));
    state["settings"]["lights"] = "7:::1,1,1";
    std::ofstream(file) << state;
    viewer.run("open builtin:door");
    viewer.waitForScene();
    viewer.run("lights=0:::60,30,10; exposure=3; wait-still; load-state " + file);
    viewer.waitForScene();
    for (int i = 0; i < 20 && viewer.model().error.empty(); ++i) viewer.frames(1);
    EXPECT_NE(viewer.model().error.find("no light 7"), std::string::npos) << viewer.model().error;
    viewer.run("key Escape; wait 3");
    EXPECT_EQ(viewer.model().error, "");
    EXPECT_EQ(viewer.model().sceneName, "builtin:cornell");
    EXPECT_EQ(viewer.settings().scene.lights, "");
    EXPECT_NE(viewer.settings().display.exposureEv, 3);
}

TEST_F(Opening, AStateOfALongerAnimationStandsAtItsTime) {
    const test::TempFolder folder;
    const std::string file = folder.file("state.json");
    Viewer viewer;
    viewer.run("open builtin:cathedral");
    viewer.waitForScene();
    viewer.run("time 20; wait 2; save-state " + file + "; open builtin:cornell");
    viewer.waitForScene();
    viewer.run("wait 2; load-state " + file);
    viewer.waitForScene();
    viewer.frames(2);
    EXPECT_EQ(viewer.model().timeS, 20);
}

TEST_F(Opening, TheNextCameraIsThatAfterTheOneInUse) {
    Viewer viewer;
    viewer.run("open builtin:atrium");
    viewer.waitForScene();
    viewer.run("camera=1; wait 2; next-camera; wait 2");
    EXPECT_EQ(viewer.settings().camera.name, "2");
    viewer.run("previous-camera; wait 2");
    EXPECT_EQ(viewer.settings().camera.name, "1");
}

TEST_F(Opening, ALightThatCannotStandThereIsRefusedWhileRenderingIsPaused) {
    Viewer viewer(1200, 900);
    viewer.run(
        "pause-rendering; wait 2; click @group:Lights; wait 3; "
        "double-click @light.0.position; wait 2; type 1e13; wait 1; key Enter; wait 2");
    const auto failure = viewer.session->takeFailure();
    ASSERT_TRUE(failure);
    EXPECT_NE(std::string(failure->what()).find("1e12"), std::string::npos) << failure->what();
    EXPECT_EQ(viewer.settings().scene.lights, "");
}

}  // namespace
}  // namespace mv
