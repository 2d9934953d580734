// The baselines through FrameRenderer: one map a view, centred on it, beside any other method, and
// made anew only when something they depend on changes.

#include <algorithm>

#include "gpu/frame_fixture.h"

namespace mv {
namespace {

class FrameBaselines : public test::FrameTest {
  protected:
    static bool made(const MethodStatistics& side, Stage stage) {
        return std::any_of(side.stages.begin(), side.stages.end(),
                           [&](const StageTime& s) { return s.stage == stage && s.ms >= 0; });
    }
    // Each living slot has a map of its own, centred where it is.
    void expectOwnMaps(int side) {
        const ViewSet views = renderer->readViews();
        const ReadMaps read = renderer->readMaps(side);
        std::size_t alive = 0;
        std::vector<bool> taken(read.maps.centers.size(), false);
        for (std::size_t slot = 0; slot < views.views.size(); ++slot) {
            const View& v = views.views[slot];
            const std::uint32_t map = read.mapOfSlot.at(slot);
            ASSERT_EQ(map == kNone, v.flags == kViewDead) << "slot " << slot;
            if (map == kNone) continue;
            ++alive;
            ASSERT_FALSE(taken.at(map));
            taken[map] = true;
            ASSERT_EQ(read.maps.centers[map], glm::vec3(v.positionX, v.positionY, v.positionZ));
        }
        EXPECT_EQ(alive, taken.size());
        EXPECT_GT(alive, 0u);
    }
};

TEST_F(FrameBaselines, RasterMakesAMapForEachViewAndIsReusable) {
    compareWith(settings, Method::raster);
    const FrameStatistics first = render();
    expectOwnMaps(1);
    EXPECT_EQ(first.methods[1].maps, first.viewsAlive);
    EXPECT_EQ(first.methods[1].pairs, PairCounts{});
    EXPECT_TRUE(made(first.methods[1], Stage::rasterise));
    EXPECT_GT(first.methods[1].mapsMs, 0);
    EXPECT_EQ(first.methods[1].mapBytes, first.viewsAlive * 2 * 16 * 16 * 4);
    EXPECT_GT(first.methods[0].pairs.processed, 0u);
    EXPECT_EQ(first.badPixels, 0u);
    // What it does not use makes nothing anew.
    Settings other = settings;
    other.side[1].pairs.traversal = Traversal::queue;
    input.countLevels = true;
    EXPECT_FALSE(made(render(other).methods[1], Stage::rasterise));
    // What it uses does.
    other.side[1].maps.resolution = 8;
    EXPECT_TRUE(made(render(other).methods[1], Stage::rasterise));

    // Alone it shows what it shows beside another.
    settings.side[0].method = Method::raster;
    settings.compare = false;
    render();
    const auto alone = radiance();
    settings.side[0].method = Method::megaviews;
    compareWith(settings, Method::raster);
    settings.display.split = 0;
    render();
    EXPECT_EQ(radiance(), alone);
    settings.display.split = 1;
    render();
    EXPECT_NE(radiance(), alone);
}

TEST_F(FrameBaselines, RasterOfParticlesAndOfOneView) {
    settings.side[0].method = Method::raster;
    settings.side[0].rules = Rules::published;  // the bias of the shadow test alone
    settings.views.particles = 60;
    render();
    expectOwnMaps(0);
    settings.views.particles = 0;
    settings.views.vpls = 1;
    FrameStatistics one;
    do {  // paths may leave the box
        ++settings.seed;
        one = render();
        EXPECT_EQ(one.badPixels, 0u);
    } while (one.viewsAlive == 0 && settings.seed < 20);
    expectOwnMaps(0);
}

TEST_F(FrameBaselines, ImperfectMapsAreMadeAnewForWhatTheyDependOn) {
    settings.side[0].method = Method::ism;
    compareWith(settings, Method::megaviews);
    settings.side[0].ism.points = 500;
    settings.side[0].ism.pool = 4000;
    const FrameStatistics first = render();
    expectOwnMaps(0);
    EXPECT_EQ(first.methods[0].pairs, PairCounts{});
    EXPECT_EQ(first.methods[0].maps, first.viewsAlive);
    EXPECT_TRUE(made(first.methods[0], Stage::splatPoints));
    EXPECT_TRUE(made(first.methods[0], Stage::pullAndPush));
    EXPECT_GT(first.methods[0].workingMapBytes, 0u);
    EXPECT_EQ(first.badPixels, 0u);
    const auto before = renderer->readMaps(0).maps.texels;
    Settings other = settings;
    other.side[0].pairs.traversal = Traversal::queue;
    other.side[0].pairs.holeFill = other.side[0].pairs.fusion = false;
    EXPECT_FALSE(made(render(other).methods[0], Stage::splatPoints));
    other.side[0].ism.points = 501;
    EXPECT_TRUE(made(render(other).methods[0], Stage::splatPoints));
    EXPECT_NE(renderer->readMaps(0).maps.texels, before);
    other.side[0].ism.points = 500;
    other.side[0].ism.pool = 8000;
    render(other);
    EXPECT_NE(renderer->readMaps(0).maps.texels, before);
    // More points a view than the pool has: the pool grows.
    other.side[0].ism.pool = 1;
    EXPECT_EQ(render(other).badPixels, 0u);
    render();
    EXPECT_EQ(renderer->readMaps(0).maps.texels, before);
    settings.compare = false;
    settings.views.particles = 30;
    render();
    expectOwnMaps(0);
}

}  // namespace
}  // namespace mv
