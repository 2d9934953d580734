// References as files: kept, found again, resumed, and told apart by all that they depend on.

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <utility>

#include "app/temp_folder.h"
#include "app/viewer/references.h"
#include "megaviews/core/error.h"
#include "megaviews/io/npy.h"
#include "megaviews/measure/reference_store.h"

namespace mv {
namespace {

namespace fs = std::filesystem;

class StoredReferenceTest : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        assets_ = loadAssetsWithoutHierarchy("builtin:cornell", Settings{});
    }
    static void TearDownTestSuite() { assets_.reset(); }

    void SetUp() override {
        settings.resolution.width = 9;
        settings.resolution.height = 6;
        settings.views.vpls = 100;
        settings.views.placement = Placement::traced;  // their name follows from settings alone
        settings.side[0].referenceSamples = 4;
        const Emitters emitters = makeEmitters(assets_->scene, assets_->bvh, {});
        views = traceVpls(assets_->bvh, emitters, {100, 2, 0}).views;
        for (int i = 0; i < 9 * 6; ++i) {
            const vec4 r = random4(1, static_cast<uint>(i), 0, 0);
            receivers.push_back({0.3f + 0.4f * vec3(r.x, r.y, r.z), sphereDirection(r.w, r.x)});
        }
    }
    ReferenceRequest request() const { return {settings, moment, views, receivers}; }
    std::vector<glm::vec3> make(const Progress& progress = {}) {
        References references(*assets_, fs::path(folder_.file("new")),
                              [this, progress](auto stage, float share) {
                                  if (stage != "ray hierarchy") ++reports;
                                  report(progress, stage, share);
                              });
        reports = 0;
        return references.irradiance(request());
    }
    fs::path file() const {
        return ReferenceStore(fs::path(folder_.file("new"))).fileFor(assets_->scene, request());
    }

    Settings settings;
    FrameMoment moment;
    std::vector<View> views;
    std::vector<Receiver> receivers;
    int reports = 0;
    test::TempFolder folder_;
    static inline std::unique_ptr<SceneAssets> assets_;
};

TEST_F(StoredReferenceTest, IsFoundAgain) {
    for (const Method method : {Method::exact, Method::pathtraced}) {
        settings.side[0].method = method;
        const auto made = make();
        EXPECT_GT(reports, 0);
        EXPECT_EQ(make(), made);
        EXPECT_EQ(reports, 0) << "made again";
        const std::string base = file().string();
        const NpyArray<float> array = readNpy<float>(base + ".npy");
        EXPECT_EQ(array.shape, (std::vector<std::uint64_t>{6, 9, 3}));
        EXPECT_EQ(array.elements[0], made[5 * 9].x);  // top row first
        EXPECT_TRUE(fs::exists(base + ".exr") && fs::exists(base + ".txt"));
        EXPECT_EQ(fs::exists(base + ".variance.npy"), method == Method::pathtraced);
    }
}

TEST_F(StoredReferenceTest, GoesOnWhereItWasInterrupted) {
    settings.side[0].method = Method::pathtraced;
    const auto whole = make();
    const auto variance = readNpy<float>(file().string() + ".variance.npy").elements;
    fs::remove_all(fs::path(folder_.file("new")));
    const Progress cancel = [](std::string_view stage, float share) {
        if (stage != "ray hierarchy" && share >= 0.5f) throw Cancelled();
    };
    EXPECT_THROW(make(cancel), Cancelled);
    EXPECT_FALSE(fs::exists(file().string() + ".npy"));
    EXPECT_EQ(readNpy<float>(file().string() + ".partial.npy").shape,
              (std::vector<std::uint64_t>{3, 9, 6}));
    float first = -1;
    EXPECT_EQ(make([&](std::string_view stage, float share) {
                  if (stage != "ray hierarchy" && first < 0) first = share;
              }),
              whole);
    EXPECT_EQ(first, 0.5f);
    EXPECT_EQ(readNpy<float>(file().string() + ".variance.npy").elements, variance);
    EXPECT_FALSE(fs::exists(file().string() + ".partial.npy"));
}

TEST_F(StoredReferenceTest, IsMadeAgainIfItsFileIsBroken) {
    settings.side[0].method = Method::exact;
    const auto made = make();
    std::ofstream(file().string() + ".npy") << "no array";
    EXPECT_EQ(make(), made);
    EXPECT_GT(reports, 0);
    EXPECT_EQ(make(), made);
    EXPECT_EQ(reports, 0);
}

TEST_F(StoredReferenceTest, IsMadeAgainIfABitOfItFlipped) {
    settings.side[0].method = Method::exact;
    const auto made = make();
    for (const char* damaged : {".npy", ".npy.xxh"}) {
        const std::string name = file().string() + damaged;
        const auto size = static_cast<std::streamoff>(fs::file_size(name));
        std::fstream stream(name, std::ios::binary | std::ios::in | std::ios::out);
        stream.seekg(size / 2);
        const int byte = stream.get();
        stream.seekp(size / 2);
        stream.put(static_cast<char>(byte ^ 1));
        stream.close();
        EXPECT_EQ(make(), made);
        EXPECT_GT(reports, 0) << damaged;
        EXPECT_EQ(make(), made);
        EXPECT_EQ(reports, 0) << damaged;
    }
}

TEST_F(StoredReferenceTest, ItsNameTakesNegativeZeroForZero) {
    moment.camera.forward = {0, 0, -1};
    const fs::path name = file();
    moment.camera.forward = {-0.0f, -0.0f, -1};
    EXPECT_EQ(file(), name);
}

TEST_F(StoredReferenceTest, ItsNameTellsApartWhatMatters) {
    const Settings base = settings;
    const FrameMoment still = moment;
    for (const Method method : {Method::exact, Method::pathtraced}) {
        std::set<std::string> names;
        const auto name = [&](auto change) {
            settings = base;
            settings.side[0].method = method;
            moment = still;
            change();
            names.insert(file().filename().string());
        };
        name([] {});
        name([&] { settings.resolution.width = 10; });
        name([&] { settings.views.bounces = 3; });
        name([&] { settings.seed = 1; });
        name([&] { settings.scene.lightScale = 2; });
        name([&] { settings.scene.lights = "0:1,1,1"; });
        name([&] { moment.timeS = 1; });
        name([&] { moment.camera.position.x += 1e-7f; });
        name([&] { moment.camera.yfovRad += 0.1f; });
        name([&] { settings.resolution.height = 7; });
        name([&] { std::swap(settings.resolution.width, settings.resolution.height); });
        name([&] { moment.camera.forward = {0, 0.6f, -0.8f}; });
        name([&] { moment.camera.up = {0.6f, 0.8f, 0}; });
        name([&] { moment.camera.orthoHalfHeight = 2; });
        name([&] { moment.animation = 3; });
        name([&] { settings.scene.lightScale *= 1 + 1e-9; });
        name([&] { moment.timeS = 1 + 1e-9; });
        EXPECT_EQ(names.size(), 17u);
        const Scene other = std::exchange(assets_->scene, [] {
            Scene scene = assets_->scene;
            scene.hash = scene.contentHash = "another";
            return scene;
        }());
        name([] {});
        assets_->scene = other;
        EXPECT_EQ(names.size(), 18u);
        // What matters to one of them only.
        name([&] { settings.side[0].referenceSamples = 5; });
        EXPECT_EQ(names.size(), method == Method::pathtraced ? 19u : 18u);
        name([&] { settings.views.vpls = 200; });
        name([&] { settings.gather.clampDistance = 0.02; });
        name([&] { settings.gather.clampDistance = 0.02 + 1e-9; });
        name([&] { settings.views.placement = Placement::random; });
        name([&] { settings.views.particles = 7; });
        name([&] { settings.views.file = "some.ply"; });
        views[5].fluxG += 1;
        name([&] { settings.views.file = "some.ply"; });  // the same name, other views
        views[5].fluxG -= 1;
        EXPECT_EQ(names.size(), method == Method::exact ? 25u : 19u);
        // What matters to neither.
        name([&] { settings.gather.samples = 3; });
        name([&] { settings.side[0].maps.resolution = 32; });
        name([&] { settings.display.exposureEv = 3; });
        EXPECT_EQ(names.size(), method == Method::exact ? 25u : 19u);
    }
}

TEST_F(StoredReferenceTest, PathsStartFromTheScenesOwnLights) {
    settings.side[0].method = Method::pathtraced;
    settings.views.particles = 10;
    EXPECT_THROW(make(), Error);
    settings.views.particles = 0;
    settings.views.file = "some.ply";
    EXPECT_THROW(make(), Error);
}

}  // namespace
}  // namespace mv
