// Exact maps as files, and the errors of maps against them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "app/common/frame_images.h"
#include "app/temp_folder.h"
#include "app/viewer/references.h"
#include "gpu/frame_fixture.h"
#include "megaviews/io/npy.h"
#include "megaviews/references/exact_maps.h"
#include "shaders/shared/paraboloid.glsl"

namespace mv {
namespace {

namespace fs = std::filesystem;
constexpr int kViews = 60, kRes = 8;
constexpr std::size_t kTexels = 2 * kRes * kRes;

std::uint32_t bitsOf(float depth) { return std::isinf(depth) ? kNone : floatBitsToUint(depth); }

class MapReferencesTest : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        assets_ = loadAssetsWithoutHierarchy("builtin:cornell", Settings{});
        embree_ = std::make_unique<EmbreeScene>(assets_->bvh);
    }
    static void TearDownTestSuite() {
        embree_.reset();
        assets_.reset();
    }
    void SetUp() override {
        settings.side[0].maps.resolution = kRes;
        settings.views.vpls = kViews;
        settings.views.placement = Placement::traced;  // their name follows from settings alone
        const Emitters emitters = makeEmitters(assets_->scene, assets_->bvh, {});
        views = traceVpls(assets_->bvh, emitters, {kViews, 2, 0}).views;
        views[7].flags = kViewDead;
    }
    MapReferences make(std::size_t count, const Progress& progress = {}) {
        References references(*assets_, folder(), [this, progress](auto stage, float share) {
            if (stage == "exact maps") ++reports;
            report(progress, stage, share);
        });
        reports = 0;
        return references.maps(request(), count);
    }
    fs::path folder() const { return folder_.file("new"); }
    fs::path file() const {
        return ReferenceStore(folder()).mapsFileFor(assets_->scene, request());
    }
    ReferenceRequest request() const { return {settings, moment, views, {}}; }
    // The exact maps seen from above each view, as a method would hand them over.
    ReadMaps mapsAbove(const MapReferences& references, float height) const {
        std::vector<glm::vec3> centers = references.positions;
        for (std::size_t i = 0; i < centers.size(); ++i) {
            const View& v = views[references.slots[i]];
            centers[i] += height * glm::vec3(v.normalX, v.normalY, v.normalZ);
        }
        ReadMaps out;
        out.maps.mapRes = kRes;
        out.mapOfSlot.assign(views.size(), kNone);
        for (const float depth : exactMaps(*embree_, centers, kRes, false).depth) {
            out.maps.texels.push_back(bitsOf(depth));
        }
        out.maps.centers = std::move(centers);
        for (std::uint32_t i = 0; i < references.slots.size(); ++i) {
            out.mapOfSlot[references.slots[i]] = i;
        }
        return out;
    }

    Settings settings;
    FrameMoment moment;
    std::vector<View> views;
    int reports = 0;
    test::TempFolder folder_;
    static inline std::unique_ptr<SceneAssets> assets_;
    static inline std::unique_ptr<EmbreeScene> embree_;
};

TEST_F(MapReferencesTest, FewerViewsAreAPartOfMore) {
    const auto all = chooseViews(views, 0, 1000);
    const std::set<std::uint32_t> distinct(all.begin(), all.end());
    EXPECT_EQ(distinct.size(), all.size());
    EXPECT_EQ(all.size(), ViewSet{views}.alive());
    EXPECT_FALSE(distinct.contains(7));
    const auto some = chooseViews(views, 0, 11);
    EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin()));
    EXPECT_NE(chooseViews(views, 1, 11), some);
    EXPECT_FALSE(std::is_sorted(some.begin(), some.end())) << "not spread over the paths";
    EXPECT_TRUE(chooseViews({}, 0, 5).empty());
    EXPECT_TRUE(chooseViews(views, 0, 0).empty());
}

TEST_F(MapReferencesTest, AreFoundAgain) {
    const MapReferences made = make(12);
    EXPECT_GT(reports, 0);
    const auto stored = readNpy<float>(file().string() + ".npy");
    EXPECT_EQ(stored.shape, (std::vector<std::uint64_t>{12, 3, kTexels}));
    EXPECT_TRUE(fs::exists(file().string() + ".txt"));
    const MapReferences again = make(12);
    EXPECT_EQ(reports, 0) << "made again";
    EXPECT_EQ(again.slots, made.slots);
    EXPECT_EQ(again.positions, made.positions);
    EXPECT_EQ(again.depth, made.depth);
    EXPECT_EQ(again.nearest, made.nearest);
    EXPECT_EQ(again.farthest, made.farthest);
    // Fewer are read from more, more are made.
    const MapReferences fewer = make(5);
    EXPECT_EQ(reports, 0);
    EXPECT_EQ(fewer.slots.size(), 5u);
    EXPECT_TRUE(std::equal(fewer.depth.begin(), fewer.depth.end(), made.depth.begin()));
    EXPECT_EQ(fewer.farthest.size(), 5 * kTexels);
    EXPECT_EQ(make(20).slots.size(), 20u);
    EXPECT_GT(reports, 0);
    EXPECT_EQ(make(1000).slots.size(), ViewSet{views}.alive());
    EXPECT_TRUE(make(0).slots.empty());
}

TEST_F(MapReferencesTest, LeaveNothingBehindWhenCancelled) {
    const Progress cancel = [](std::string_view stage, float share) {
        if (stage == "exact maps" && share > 0.4f) throw Cancelled();
    };
    EXPECT_THROW(make(10, cancel), Cancelled);
    EXPECT_FALSE(fs::exists(folder()) && !fs::is_empty(folder()));
}

TEST_F(MapReferencesTest, OfOtherViewsAreNotUsed) {
    make(4);
    const ReferenceStore store(folder());
    EXPECT_TRUE(store.loadMaps(file(), kRes, views));
    EXPECT_FALSE(store.loadMaps(file(), 2 * kRes, views));
    std::vector<View> moved = views;
    moved[chooseViews(views, 0, 4)[3]].positionX += 1e-4f;
    EXPECT_FALSE(store.loadMaps(file(), kRes, moved));
    EXPECT_FALSE(store.loadMaps(file(), kRes, {}));
    EXPECT_FALSE(store.loadMaps(folder() / "maps-none", kRes, views));
    EXPECT_FALSE(ReferenceStore({}).loadMaps({}, kRes, views));
}

TEST_F(MapReferencesTest, TheirNameTellsApartWhatMatters) {
    const Settings base = settings;
    std::set<std::string> names;
    const auto name = [&](auto change) {
        settings = base;
        moment = {};
        change();
        names.insert(file().filename().string());
    };
    name([] {});
    name([&] { settings.side[0].maps.resolution = 16; });
    name([&] { settings.views.vpls = 7; });
    name([&] { settings.views.particles = 7; });
    name([&] { settings.views.bounces = 1; });
    name([&] { settings.seed = 5; });
    name([&] { settings.views.file = "v.ply"; });
    name([&] { settings.scene.lights = "0:1,1,1"; });
    name([&] { moment.timeS = 1; });
    EXPECT_EQ(names.size(), 9u);
    // What no map depends on.
    name([&] { settings.side[0].method = Method::manylods; });
    name([&] { settings.side[0].rules = kPublishedRules; });
    name([&] { settings.resolution.width = 5; });
    name([&] { settings.views.octreeDepth = 3; });
    name([&] { moment.camera.position.x = 3; });
    EXPECT_EQ(names.size(), 9u);
}

TEST_F(MapReferencesTest, FindNoErrorInThemselves) {
    const MapReferences references = make(40);
    const MapErrors errors = mapErrors(references, views, mapsAbove(references, 0));
    EXPECT_GT(errors.texels, 40 * kTexels / 4);
    EXPECT_LT(errors.texels, 40 * kTexels * 6 / 10) << "texels behind the views are compared";
    for (const MapMetricInfo& info : mapMetricsTable()) EXPECT_EQ(errors.*info.count, 0u);
}

TEST_F(MapReferencesTest, CountDepthsInProportion) {
    const MapReferences references = make(10);
    ReadMaps maps = mapsAbove(references, 0);
    for (std::uint32_t& bits : maps.maps.texels) {
        if (bits != kNone) bits = bitsOf(1.05f * uintBitsToFloat(bits));
    }
    const MapErrors far = mapErrors(references, views, maps);
    EXPECT_EQ(far.tooFar, far.texels);
    EXPECT_EQ(far.off2, far.texels);
    EXPECT_EQ(far.off10, 0u);
    std::fill(maps.maps.texels.begin(), maps.maps.texels.end(), kNone);
    const MapErrors empty = mapErrors(references, views, maps);
    EXPECT_EQ(empty.empty, empty.texels);
    EXPECT_EQ(empty.filled, 0u);
}

// A map from some way off the view errs by that.
TEST_F(MapReferencesTest, CountTheErrorOfSharingAMap) {
    const MapReferences references = make(40);
    std::uint64_t before = 0;
    for (const float height : {0.001f, 0.004f, 0.016f}) {
        const MapErrors errors = mapErrors(references, views, mapsAbove(references, height));
        EXPECT_GT(errors.off2, before) << height;
        EXPECT_LT(errors.share(errors.off2), 10 * height) << height;
        before = errors.off2;
    }
}

// Texels that no receiver asks for may hold anything.
TEST_F(MapReferencesTest, LeaveOutWhatLiesBehindAView) {
    const MapReferences references = make(10);
    ReadMaps maps = mapsAbove(references, 0);
    std::size_t behind = 0;
    for (std::size_t i = 0; i < references.slots.size(); ++i) {
        const View& v = views[references.slots[i]];
        for (uint texel = 0; texel < kTexels; ++texel) {
            const glm::vec3 d = texelDirection(texel, kRes);
            if (glm::dot(d, glm::vec3(v.normalX, v.normalY, v.normalZ)) > 0) continue;
            maps.maps.texels[i * kTexels + texel] = bitsOf(1e-3f);
            ++behind;
        }
    }
    ASSERT_GT(behind, 10 * kTexels / 4);
    const MapErrors errors = mapErrors(references, views, maps);
    EXPECT_EQ(errors.off2 + errors.filled, 0u);
    // A view without a normal asks for all.
    for (View& view : views) {
        if (view.flags != kViewDead) view.flags = kViewOmnidirectional;
    }
    const MapErrors all = mapErrors(references, views, maps);
    EXPECT_GT(all.off2 + all.filled, 0u);
    // Its own surface, some lifts away, is no error of anyone's.
    std::size_t beyond = 0, own = 0;
    for (std::size_t i = 0; i < references.depth.size(); ++i) {
        if (std::isinf(references.depth[i])) continue;
        ++(references.depth[i] > 10 * kVplOffset ? beyond : own);
    }
    EXPECT_GT(own, 10u);
    EXPECT_EQ(all.texels, beyond);
}

// Without fusion, what the leaf did not see its ancestors may have.
TEST_F(MapReferencesTest, AreComparedWithMapsThatWereNotFused) {
    const MapReferences references = make(10);
    ReadMaps maps = mapsAbove(references, 0);
    maps.parents.assign(10, kNone);
    const MapErrors leaves = mapErrors(references, views, maps);
    EXPECT_EQ(leaves.off2, 0u);
    // Each map moves to a parent of its own with the same centre; the leaf keeps nothing.
    ReadMaps split = maps;
    split.maps.texels.insert(split.maps.texels.begin(), maps.maps.texels.size(), kNone);
    split.maps.centers.insert(split.maps.centers.end(), maps.maps.centers.begin(),
                              maps.maps.centers.end());
    split.parents.resize(20, kNone);
    for (std::uint32_t i = 0; i < 10; ++i) split.parents[i] = 10 + i;
    const MapErrors walked = mapErrors(references, views, split);
    EXPECT_EQ(walked.texels, leaves.texels);
    EXPECT_LT(walked.off2, leaves.texels / 50);  // rounding of what was moved by nothing
    EXPECT_EQ(walked.empty, 0u);
    std::fill(split.parents.begin(), split.parents.end(), kNone);
    EXPECT_EQ(mapErrors(references, views, split).empty, leaves.texels);
}

// What an ancestor's texel holds is a point; its depth is that from the leaf's centre.
TEST_F(MapReferencesTest, BringDepthsOfAncestorsToTheLeaf) {
    MapReferences references = make(20);
    ReadMaps split = mapsAbove(references, 0.02f);
    for (std::size_t i = 0; i < references.depth.size(); ++i) {
        const std::uint32_t bits = split.maps.texels[i];
        if (bits == kNone) {
            references.depth[i] = std::numeric_limits<float>::infinity();
            continue;
        }
        const glm::vec3 d = texelDirection(static_cast<uint>(i % kTexels), kRes);
        references.depth[i] =
            glm::distance(split.maps.centers[i / kTexels] + d * uintBitsToFloat(bits),
                          references.positions[i / kTexels]);
    }
    const MapErrors where = mapErrors(references, views, split);
    EXPECT_GT(where.off2, where.texels / 10);  // measured from where the ancestor stands
    split.maps.texels.insert(split.maps.texels.begin(), split.maps.texels.size(), kNone);
    split.maps.centers.insert(split.maps.centers.begin(), references.positions.begin(),
                              references.positions.end());
    split.parents.resize(40, kNone);
    for (std::uint32_t i = 0; i < 20; ++i) split.parents[i] = 20 + i;
    const MapErrors brought = mapErrors(references, views, split);
    EXPECT_EQ(brought.texels, where.texels);
    EXPECT_EQ(brought.off2, 0u);
}

TEST_F(MapReferencesTest, GiveTheSharesOfTheTable) {
    MapErrorReport report;
    report.views = 3;
    EXPECT_TRUE(toJson(report)["off10"].is_null());
    report.errors.texels = 200;
    report.errors.off10 = 30;
    const nlohmann::ordered_json json = toJson(report);
    EXPECT_EQ(json["off10"], 15);
    EXPECT_EQ(json["views"], 3);
    EXPECT_EQ(json.size(), 3 + mapMetricsTable().size());
}

using FrameMaps = test::FrameTest;

TEST_F(FrameMaps, OfSomeViewsAreThoseOfAll) {
    for (const Method method : {Method::megaviews, Method::manylods}) {
        for (const bool fusion : {true, false}) {
            settings.side[0].method = method;
            settings.side[0].pairs.fusion = fusion;
            settings.side[0].maps.resolution = kRes;
            compareWith(settings, Method::none);
            render();
            const ReadMaps all = renderer->readMaps();
            const auto slots = chooseViews(renderer->readViews().views, 0, 17);
            const ReadMaps some = renderer->readMapsOf(slots);
            ASSERT_EQ(slots.size(), 17u);
            EXPECT_EQ(some.maps.mapRes, kRes);
            // Each view of ManyLoDs has a map of its own: nothing to fuse.
            const bool walked = !fusion && method == Method::megaviews;
            EXPECT_EQ(all.parents.empty(), !walked);
            EXPECT_EQ(some.maps.texels.size(), some.maps.centers.size() * kTexels);
            EXPECT_LT(some.maps.centers.size(), all.maps.centers.size());
            std::size_t above = 0;
            for (const std::uint32_t slot : slots) {
                std::uint32_t a = all.mapOfSlot[slot], b = some.mapOfSlot[slot];
                while (a != kNone) {
                    ASSERT_NE(b, kNone);
                    EXPECT_EQ(all.maps.centers[a], some.maps.centers[b]);
                    EXPECT_TRUE(std::equal(&some.maps.texels[b * kTexels],
                                           &some.maps.texels[b * kTexels] + kTexels,
                                           &all.maps.texels[a * kTexels]));
                    a = walked ? all.parents[a] : kNone;
                    b = walked ? some.parents[b] : kNone;
                    above += a != kNone;
                }
                EXPECT_EQ(b, kNone);
            }
            EXPECT_EQ(above > 0, walked);
            EXPECT_TRUE(renderer->readMapsOf(slots, 1).maps.texels.empty());
            EXPECT_TRUE(renderer->readMapsOf({}).maps.texels.empty());
        }
    }
}

// The bound is loose: that a method's maps are near the exact ones at all, in the same units, axes
// and order of texels.
TEST_F(FrameMaps, AreNearTheExactOnes) {
    settings.side[0].maps.resolution = 16;
    render();
    const ViewSet views = renderer->readViews();
    const TriangleBvh bvh = TriangleBvh::build(scene());
    const EmbreeScene embree(bvh);
    MapReferences references;
    references.mapRes = 16;
    references.slots = chooseViews(views.views, 0, 50);
    for (const std::uint32_t slot : references.slots) {
        const View& v = views.views[slot];
        references.positions.emplace_back(v.positionX, v.positionY, v.positionZ);
    }
    ExactMaps exact = exactMaps(embree, references.positions, 16, true);
    references.depth = std::move(exact.depth);
    references.nearest = std::move(exact.nearest);
    references.farthest = std::move(exact.farthest);
    const auto report = mapErrorsOf(references, views.views, *renderer, settings, 0);
    ASSERT_TRUE(report);
    EXPECT_EQ(report->views, 50u);
    EXPECT_GT(report->errors.texels, 50u * 150);
    EXPECT_LT(report->errors.share(report->errors.off10), 0.25);
    EXPECT_LT(report->errors.share(report->errors.empty), 0.05);
    // The same maps read from the root down hold the same.
    settings.side[0].pairs.fusion = false;
    render();
    const auto unfused = mapErrorsOf(references, views.views, *renderer, settings, 0);
    ASSERT_TRUE(unfused);
    EXPECT_NEAR(unfused->errors.share(unfused->errors.off10),
                report->errors.share(report->errors.off10), 0.1);
    settings.side[0].method = Method::none;
    render();
    EXPECT_FALSE(mapErrorsOf(references, views.views, *renderer, settings, 0));
}

}  // namespace
}  // namespace mv
