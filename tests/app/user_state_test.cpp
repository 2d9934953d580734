// What the window remembers: where it is kept, what survives, and that nothing broken does harm.

#include "app/common/user_state.h"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "app/temp_folder.h"

namespace mv {
namespace {

using test::TempFolder;
using test::Variable;

TEST(UserState, LiesWhereXdgSays) {
    const Variable home("HOME", "/home/someone");
    {
        const Variable state("XDG_STATE_HOME", "/state");
        EXPECT_EQ(userStateFile(), "/state/megaviews/viewer.json");
    }
    for (const std::optional<std::string>& none :
         {std::optional<std::string>(), std::optional<std::string>(""),
          std::optional<std::string>("relative")}) {
        const Variable state("XDG_STATE_HOME", none);
        EXPECT_EQ(userStateFile(), "/home/someone/.local/state/megaviews/viewer.json");
        for (const std::optional<std::string>& homeless :
             {std::optional<std::string>(), std::optional<std::string>(""),
              std::optional<std::string>("there")}) {
            const Variable nowhere("HOME", homeless);
            EXPECT_EQ(userStateFile(), "");
        }
    }
}

TEST(UserState, ComesBackAsItWas) {
    const TempFolder folder;
    const std::string file = folder.file("deep/below/viewer.json");
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-1e3, 1e3);
    UserState kept;
    updateUserState(file, [&](UserState& state) {
        for (const char* name : {"/a.glb", "/b \"quoted\".glb", "builtin:atrium"}) {
            state.noteRecent(name);
        }
        for (int s = 0; s < 3; ++s) {
            SceneBookmarks& scene = state.bookmarksFor("/scene" + std::to_string(s), "hash");
            for (std::size_t i = 0; i < kBookmarks; i += 2) {
                Bookmark b{{place(random), place(random), place(random)},
                           {place(random), place(random), place(random)},
                           {0, 1, 0},
                           {}};
                if (i % 4 == 0) b.fovDeg = 60 + 1.0 / 3;
                scene.cameras[i] = b;
            }
        }
        state.window = WindowPlace{-20, 30, 1280, 720};
        state.uiScale = 1.5;
        state.panel = "profiler";
        kept = state;
    });
    EXPECT_EQ(loadUserState(file), kept);
    // Nothing lies beside it.
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.file("deep/below"))) {
        files += entry.is_regular_file();
    }
    EXPECT_EQ(files, 1u);

    // A change keeps everything else.
    updateUserState(file, [](UserState& state) { state.panel.clear(); });
    kept.panel.clear();
    EXPECT_EQ(loadUserState(file), kept);
}

TEST(UserState, TwoWindowsDoNotForgetForEachOther) {
    const TempFolder folder;
    const std::string file = folder.file("viewer.json");
    updateUserState(file, [](UserState& state) { state.noteRecent("/a.glb"); });
    updateUserState(file, [](UserState& state) { state.noteRecent("/b.glb"); });
    updateUserState(file, [](UserState& state) { state.uiScale = 2; });
    EXPECT_EQ(loadUserState(file).recent, (std::vector<std::string>{"/b.glb", "/a.glb"}));
    EXPECT_EQ(loadUserState(file).uiScale, 2);
}

TEST(UserState, RecentFilesAreTenOnceEachNewestFirst) {
    UserState state;
    state.noteRecent("");
    EXPECT_TRUE(state.recent.empty());
    for (int i = 0; i < 13; ++i) state.noteRecent("/" + std::to_string(i));
    ASSERT_EQ(state.recent.size(), kRecentFiles);
    EXPECT_EQ(state.recent.front(), "/12");
    EXPECT_EQ(state.recent.back(), "/3");
    state.noteRecent("/x/../5");
    ASSERT_EQ(state.recent.size(), kRecentFiles);
    EXPECT_EQ(state.recent.front(), "/5");
    EXPECT_EQ(std::count(state.recent.begin(), state.recent.end(), "/5"), 1);
    state.noteRecent("relative.glb");
    EXPECT_EQ(state.recent.front(), (std::filesystem::current_path() / "relative.glb").string());

    const TempFolder folder;
    EXPECT_TRUE(isThere(folder.write("scene.glb", "x")));
    EXPECT_FALSE(isThere(folder.file("gone.glb")));
    EXPECT_FALSE(isThere(folder.file("")));
    EXPECT_TRUE(isThere("builtin:atrium"));
}

TEST(UserState, BookmarksFollowTheirScene) {
    UserState state;
    const Bookmark b{{1, 2, 3}, {4, 5, 6}, {0, 1, 0}, 50};
    EXPECT_EQ(state.bookmarksOf("/a", "h1"), nullptr);
    state.bookmarksFor("/a", "h1").cameras[0] = b;
    state.bookmarksFor("builtin:atrium", "h2").cameras[8] = b;
    ASSERT_NE(state.bookmarksOf("/a", ""), nullptr);
    EXPECT_EQ(state.bookmarksOf("/a", "changed")->cameras[0], b);
    EXPECT_EQ(state.bookmarksOf("/x/../a", "")->cameras[0], b);
    EXPECT_EQ(state.bookmarksOf("/moved", "h1")->cameras[0], b);
    EXPECT_EQ(state.bookmarksOf("/other", ""), nullptr);
    EXPECT_EQ(state.bookmarksOf("builtin:atrium", "")->cameras[8], b);
    // The moved file takes its bookmarks along.
    state.bookmarksFor("/moved", "h1");
    EXPECT_EQ(state.bookmarks.size(), 2u);
    EXPECT_EQ(state.bookmarks.front().scene, "/moved");
    for (int i = 0; i < 200; ++i) state.bookmarksFor("/" + std::to_string(i), "");
    EXPECT_EQ(state.bookmarks.size(), kBookmarkedScenes);

    Settings settings;
    useBookmark(settings, b);
    EXPECT_EQ(settings.camera.fovDeg, 50);
    EXPECT_EQ(bookmarkOf(settings), b);
}

TEST(UserState, BrokenFilesAreIgnoredAndKeptAside) {
    const TempFolder folder;
    spdlog::set_level(spdlog::level::off);  // a warning for each of many
    const std::string good =
        R"({"schema": 1, "recent": ["/a"], "bookmarks": [], "panel": "memory"})";
    const std::string file = folder.write("viewer.json", good);
    EXPECT_EQ(loadUserState(file).recent, std::vector<std::string>{"/a"});
    const std::vector<std::string> broken = {
        "",
        "{",
        "[]",
        "3",
        "{}",
        R"({"schema": 2})",
        R"({"schema": 1, "schema": 1})",
        R"({"schema": 1, "recent": 3})",
        R"({"schema": 1, "recent": [3]})",
        R"({"schema": 1, "panel": 3})",
        R"({"schema": 1, "uiScale": 1e9})",
        R"({"schema": 1, "uiScale": "big"})",
        R"({"schema": 1, "window": {"x": 0, "y": 0, "width": 0, "height": 5}})",
        R"({"schema": 1, "window": {"x": 1e300, "y": 0, "width": 5, "height": 5}})",
        R"({"schema": 1, "window": [1, 2, 3, 4]})",
        R"({"schema": 1, "bookmarks": {"a": 1}})",
        R"({"schema": 1, "bookmarks": [{"scene": "/a"}]})",
        R"({"schema": 1, "bookmarks": [{"scene": "/a", "cameras": {"1": {}}}]})",
        R"({"schema": 1, "bookmarks": [{"scene": "/a", "cameras": {"1":
            {"position": [0, 0, 0], "target": [0, 0, 0], "up": [0, 1, 0]}}}]})",
        R"({"schema": 1, "bookmarks": [{"scene": "/a", "cameras": {"1":
            {"position": [0, 0], "target": [0, 0, 1], "up": [0, 1, 0]}}}]})",
        std::string(2 << 20, ' '),
    };
    for (const std::string& text : broken) {
        folder.write("viewer.json", text);
        EXPECT_EQ(loadUserState(file), UserState()) << text.substr(0, 200);
    }
    // Every prefix of a real file, too.
    for (std::size_t n = 0; n < good.size(); ++n) {
        folder.write("viewer.json", good.substr(0, n));
        EXPECT_EQ(loadUserState(file), UserState()) << n;
    }
    spdlog::set_level(spdlog::level::info);
    folder.write("viewer.json", "my own notes");
    updateUserState(file, [](UserState& state) { state.noteRecent("/b"); });
    EXPECT_EQ(loadUserState(file).recent, std::vector<std::string>{"/b"});
    EXPECT_EQ(folder.text("viewer.json.broken"), "my own notes");
}

TEST(UserState, AWrongValueIsSaidByItsKey) {
    const TempFolder folder;
    const std::vector<std::pair<std::string, std::string>> cases = {
        {R"("recent": 3)", "recent: 3 is not a list of files"},
        {R"("recent": [3])", "recent: 3 is not a text"},
        {R"("panel": ["views"])", "panel: [\"views\"] is not a text"},
        {R"("uiScale": "big")", "uiScale: \"big\" is not a number"},
        {R"("uiScale": null)", "uiScale: null is not a number"},
        {R"("window": [1, 2])", "window: [1,2] is not an object"},
        {R"("window": {"x": true, "y": 0, "width": 5, "height": 5})", "x: true is not a number"},
        {R"("window": {"x": 0})", "window: 'y' is missing"},
        {R"("bookmarks": {})", "bookmarks: {} is not a list"},
        {R"("bookmarks": [7])", "bookmarks: 7 is not an object"},
        {R"("bookmarks": [{"scene": "/a", "cameras": [1]}])", "cameras: [1] is not an object"},
        {R"("bookmarks": [{"scene": "/a", "cameras": {"1": {}}}])", "1: 'position' is missing"},
    };
    const auto before = spdlog::default_logger();
    for (const auto& [member, message] : cases) {
        const std::string file = folder.write("viewer.json", R"({"schema": 1, )" + member + "}");
        std::ostringstream log;
        spdlog::set_default_logger(std::make_shared<spdlog::logger>(
            "", std::make_shared<spdlog::sinks::ostream_sink_mt>(log)));
        EXPECT_EQ(loadUserState(file), UserState());
        spdlog::set_default_logger(before);
        EXPECT_NE(log.str().find(file + " is ignored: " + message + "\n"), std::string::npos)
            << log.str();
    }
}

TEST(UserState, WhatCannotBeKeptDoesNoHarm) {
    updateUserState("", [](UserState&) { FAIL() << "there is nothing to change"; });
    EXPECT_EQ(loadUserState(""), UserState());
    const TempFolder folder;
    folder.write("file", "x");
    updateUserState(folder.file("file/below/viewer.json"),
                    [](UserState& state) { state.noteRecent("/a"); });
    EXPECT_EQ(folder.text("file"), "x");
    // Names need not be UTF-8; the file stays readable.
    const std::string file = folder.file("viewer.json");
    updateUserState(file, [](UserState& state) {
        state.noteRecent("/\xff\xfe");
        state.noteRecent("/good");
    });
    EXPECT_EQ(loadUserState(file).recent.front(), "/good");
}

// A disk that fills up after so many bytes, for every number of them.
TEST(UserState, AFullDiskKeepsWhatWasKept) {
    const TempFolder folder;
    const std::string file = folder.file("viewer.json");
    updateUserState(file, [](UserState& state) { state.noteRecent("/a"); });
    const std::string before = folder.text("viewer.json");
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit unlimited{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &unlimited), 0);
    spdlog::set_level(spdlog::level::off);
    int kept = 0;
    for (rlim_t most = 0; folder.text("viewer.json") == before; ++most, ++kept) {
        ASSERT_LT(most, 2 * before.size());
        const rlimit limit{most, unlimited.rlim_max};
        ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
        updateUserState(file, [](UserState& state) { state.noteRecent("/b"); });
        ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &unlimited), 0);
    }
    spdlog::set_level(spdlog::level::info);
    EXPECT_GT(static_cast<std::size_t>(kept), before.size());
    EXPECT_EQ(loadUserState(file).recent, (std::vector<std::string>{"/b", "/a"}));
    for (const auto& entry : std::filesystem::directory_iterator(folder.file(""))) {
        EXPECT_EQ(entry.path().filename(), "viewer.json");
    }
}

}  // namespace
}  // namespace mv
