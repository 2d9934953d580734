// Where to begin: every way from the start page leads somewhere.

#include <filesystem>
#include <fstream>

#include "app/temp_folder.h"
#include "app/viewer/start_page.h"
#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

class StartPageTest : public ViewerTest {};

TEST_F(StartPageTest, OpensABuiltInSceneThatHasAPicture) {
    Viewer viewer;
    viewer.run("start-page; wait 4");
    ASSERT_TRUE(viewer.model().start);
    EXPECT_GE(viewer.model().startTiles.size(), 4u);
    for (const ui::StartTile& tile : viewer.model().startTiles) {
        EXPECT_TRUE(tile.picture.texture) << tile.scene << " has no picture";
        EXPECT_TRUE(viewer.session->interface().findItem("start:" + tile.scene)) << tile.scene;
    }
    // Keys are the page's: P opens nothing behind it.
    viewer.run("key P; wait 1");
    EXPECT_FALSE(viewer.model().instrument);
    viewer.run("click @start:builtin:hairball; wait 2; wait-loading; wait 1");
    EXPECT_EQ(viewer.model().sceneName, "builtin:hairball");
    EXPECT_FALSE(viewer.model().start);
    EXPECT_TRUE(viewer.model().startTiles.empty()) << "a closed page holds nothing";
}

TEST_F(StartPageTest, GoesOnOpensAFileOrTakesTheTour) {
    Viewer viewer;
    viewer.run("start-page; wait 3; key Escape; wait 1");
    EXPECT_FALSE(viewer.model().start);
    viewer.run("start-page; wait 3; click @start.close; wait 1");
    EXPECT_FALSE(viewer.model().start);
    EXPECT_EQ(viewer.model().sceneName, "builtin:cornell");
    // The scene that is there is not loaded again.
    viewer.run("start-page; wait 3; click @start:builtin:cornell");
    EXPECT_FALSE(viewer.session->loading());
    viewer.run("start-page; wait 3; click @start.open; wait 2");
    EXPECT_EQ(viewer.model().browse, ui::Browse::open);
    viewer.run("key Escape; start-page; wait 3; click @start.tour; wait 3");
    EXPECT_TRUE(viewer.model().tour);
}

TEST(ScenesNear, AreAFewOfEachFolderThatIsNear) {
    const test::TempFolder folder;
    namespace fs = std::filesystem;
    const fs::path root = folder.file("");
    for (const char* name : {"a.glb", "b.gltf", "c.glb", "d.glb", "notes.txt", "one/x.glb",
                             "one/two/three/y.glb", "one/two/three/four/far.glb", ".git/z.glb"}) {
        fs::create_directories((root / name).parent_path());
        std::ofstream(root / name) << "x";
    }
    fs::create_directory_symlink(root, root / "one" / "again");
    std::vector<std::string> names;
    for (const std::string& file : scenesNear(root.string(), 10)) {
        names.push_back(fs::relative(file, root).string());
    }
    EXPECT_EQ(names, (std::vector<std::string>{"a.glb", "b.gltf", "c.glb", "one/two/three/y.glb",
                                               "one/x.glb"}));
    EXPECT_EQ(scenesNear(root.string(), 2).size(), 2u);
    EXPECT_TRUE(scenesNear((root / "nowhere").string(), 2).empty());
}

}  // namespace
}  // namespace mv
