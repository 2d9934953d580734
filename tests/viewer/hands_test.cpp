// What hands do that are new to the window: drags and keys in every place, dialogs, wrong clicks.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>

#include <glm/glm.hpp>

#include "app/common/scene_assets.h"
#include "app/temp_folder.h"
#include "app/viewer/camera_rig.h"
#include "megaviews/scene/framing_probe.h"
#include "megaviews/views/frame_camera.h"
#include "scene/gltf_builder.h"
#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

class HandsTest : public ViewerTest {};

// ---- the camera

struct Journey {
    std::shared_ptr<const SceneAssets> assets;
    CameraRig rig;
    Settings settings;

    explicit Journey(const std::string& scene) {
        settings.scene.octreeDepth = 3;
        assets = loadAssetsWithoutHierarchy(scene, settings, {});
        rig.setScene(assets);
        rig.reset(settings, 0);
    }
    void drag(MouseButton button, double dx, double dy) {
        for (const InputEvent& event : std::initializer_list<InputEvent>{
                 MouseMoved{500, 300}, MouseButtonChanged{button, true},
                 MouseMoved{500 + dx, 300 + dy}}) {
            rig.input().handle(event, false);
        }
        move();
        rig.input().handle(MouseButtonChanged{button, false}, false);
        move();
    }
    void scroll(double steps) {
        rig.input().handle(Scrolled{0, steps}, false);
        move();
    }
    void move(bool keysFree = true) { rig.update(settings, 0, false, 1.0 / 30, 600, keysFree); }
    glm::vec3 eye() const { return rig.camera().position; }
    // Through the backs of what has only a front, as pictures do.
    bool sees(const PickRay& ray) const {
        auto hit = assets->bvh.intersect(ray.origin, ray.direction, 0, 100);
        while (hit && assets->bvh.isBack(*hit, ray.direction)) {
            hit = assets->bvh.intersect(ray.origin, ray.direction, hit->t, 100);
        }
        return hit.has_value();
    }
    // Of a picture of 16:9.
    float shareInSight() const {
        int seen = 0;
        for (int i = 0; i < 32 * 18; ++i) {
            const auto x = static_cast<float>(i % 32), y = static_cast<float>(i / 32);
            seen += sees(rayThrough(rig.camera(), 32, 18, x + 0.5f, y + 0.5f, 0));
        }
        return static_cast<float>(seen) / (32 * 18);
    }
    struct Around {
        float clearance = 100;  // root-cube units
        float backs = 0;        // share of all directions in which a surface turns its back
    };
    Around around() const {
        Around found;
        const auto directions = framing::sphereDirections(200);
        for (const glm::vec3 d : directions) {
            const auto hit = assets->bvh.intersect(eye(), d, 0, 100);
            if (!hit) continue;
            found.clearance = std::min(found.clearance, hit->t);
            found.backs += assets->bvh.isBack(*hit, d) ? 1.0f / 200 : 0.0f;
        }
        return found;
    }
};

// A lit square with a front only, in a file without camera or light.
std::string openScene(const test::TempFolder& folder) {
    const testing::Bytes bytes = testing::GltfBuilder::square().glb();
    return folder.write("square.glb", {bytes.begin(), bytes.end()});
}

class RandomDrags : public ::testing::TestWithParam<const char*> {};

// Looks, orbits, pans and steps of every size: never through a wall nor close to one, never behind
// the walls of a room, never without the scene.
TEST_P(RandomDrags, StayWhereTheyCanBe) {
    const test::TempFolder folder;
    Journey journey(GetParam() == std::string("square") ? openScene(folder) : GetParam());
    const bool room = journey.around().backs == 0 && journey.shareInSight() > 0.9f;
    const glm::vec3 start = journey.eye();
    const float least = 0.08f * journey.shareInSight();  // a fifth of a picture that is a square
    std::mt19937 random(11);
    std::uniform_real_distribution<double> pixels(10, 300), turn(0, 6.2832);
    int moved = 0;
    float farthest = 0;
    constexpr int kDrags = 1000;
    for (int i = 0; i < kDrags; ++i) {
        const FrameCamera before = journey.rig.camera();
        const double length = pixels(random), angle = turn(random);
        if (i % 4 == 3) {
            journey.scroll(std::copysign(length / 50, angle - 3.1416));
        } else {
            journey.drag(static_cast<MouseButton>(i % 4), length * std::cos(angle),
                         length * std::sin(angle));
        }
        const glm::vec3 way = journey.eye() - before.position;
        if (const float distance = glm::length(way); distance > 0) {
            EXPECT_FALSE(
                journey.assets->bvh.intersect(before.position, way / distance, 0, distance))
                << "drag " << i;
        }
        ASSERT_FALSE(journey.rig.isOutside()) << "drag " << i;
        ASSERT_GT(journey.shareInSight(), least) << "drag " << i;
        const Journey::Around around = journey.around();
        ASSERT_GT(around.clearance, 0.001f) << "drag " << i;
        if (room) {
            ASSERT_LT(around.backs, 0.25f) << "drag " << i;
        }
        moved += !(journey.rig.camera() == before);
        farthest = std::max(farthest, glm::length(journey.eye() - start));
    }
    EXPECT_GT(farthest, 0.02f) << "it does move";
    EXPECT_GT(moved, kDrags * 6 / 10);
}
INSTANTIATE_TEST_SUITE_P(Camera, RandomDrags,
                         ::testing::Values("builtin:atrium", "builtin:cathedral", "builtin:cornell",
                                           "builtin:door", "builtin:hairball", "square"),
                         [](const auto& of) {
                             const std::string name = of.param;
                             return name.substr(name.find(':') + 1);
                         });

TEST(Camera, PansAndStepsBackOnlyWhileTheSceneIsInSight) {
    const test::TempFolder folder;
    for (const std::string& scene : {std::string("builtin:cornell"), openScene(folder)}) {
        for (int side = 0; side < 9; ++side) {
            Journey journey(scene);
            const glm::vec3 start = journey.eye();
            const float least = 0.08f * journey.shareInSight();
            for (int i = 0; i < 40; ++i) {
                if (side == 8) {
                    journey.scroll(-3);
                } else {
                    journey.drag(MouseButton::middle, 90 * std::cos(side * 0.785),
                                 90 * std::sin(side * 0.785));
                }
                ASSERT_GT(journey.shareInSight(), least) << scene << " " << side << " " << i;
            }
            EXPECT_GT(glm::length(journey.eye() - start), 0.1f) << scene << " " << side;
        }
    }
}

// Steps that a wall stops do not make those after them small.
TEST(Camera, StepsBackFromAWallAsFastAsItCame) {
    Journey journey("builtin:cathedral");
    journey.drag(MouseButton::left, 314, 0);  // to the aisle
    for (int i = 0; i < 40; ++i) journey.scroll(2);
    const glm::vec3 stood = journey.eye();
    journey.scroll(-2);
    EXPECT_GT(glm::length(journey.eye() - stood), 0.01f);
}

TEST(Camera, LeavesABoxThatItEntered) {
    Journey journey("builtin:cornell");
    const glm::vec3 start = journey.eye();
    for (int i = 0; i < 10; ++i) journey.scroll(2);
    EXPECT_GT(journey.shareInSight(), 0.99f) << "inside of it";
    for (int i = 0; i < 10; ++i) journey.scroll(-2);
    EXPECT_LT(glm::length(journey.eye() - start), 0.01f);
}

TEST(Camera, OrbitsFromOutsideAndLooksAroundInARoom) {
    Journey room("builtin:cathedral");
    const glm::vec3 stood = room.rig.camera().position;
    room.drag(MouseButton::left, 200, 0);
    EXPECT_EQ(room.rig.camera().position, stood);
    Journey outside("builtin:cornell");
    const FrameCamera before = outside.rig.camera();
    outside.drag(MouseButton::left, 200, 0);
    EXPECT_GT(glm::length(outside.rig.camera().position - before.position), 0.05f);
}

TEST(Camera, FramesARoomFromWithin) {
    for (const char* scene : {"builtin:atrium", "builtin:cathedral"}) {
        Journey room(scene);
        for (int i = 0; i < 8; ++i) {
            room.drag(MouseButton::left, 157, i % 2 ? 40 : -40);  // an eighth of a turn
            const glm::vec3 before = room.rig.camera().position;
            room.rig.frameScene(room.settings);
            EXPECT_FALSE(room.rig.isOutside()) << scene << " " << i;
            const glm::vec3 step = room.rig.camera().position - before;
            EXPECT_LE(glm::dot(step, room.rig.camera().forward), 1e-5f) << "back, if at all";
        }
    }
}

TEST(Camera, FliesByKeysAloneAndThroughWallsIfAsked) {
    Journey journey("builtin:cathedral");
    const glm::vec3 start = journey.rig.camera().position;
    const auto key = [&](bool down, int modifiers) {
        journey.rig.input().handle(KeyChanged{'W', modifiers, down}, false);
    };
    key(true, 0);
    journey.move(false);
    EXPECT_EQ(journey.rig.camera().position, start) << "the keyboard is a panel's";
    for (int i = 0; i < 600 && !journey.rig.isOutside(); ++i) journey.move();
    key(false, 0);
    EXPECT_TRUE(journey.rig.isOutside());
    journey.rig.reset(journey.settings, 0);
    EXPECT_FALSE(journey.rig.isOutside());
}

TEST_F(HandsTest, DragsShowNoBlackPicture) {
    Settings settings = Viewer::smallSettings();
    settings.views.vpls = 256;
    Viewer viewer(480, 320, settings, "builtin:atrium");
    viewer.run("hide-panels; wait-still");
    std::mt19937 random(5);
    for (int i = 0; i < 15; ++i) {
        const auto share = [&] { return std::to_string(10 + random() % 80) + "%"; };
        viewer.run("drag " + share() + "," + share() + " " + share() + "," + share() + "; wait 2");
        double sum = 0;
        const auto bytes = viewer.pixels();
        for (std::size_t p = 0; p < bytes.size(); ++p) sum += p % 4 == 3 ? 0 : bytes[p];
        EXPECT_GT(sum / static_cast<double>(bytes.size()), 8) << "after drag " << i;
    }
}

// ---- keys and dialogs

TEST_F(HandsTest, KeysAreTheDialogsWhileOneIsOpen) {
    Viewer viewer;
    const Settings before = viewer.settings();
    viewer.run("open; wait 2; click @panel:browser; key B; key P; key M; key N; key ]; wait 1");
    EXPECT_EQ(viewer.settings(), before);
    EXPECT_FALSE(viewer.model().instrument);
    EXPECT_EQ(viewer.model().browse, ui::Browse::open);
    viewer.run("key Escape; wait 2; drop no-such-file.glb; wait 2; key B; key P; wait 1");
    EXPECT_EQ(viewer.settings(), before);
    EXPECT_FALSE(viewer.model().instrument);
    viewer.run("key Escape; wait 2; key P; wait 1");
    EXPECT_EQ(viewer.model().instrument, ui::Instrument::profiler) << "and act again after it";
}

TEST_F(HandsTest, ArrowsInAMenuAreTheMenus) {
    Viewer viewer;
    viewer.run("click @menu:File; key Down; key Down; key Up; wait 1");
    EXPECT_EQ(viewer.model().speed, 1);
}

TEST_F(HandsTest, CommandsAreFoundByAPartOfTheirName) {
    Viewer viewer;
    viewer.run("key Ctrl+K; wait 2; type memo; wait 1; key Enter; wait 2");
    EXPECT_EQ(viewer.model().instrument, ui::Instrument::memory);
    EXPECT_FALSE(viewer.model().palette);
    viewer.run(
        "key Ctrl+K; wait 2; type instruments; wait 1; key Down; key Down; wait 1; "
        "key Enter; wait 2");
    EXPECT_FALSE(viewer.model().instrument) << "the third is memory again";
    viewer.run("key Ctrl+K; wait 2; type exposure; wait 1; key Escape; wait 2");
    EXPECT_FALSE(viewer.model().palette);
    viewer.run("key Ctrl+K; wait 2; type side by; wait 1; key Enter; wait 2");
    EXPECT_TRUE(viewer.settings().compare);
}

TEST_F(HandsTest, TheFileDialogIsUsedByTheKeyboardAndKeepsItsFolder) {
    const test::TempFolder folder;
    folder.write("inner/one.json", "{}");
    folder.write("inner/second.json", "{}");
    Viewer viewer;
    viewer.run("open; wait 2; type " + folder.file("inner") + "; wait 1; key Enter; wait 2");
    EXPECT_EQ(viewer.model().browseFolder,
              std::filesystem::canonical(folder.file("inner")).string());
    viewer.run("key Escape; wait 2; open; wait 2");
    EXPECT_EQ(viewer.model().browseFolder,
              std::filesystem::canonical(folder.file("inner")).string());
    // The second of the list; it is no state, and the error names it.
    viewer.run("key Down; key Down; wait 1; key Enter; wait 3");
    EXPECT_NE(viewer.model().error.find("second.json"), std::string::npos) << viewer.model().error;
    viewer.run(
        "key Escape; wait 2; open; wait 2; type on; wait 1; key Tab; wait 1; key Enter; "
        "wait 3");
    EXPECT_NE(viewer.model().error.find("one.json"), std::string::npos) << viewer.model().error;
}

// ---- what the window says

TEST_F(HandsTest, TheOtherSideIsTheOneThatIsNamed) {
    Viewer viewer(640, 400);
    viewer.run("compare=none; hide-panels; wait-still");
    const auto shownAt = [&](const char* split) {
        viewer.run(std::string("split=") + split + "; wait-still; wait 2");
        return viewer.pictureHash();
    };
    const auto left = shownAt("1"), right = shownAt("0");
    ASSERT_NE(left, right);
    EXPECT_EQ(Settings().display.smallerSide(), 0) << "of halves it is the left one";
    for (const auto& [split, smaller] : {std::pair{"0.3", 0}, std::pair{"0.7", 1}}) {
        viewer.run(std::string("split=") + split + "; wait-still; show-other-side; wait-still");
        EXPECT_EQ(viewer.settings().display.smallerSide(), smaller);
        EXPECT_EQ(viewer.pictureHash(), smaller == 0 ? left : right);
        viewer.run("show-other-side; wait 1");
    }
    // With a difference too it is one side and one label.
    viewer.run("hide-panels; difference=absolute; show-other-side; wait-still; wait 2");
    EXPECT_TRUE(viewer.session->interface().findItem("plate:held"));
    EXPECT_FALSE(viewer.session->interface().findItem("plate:label-left"));
}

TEST_F(HandsTest, ResetAllGivesTheDefaultsAndSaysSo) {
    Viewer viewer;
    viewer.options.given.clear();
    viewer.session.reset();
    viewer.session = std::make_unique<Session>(viewer.options, Settings(), viewer.screen, 1, "");
    viewer.run("wait-loading; pause-rendering; wait 2");
    EXPECT_EQ(viewer.model().preset, "defaults");
    viewer.run("vpls=32; accumulate=3; wait 2");
    EXPECT_EQ(viewer.model().preset, "");
    EXPECT_TRUE(viewer.model().canUndo);
    EXPECT_FALSE(viewer.model().canRedo);
    viewer.run("reset-all-settings; wait 2");
    EXPECT_EQ(viewer.model().preset, "defaults");
    viewer.run("undo; wait 2");
    EXPECT_EQ(viewer.settings().views.vpls, 32);
    EXPECT_TRUE(viewer.model().canRedo);
}

TEST_F(HandsTest, AStateOfTheSceneOnScreenIsAChangeLikeOthers) {
    const test::TempFolder folder;
    Viewer viewer;
    viewer.run("wait 2; save-state \"" + folder.file("s.json") + "\"; wait 2; vpls=16; wait 2");
    viewer.run("load-state \"" + folder.file("s.json") + "\"; wait-loading; wait 2");
    EXPECT_NE(viewer.settings().views.vpls, 16);
    viewer.run("undo; wait 2; expect vpls=16; redo; wait 2; expect vpls!=16");
}

// What could not come into effect is no step: undo leads past it.
TEST_F(HandsTest, AChangeThatFailedOrWasGivenUpIsNoStep) {
    for (const char* change :
         {"views=nofile.ply; wait-loading; wait 2; key Escape",
          "scene-depth=11; wait 1; key Escape", "method=pathtraced; wait 2; key Escape"}) {
        SCOPED_TRACE(change);
        Settings settings = Viewer::smallSettings();
        settings.side[0].referenceSamples = 65536;  // not done before it is given up
        Viewer viewer(640, 400, settings);
        viewer.run("wait-still; vpls=32; wait-still");
        viewer.run(std::string(change) + "; wait-still");
        EXPECT_EQ(viewer.settings().views.vpls, 32);
        viewer.run("undo; wait-loading; wait-still; expect vpls=64; expect method=megaviews");
        EXPECT_EQ(viewer.model().error, "");
    }
}

TEST_F(HandsTest, AChangeTakenBackLeavesTheExposure) {
    Viewer viewer;
    viewer.run("wait-still");
    const double before = viewer.session->statistics().exposureEv;
    viewer.run(
        "scene-depth=3; wait-loading; vpls=16; wait-still; undo; undo; wait-loading; "
        "wait-still");
    EXPECT_EQ(viewer.session->statistics().exposureEv, before);
}

// A corner is darker than the room was, by as much as the light was turned down.
TEST_F(HandsTest, WhereTheCameraRestsThePictureIsNotBlack) {
    Viewer viewer;
    const auto exposure = [&] { return viewer.session->statistics().exposureEv; };
    viewer.run("wait-still");
    const double before = exposure();
    viewer.run("light-scale=0.4; wait-still; drag 30%,50% 31%,50%; wait-still");
    EXPECT_EQ(exposure(), before) << "little darker";
    viewer.run("light-scale=0.01; wait-still");
    EXPECT_EQ(exposure(), before) << "who turns lights down sees them turned down";
    viewer.run("drag 31%,50% 30%,50%; wait-still");
    EXPECT_NEAR(exposure(), before + std::log2(100), 0.5);
    const double dark = exposure();
    viewer.run("light-scale=0; drag 30%,50% 31%,50%; wait-still");
    EXPECT_EQ(exposure(), dark) << "nothing to fit it to";
    viewer.run("light-scale=1; exposure=2; drag 31%,50% 30%,50%; wait-still");
    EXPECT_EQ(exposure(), 2) << "a hand set it";
}

TEST_F(HandsTest, TheBuiltInScenesAreInTheMenu) {
    Viewer viewer;
    viewer.run(
        "click @menu:File; wait 2; move @menu:Scenes; wait 2; "
        "click @open:builtin:hairball; wait-loading; wait 2");
    EXPECT_EQ(viewer.model().sceneName, "builtin:hairball");
}

// A dropped image lights the scene on screen; what cannot be read leaves all as it was.
TEST_F(HandsTest, TheSkyIsChosenDroppedAndTakenBack) {
    const test::TempFolder folder;
    std::string white = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n";
    for (int i = 0; i < 32; ++i) white += "\x80\x80\x80\x81";
    const std::string image = folder.write("white.hdr", white);
    const std::string broken = folder.write("a.hdr", "no picture");
    Viewer viewer;
    const auto source = [&] { return viewer.settings().scene.environment.source; };
    const auto light = [&] {
        return viewer.session->picture().renderer().radiance().readFloats(4);
    };
    viewer.run("wait-still");
    const std::vector<float> before = light();
    viewer.run("click @environment; wait 2; click @environment=white; wait-still");
    EXPECT_EQ(source(), "white");
    EXPECT_NE(light(), before);
    viewer.run("drop " + image + "; wait-still");
    EXPECT_EQ(source(), image);
    EXPECT_EQ(viewer.model().sceneName, "builtin:cornell");
    const std::vector<float> lit = light();
    EXPECT_NE(lit, before);
    viewer.run("drop " + broken + "; wait 2");
    EXPECT_NE(viewer.model().error.find("a.hdr"), std::string::npos) << viewer.model().error;
    EXPECT_EQ(source(), image);
    viewer.run("key Escape; wait-still");
    EXPECT_EQ(light(), lit);
    viewer.run("undo; wait-still; undo; wait-still");
    EXPECT_EQ(source(), "auto");
    EXPECT_EQ(light(), before);
}

TEST_F(HandsTest, LightsAreColouredDimmedAndPutOut) {
    Viewer viewer(640, 1200);
    viewer.run("click @group:Lights; wait 2; click @light.0.on; wait 2");
    EXPECT_EQ(viewer.settings().scene.lights, "0:::0,0,0");
    ASSERT_EQ(viewer.model().lights.size(), 1u);
    EXPECT_EQ(viewer.model().lights[0].intensity, (std::array<double, 3>{0, 0, 0}));
    viewer.run("wait-still");
    const auto dark = viewer.pictureHash();
    viewer.run("click @light.0.on; wait 2");
    EXPECT_EQ(viewer.settings().scene.lights, "");
    viewer.run("wait-still");
    EXPECT_NE(viewer.pictureHash(), dark);
    const double before = viewer.model().lights[0].intensity[0];
    viewer.run("drag @light.0.intensity by 60,0; wait 2");
    EXPECT_GT(viewer.model().lights[0].intensity[0], before);
    EXPECT_TRUE(viewer.model().lights[0].edited);
}

TEST_F(HandsTest, TheCameraIsReadInNumbers) {
    Viewer viewer;
    viewer.run("move 30%,50%; scroll 2; wait 2");
    ASSERT_TRUE(viewer.model().camera.position);
    const auto state = viewer.session->state();
    EXPECT_EQ(viewer.model().camera.position, state.settings.camera.position);
}

TEST_F(HandsTest, NumbersAreThoseOfTheFrame) {
    Viewer viewer;
    viewer.run("compare=manylods; wait-still; wait 2");
    const auto json = viewer.session->numbers();
    const FrameStatistics& shown = viewer.session->statistics();
    EXPECT_EQ(json["frames"]["partial"], false);
    EXPECT_EQ(json["draft"], false);
    EXPECT_EQ(json["views"]["alive"], shown.viewsAlive);
    for (std::size_t side = 0; side < 2; ++side) {
        const MethodStatistics& m = shown.methods[side];
        EXPECT_EQ(json["methods"][side]["pairs"]["processed"], m.pairs.processed);
    }
}

TEST_F(HandsTest, TheTourShowsFiveStepsAndBringsBackWhatStood) {
    Viewer viewer(800, 480);
    viewer.run("vpls=48; wait 2; tour; wait-loading; click @tour.leave; wait-loading; wait 2");
    viewer.run("expect exposure=auto; expect camera-position=auto");
    viewer.run("move 30%,50%; scroll 2; wait 2");
    const State before = viewer.session->state();
    viewer.run("pause-rendering; tour; wait-loading; wait 12");
    ASSERT_TRUE(viewer.model().tour);
    EXPECT_EQ(viewer.model().sceneName, "builtin:atrium");
    EXPECT_TRUE(viewer.settings().inspect.showViews);
    // What it drives is seen in settings and instruments: one picture is enough.
    viewer.run("click @tour.next; wait 30");
    EXPECT_EQ(viewer.model().instrument, ui::Instrument::views);
    EXPECT_TRUE(viewer.settings().inspect.pickA);
    viewer.run("click @tour.next; wait 60");
    EXPECT_TRUE(viewer.settings().inspect.pickB);
    EXPECT_EQ(viewer.settings().picture.view, DebugView::shared);
    viewer.run("click @tour.next; wait 10");
    EXPECT_EQ(viewer.settings().picture.view, DebugView::candidates);
    EXPECT_FALSE(viewer.model().instrument);
    viewer.run("click @tour.next; wait 10");
    EXPECT_EQ(viewer.settings().side[1].method, Method::exact);
    EXPECT_EQ(viewer.model().instrument, ui::Instrument::errors);
    EXPECT_FALSE(viewer.session->interface().findItem("tour.next"));
    viewer.run("click @tour.back; wait 10; click @tour.leave; wait-loading; wait 3");
    EXPECT_FALSE(viewer.model().tour);
    EXPECT_FALSE(viewer.model().instrument);
    EXPECT_EQ(viewer.session->state().scene, before.scene);
    EXPECT_EQ(viewer.settings().views.vpls, 48);
    EXPECT_EQ(viewer.session->state().settings.camera, before.settings.camera);
}

TEST_F(HandsTest, AResearcherMeasuresBothSidesAgainstAPictureThatWasKept) {
    const test::TempFolder folder;
    Viewer viewer;
    viewer.run(
        "method=exact; wait-still; keep-left-as-reference; wait 2; wait-still; wait 2; "
        "method=megaviews; "
        "compare=manylods; wait-still; wait 2");
    const auto& tables = viewer.model().errors.tables;
    ASSERT_EQ(tables.size(), 3u) << "right against left, and either against what was kept";
    for (std::size_t i = 1; i < 3; ++i) {
        EXPECT_EQ(tables[i].reason, "");
        EXPECT_NE(tables[i].against.find("kept"), std::string::npos);
        ASSERT_TRUE(tables[i].values[0].value);
        EXPECT_GT(*tables[i].values[0].value, 0);
    }
    EXPECT_EQ(viewer.session->numbers()["errors"].size(), 5u) << "and two of maps";
    // The same from a file; both sides under the pointer.
    viewer.session->savePicture(folder.file("left.exr"));
    viewer.run("load-reference; wait 2; type " + folder.file("left.exr") +
               "; wait 1; key Enter; wait-still; wait 2");
    EXPECT_NE(viewer.model().errors.tables[1].against.find("left.exr"), std::string::npos);
    viewer.run("pixel; wait 1; move 80%,60%; wait 2");
    ASSERT_TRUE(viewer.model().pixel.hover);
    EXPECT_TRUE(viewer.model().pixel.hover->sides);
}

TEST_F(HandsTest, AClickBesideTheViewsKeepsTheOneThatIsPicked) {
    Viewer viewer;
    viewer.run("views; pick-a=8; wait 2; click 60%,9%; wait 2");
    EXPECT_EQ(viewer.settings().inspect.pickA, 8);
}

TEST_F(HandsTest, StepsAreDrawnWhileTheirPanelIsOpen) {
    Viewer viewer;
    viewer.run("steps; step=3; wait-still; wait 2");
    const auto drawn = viewer.pictureHash();
    EXPECT_FALSE(viewer.model().legends.empty());
    EXPECT_EQ(viewer.model().legends[0].entries.back().label, "view nodes");
    viewer.run("steps; wait 2");
    EXPECT_TRUE(viewer.model().legends.empty());
    EXPECT_NE(viewer.pictureHash(), drawn);
    viewer.run("key .; wait 2");
    EXPECT_EQ(viewer.model().instrument, ui::Instrument::steps);
    EXPECT_EQ(viewer.settings().inspect.step, 4);
    viewer.run("step=32; wait 2");
    EXPECT_TRUE(viewer.model().steps.last);
    EXPECT_TRUE(viewer.model().steps.finished);
}

TEST_F(HandsTest, ADraftSaysWhatItIs) {
    Settings settings = Viewer::smallSettings();
    settings.side[0].maps.resolution = settings.side[1].maps.resolution = 16;
    Viewer viewer(640, 400, settings);
    viewer.options.given = {"scene-depth", "view-depth"};
    viewer.session.reset();
    viewer.session = std::make_unique<Session>(viewer.options, settings, viewer.screen, 1, "");
    viewer.waitForScene();
    viewer.run("wait-still");
    EXPECT_FALSE(viewer.model().draft);
    EXPECT_EQ(viewer.model().foreseenS, 0);
    viewer.session->editSettings().gather.samples = 16;
    viewer.frame();
    if (viewer.model().software) {
        ASSERT_TRUE(viewer.model().draft) << "while nothing plays, the whole picture follows it";
        EXPECT_GT(viewer.model().foreseenS, viewer.session->statistics().frameMs / 1000);
        viewer.frame();
        EXPECT_FALSE(viewer.model().draft);
        EXPECT_EQ(viewer.model().foreseenS, 0);
    }
    viewer.run("play-or-pause; wait 3");
    if (viewer.model().software) {
        ASSERT_TRUE(viewer.model().draft);
        EXPECT_EQ(viewer.model().draft->side[0].maps.resolution, 8);
    }
}

}  // namespace
}  // namespace mv
