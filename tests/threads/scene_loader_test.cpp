// Scenes are loaded on threads of their own; these tests need no OpenGL.

#include "app/viewer/scene_loader.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "megaviews/core/error.h"

namespace mv {
namespace {

Settings smallSettings() {
    Settings settings;
    settings.scene.octreeDepth = 4;
    return settings;
}

// What the viewer does between two frames; nullptr after a minute.
std::unique_ptr<SceneAssets> waitFor(SceneLoader& loader) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (std::chrono::steady_clock::now() < end) {
        const SceneLoader::Status status = loader.status();
        EXPECT_GE(status.fraction, 0) << status.stage;
        EXPECT_LE(status.fraction, 1) << status.stage;
        if (auto assets = loader.take()) return assets;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return nullptr;
}

void expectSame(const SceneAssets& assets, const SceneAssets& expected) {
    EXPECT_EQ(assets.scene.positions, expected.scene.positions);
    EXPECT_EQ(assets.hierarchy.mortonKeys, expected.hierarchy.mortonKeys);
    EXPECT_EQ(assets.hierarchy.levelBegin, expected.hierarchy.levelBegin);
}

TEST(SceneLoaderTest, LoadsWhatIsLoadedWithoutAThread) {
    SceneLoader loader;
    EXPECT_EQ(loader.take(), nullptr);
    loader.start("builtin:cornell", smallSettings(), {});
    EXPECT_TRUE(loader.loading());
    const auto assets = waitFor(loader);
    ASSERT_TRUE(assets);
    EXPECT_FALSE(loader.loading());
    expectSame(*assets, *loadAssets("builtin:cornell", smallSettings(), {}));
}

TEST(SceneLoaderTest, OnlyTheLastStartCounts) {
    SceneLoader loader;
    for (const char* scene : {"builtin:atrium", "builtin:no-such-scene", "builtin:cornell"})
        loader.start(scene, smallSettings(), {});
    EXPECT_EQ(loader.scene(), "builtin:cornell");
    const auto assets = waitFor(loader);
    ASSERT_TRUE(assets);
    expectSame(*assets, *loadAssets("builtin:cornell", smallSettings(), {}));
}

TEST(SceneLoaderTest, GivesUpOnCancelAndAtItsEnd) {
    SceneLoader loader;
    loader.start("builtin:cornell", smallSettings(), {});
    loader.cancel();
    EXPECT_FALSE(loader.loading());
    EXPECT_EQ(loader.take(), nullptr);
    loader.start("builtin:atrium", smallSettings(), {});
}

TEST(SceneLoaderTest, AFailureIsThrownOnce) {
    SceneLoader loader;
    loader.start("builtin:no-such-scene", smallSettings(), {});
    EXPECT_THROW(waitFor(loader), Error);
    EXPECT_FALSE(loader.loading());
    EXPECT_EQ(loader.take(), nullptr);
}

}  // namespace
}  // namespace mv
