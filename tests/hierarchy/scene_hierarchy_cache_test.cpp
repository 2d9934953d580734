#include "megaviews/hierarchy/scene_hierarchy_cache.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>

#include "hierarchy/test_scenes.h"

namespace mv {
namespace {

namespace fs = std::filesystem;

bool sameTree(const SceneHierarchy& a, const SceneHierarchy& b) {
    const auto same = [](const auto& x, const auto& y) {
        return x.size() == y.size() &&
               (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
    };
    return a.levels == b.levels && same(a.nodes, b.nodes) && same(a.mortonKeys, b.mortonKeys) &&
           same(a.levelBegin, b.levelBegin) && same(a.areas, b.areas);
}

class SceneHierarchyCache : public ::testing::Test {
  protected:
    void SetUp() override {
        directory_ = fs::path(::testing::TempDir()) /
                     ("octree_cache_" + std::to_string(::getpid()) + "_" +
                      ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(directory_);
        scene_ = test::randomTriangles(50, 1);
        bvh_ = TriangleBvh::build(scene_);
    }
    void TearDown() override { fs::remove_all(directory_); }

    SceneHierarchy load() { return buildOrLoad(scene_, bvh_, 6, directory_); }
    // Whether the last call voxelised, told by its progress.
    bool builds() {
        bool built = false;
        const SceneHierarchy h =
            buildOrLoad(scene_, bvh_, 6, directory_,
                        [&](std::string_view stage, float) { built |= stage == "voxelise"; });
        EXPECT_TRUE(sameTree(h, SceneHierarchy::build(scene_, bvh_, 6)));
        return built;
    }
    fs::path file() const { return cacheFile(directory_, cacheKey(scene_, bvh_, 6)); }

    fs::path directory_;
    Scene scene_;
    TriangleBvh bvh_;
};

TEST_F(SceneHierarchyCache, isReadBackByte) {
    EXPECT_TRUE(builds());
    ASSERT_TRUE(fs::exists(file()));
    EXPECT_FALSE(builds());
    // Nothing but the file itself is left.
    EXPECT_EQ(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()), 1);
}

TEST_F(SceneHierarchyCache, emptyDirectoryMeansNoCache) {
    buildOrLoad(scene_, bvh_, 6, {});
    EXPECT_FALSE(fs::exists(directory_));
    Scene empty;
    empty.materials.emplace_back();
    EXPECT_EQ(buildOrLoad(empty, TriangleBvh::build(empty), 6, directory_).levels, 0);
}

TEST_F(SceneHierarchyCache, anyChangeOfWhatIsVoxelisedHasItsOwnFile) {
    const std::string key = cacheKey(scene_, bvh_, 6);
    EXPECT_EQ(cacheKey(scene_, bvh_, 6), key);
    EXPECT_NE(cacheKey(scene_, bvh_, 7), key);
    const auto keyAfter = [&](auto change) {
        Scene changed = scene_;
        change(changed);
        return cacheKey(changed, TriangleBvh::build(changed), 6);
    };
    EXPECT_EQ(keyAfter([](Scene& s) { s.name = "other"; }), key);
    EXPECT_NE(keyAfter([](Scene& s) { s.positions.back().x += 1e-6f; }), key);
    EXPECT_NE(keyAfter([](Scene& s) { s.normals.front() = -s.normals.front(); }), key);
    EXPECT_NE(keyAfter([](Scene& s) { s.materials[0].baseColor.g = 0.5f; }), key);
    EXPECT_NE(keyAfter([](Scene& s) { s.materials[0].doubleSided = true; }), key);
    EXPECT_NE(keyAfter([](Scene& s) { s.triangles.pop_back(), s.triangleMaterials.pop_back(); }),
              key);
    EXPECT_NE(keyAfter([](Scene& s) { s.colors.assign(s.positions.size(), glm::vec4(0.5f)); }),
              key);
}

TEST_F(SceneHierarchyCache, damagedFilesAreBuiltAnewAndReplaced) {
    load();
    const auto size = fs::file_size(file());
    const auto expectRebuilt = [&](const char* what) {
        EXPECT_TRUE(builds()) << what;
        EXPECT_FALSE(builds()) << what;
        EXPECT_EQ(fs::file_size(file()), size) << what;
    };
    for (const std::uintmax_t cut : {std::uintmax_t{0}, std::uintmax_t{20}, size / 2, size - 1}) {
        fs::resize_file(file(), cut);
        expectRebuilt("cut off");
    }
    fs::resize_file(file(), size + 1);
    expectRebuilt("too long");
    // One byte, anywhere: header, levels, nodes, keys, areas.
    for (std::uintmax_t at = 3; at < size; at += size / 23) {
        std::fstream f(file(), std::ios::in | std::ios::out | std::ios::binary);
        f.seekg(static_cast<std::streamoff>(at));
        const char old = static_cast<char>(f.get());
        f.seekp(static_cast<std::streamoff>(at));
        f.put(static_cast<char>(old ^ 0x10));
        f.close();
        expectRebuilt("one bit flipped");
    }
}

TEST_F(SceneHierarchyCache, folderThatCannotBeWrittenIsNoError) {
    { std::ofstream(directory_) << "a file where the folder should be"; }
    EXPECT_TRUE(builds());
    EXPECT_TRUE(builds());
    fs::remove(directory_);
    directory_ = "/proc/no-such-place";
    EXPECT_TRUE(builds());
}

TEST_F(SceneHierarchyCache, oldestFilesMakeRoom) {
    fs::create_directories(directory_);
    const auto now = fs::file_time_type::clock::now();
    const auto make = [&](const std::string& name, int ageHours) {
        const fs::path path = directory_ / name;
        std::ofstream(path) << std::string(1000, 'x');
        fs::last_write_time(path, now - std::chrono::hours(ageHours));
        return path;
    };
    const fs::path oldest = make("a.octree", 50), older = make("b.octree", 40);
    const fs::path newer = make("c.octree", 1), foreign = make("notes.txt", 100);
    const fs::path growing = make(".megaviews-1-0.part", 0), left = make(".megaviews-2-0.part", 60);
    trimCache(directory_, 3000, newer);
    EXPECT_FALSE(fs::exists(left));
    EXPECT_TRUE(fs::exists(oldest));
    trimCache(directory_, 2000, newer);
    EXPECT_FALSE(fs::exists(oldest));
    EXPECT_TRUE(fs::exists(older));
    trimCache(directory_, 0, newer);
    EXPECT_FALSE(fs::exists(older));
    for (const fs::path& kept : {newer, foreign, growing}) EXPECT_TRUE(fs::exists(kept)) << kept;
}

TEST_F(SceneHierarchyCache, beingReadMakesAFileYoung) {
    load();
    const auto longAgo = fs::file_time_type::clock::now() - std::chrono::hours(100);
    fs::last_write_time(file(), longAgo);
    load();
    EXPECT_GT(fs::last_write_time(file()), longAgo + std::chrono::hours(99));
}

TEST(DefaultCacheDirectory, followsTheEnvironment) {
    const auto with = [](const char* xdg, const char* home) {
        xdg ? setenv("XDG_CACHE_HOME", xdg, 1) : unsetenv("XDG_CACHE_HOME");
        home ? setenv("HOME", home, 1) : unsetenv("HOME");
        return defaultCacheDirectory();
    };
    const char* home = std::getenv("HOME");
    const std::string oldHome = home ? home : "";
    EXPECT_EQ(with("/x/cache", "/h"), fs::path("/x/cache/megaviews"));
    EXPECT_EQ(with(nullptr, "/h"), fs::path("/h/.cache/megaviews"));
    EXPECT_EQ(with("relative", "/h"), fs::path("/h/.cache/megaviews"));
    EXPECT_EQ(with(nullptr, nullptr), fs::path());
    if (home) setenv("HOME", oldHome.c_str(), 1);
}

}  // namespace
}  // namespace mv
