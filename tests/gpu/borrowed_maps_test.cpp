// Frames in which only some of the views have maps, and the others share them.

#include <cmath>

#include "gpu/frame_fixture.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/gl/read_back.h"

namespace mv {
namespace {

class BorrowedMaps : public test::FrameTest {
  protected:
    void SetUp() override {
        FrameTest::SetUp();
        const Settings plain;
        settings.gather = plain.gather;
        settings.gather.nearField = false;
        settings.gather.filter = false;
        settings.views.vpls = 400;
        settings.views.maps = 24;
    }
    // Of light that is seen, squared.
    static double meanSquare(const std::vector<float>& a, const std::vector<float>& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            sum += std::pow(double{a[i]} - double{b[i]}, 2);
        }
        return sum / static_cast<double>(a.size());
    }
    std::vector<float> meanOf(int seeds) {
        std::vector<float> mean;
        for (int seed = 0; seed < seeds; ++seed) {
            // The same views: their file is that of no seed.
            settings.seed = static_cast<std::uint32_t>(seed);
            render();
            const auto one = radiance();
            mean.resize(one.size());
            for (std::size_t i = 0; i < one.size(); ++i) {
                mean[i] += one[i] / static_cast<float>(seeds);
            }
        }
        return mean;
    }
};

// Two dozen maps for some three hundred views are wrong for most of them, and yet the mean over
// seeds is the sum over all views by rays, and one frame has less noise than rays alone.
TEST_F(BorrowedMaps, RaysMakeThemRightInTheMean) {
    FrameRenderer first;
    first.setScene(scene(), bvh(), hierarchy());
    FrameStatistics statistics;
    first.render(settings, input, statistics);
    renderer->setViews(first.readViews());
    settings.gather.samples = 0;
    settings.side[0].method = Method::shadowRays;
    render();
    const auto exact = radiance();
    settings.gather.samples = 8;
    settings.seed = 0;
    render();
    const double ofRays = meanSquare(radiance(), exact);
    settings.side[0].method = Method::megaviews;
    const FrameStatistics shared = render();
    EXPECT_LE(shared.methods.at(0).maps, 24u);
    EXPECT_GT(shared.viewsAlive, 200u);
    const double ofOne = meanSquare(radiance(), exact);
    EXPECT_LT(ofOne, 0.85 * ofRays);
    constexpr int kSeeds = 40;
    EXPECT_LT(meanSquare(meanOf(kSeeds), exact), 1.6 * ofOne / kSeeds);
}

// Where nothing corrects them, all views have maps of their own.
TEST_F(BorrowedMaps, OnlyWhereRaysCorrectThem) {
    const auto maps = [&] { return render().methods.at(0).maps; };
    for (const Method method : {Method::megaviews, Method::manylods, Method::ism}) {
        SCOPED_TRACE(nameOf(method));
        Settings shared = settings;
        setMethod(shared, method);
        const auto mapsOf = [&](auto&& change) {
            settings = shared;
            change(settings);
            return maps();
        };
        EXPECT_LE(mapsOf([](Settings&) {}), 24u);
        EXPECT_GT(mapsOf([](Settings& s) { s.views.maps = 0; }), 100u);
        EXPECT_GT(mapsOf([](Settings& s) { s.gather.samples = 0; }), 100u);
        EXPECT_GT(mapsOf([](Settings& s) { s.gather.mapCheck = 0; }), 100u);
        EXPECT_GT(mapsOf([](Settings& s) { s.gather.undecided = Undecided::off; }), 100u);
        EXPECT_GT(mapsOf([](Settings& s) { s.side[0].rules &= ~kRuleFootprint; }), 100u);
        EXPECT_LE(mapsOf([](Settings&) {}), 24u);
        settings = shared;
    }
}

TEST_F(BorrowedMaps, AsManyAsViewsAreAsWithout) {
    settings.views.maps = settings.views.vpls;
    render();
    const auto shared = display();
    settings.views.maps = 0;
    render();
    EXPECT_EQ(display(), shared);
}

// One side shares, the other cannot: each is as it is alone.
TEST_F(BorrowedMaps, SidesShareEachForItself) {
    compareWith(settings, Method::manylods);
    settings.side[1].rules = kPublishedRules;
    settings.display.split = 1;
    const FrameStatistics both = render();
    EXPECT_LE(both.methods.at(0).maps, 24u);
    EXPECT_GT(both.methods.at(1).maps, 100u);
    const auto left = renderer->radianceOf(0).readFloats(4);
    const auto right = renderer->radianceOf(1).readFloats(4);
    const Settings compared = settings;
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
        settings = sideAlone(compared, side);
        startAfresh();
        render();
        EXPECT_EQ(radiance(), side == 0 ? left : right) << side;
    }
}

// What is read back are the maps that are there, and each view's is the one that it takes.
TEST_F(BorrowedMaps, AreReadBackWithTheirViews) {
    render();
    const ViewSet all = renderer->readViews(), own = renderer->readMapViews();
    ASSERT_EQ(all.views.size(), own.views.size());
    const ReadMaps maps = renderer->readMaps();
    std::size_t alive = 0, withMaps = 0;
    double shared = 0, others = 0;
    for (std::size_t slot = 0; slot < all.views.size(); ++slot) {
        const View& view = all.views[slot];
        if (view.flags == kViewDead) {
            EXPECT_EQ(own.views[slot].flags, kViewDead);
            EXPECT_EQ(maps.mapOfSlot[slot], kNone);
            continue;
        }
        ++alive;
        ASSERT_LT(maps.mapOfSlot[slot], maps.maps.centers.size());
        const auto far = [&](std::size_t map) {
            return double{glm::distance(maps.maps.centers[map],
                                        vec3(view.positionX, view.positionY, view.positionZ))};
        };
        shared += far(maps.mapOfSlot[slot]);
        others += far(slot % maps.maps.centers.size());
        if (own.views[slot].flags == kViewDead) continue;
        ++withMaps;
        EXPECT_LT(far(maps.mapOfSlot[slot]), 0.05);
    }
    EXPECT_LE(withMaps, 24u);
    EXPECT_GE(withMaps, maps.maps.centers.size());
    EXPECT_LT(shared, 0.5 * others);
    EXPECT_GT(alive, 200u);
    EXPECT_NE(renderer->mapViewsVersion(), renderer->viewsVersion());
    settings.views.maps = 0;
    render();
    EXPECT_EQ(renderer->mapViewsVersion(), renderer->viewsVersion());
}

// A method that makes maps after one that makes none finds the views that have them.
TEST_F(BorrowedMaps, MayBeginWithAnyFrame) {
    render();
    const auto want = radiance();
    startAfresh();
    settings.side[0].method = Method::shadowRays;
    render();
    settings.side[0].method = Method::megaviews;
    render();
    EXPECT_EQ(radiance(), want);
}

// Sets of samples with views of their own share those views' maps.
TEST_F(BorrowedMaps, FreshViewsShareTheirs) {
    settings.picture.freshViews = true;
    settings.picture.accumulate = 3;
    FrameStatistics statistics;
    while (statistics.accumulatedFrames < 3) statistics = render();
    const auto shared = radiance();
    for (const MemoryUse& use : statistics.memory) {
        if (use.name == "maps of fresh views") {
            EXPECT_LT(use.usedBytes, 4u << 20);
        }
    }
    settings.side[0].method = Method::shadowRays;
    do statistics = render();
    while (statistics.accumulatedFrames < 3);
    double sum = 0, ofRays = 0;
    const auto rays = radiance();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        sum += double{shared[i]};
        ofRays += double{rays[i]};
    }
    EXPECT_NEAR(sum, ofRays, 0.03 * ofRays);
}

}  // namespace
}  // namespace mv
