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
    settings.side[0].rules = kPublishedRules;  // the bias of the shadow test alone
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

TEST_F(FrameBaselines, PointsAreMadeAnewForWhatTheyDependOn) {
    settings.side[0].method = Method::vir;
    compareWith(settings, Method::shadowRays);
    settings.side[0].vir.density = settings.side[1].vir.density = 1;
    const FrameStatistics first = render();
    expectOwnMaps(0);
    EXPECT_EQ(first.methods[0].maps, first.viewsAlive);
    EXPECT_GT(first.methods[0].points, 1000u);
    EXPECT_EQ(first.methods[1].points, 0u);
    EXPECT_TRUE(made(first.methods[0], Stage::makePoints));
    EXPECT_TRUE(made(first.methods[0], Stage::splatPoints));
    EXPECT_EQ(first.badPixels, 0u);
    EXPECT_TRUE(std::ranges::any_of(first.memory, [](const MemoryUse& use) {
        return use.name.starts_with("points") && use.usedBytes > 16000;
    }));
    Settings other = settings;
    other.side[0].pairs.traversal = Traversal::queue;
    other.side[0].ism.points = 7;
    EXPECT_FALSE(made(render(other).methods[0], Stage::makePoints));
    other.side[0].vir.density = 2;
    const FrameStatistics denser = render(other);
    EXPECT_TRUE(made(denser.methods[0], Stage::makePoints));
    EXPECT_GT(denser.methods[0].points, 3 * first.methods[0].points / 2);
}

// Summed over all views without filter, where shadow rays are exact.
TEST_F(FrameBaselines, TheLightOfPointMapsIsNearlyExact) {
    settings.gather.samples = 0;
    settings.gather.filter = false;
    settings.gather.cull.level = 0;
    settings.picture.view = DebugView::indirect;
    const auto lightOf = [&](Method method) {
        settings.side[0].method = method;
        render();
        return radiance();
    };
    const std::vector<float> exact = lightOf(Method::shadowRays), open = lightOf(Method::none);
    const auto errorOf = [&](const std::vector<float>& light) {
        double error = 0, all = 0;
        for (std::size_t i = 0; i < light.size(); ++i) {
            if (i % 4 == 3) continue;
            error += std::abs(double{light[i]} - double{exact[i]});
            all += double{exact[i]};
        }
        return error / all;
    };
    const double vir = errorOf(lightOf(Method::vir)), raster = errorOf(lightOf(Method::raster));
    ASSERT_GT(errorOf(open), 0.05);
    std::printf("error of the light: vir %.4f, raster %.4f, none %.4f\n", vir, raster,
                errorOf(open));
    EXPECT_LT(vir, 0.5 * errorOf(open));
    EXPECT_LT(vir, 1.5 * raster + 0.005);
}

}  // namespace
}  // namespace mv
