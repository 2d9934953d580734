// Still pictures of which each set of samples has views of its own: what their mean is, and that
// nothing but the picture has it.

#include <cmath>

#include "gpu/frame_fixture.h"
#include "gpu/picture_scenes.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/gl/read_back.h"

namespace mv {
namespace {

using test::FrameTest;

constexpr int kSets = 5;

class FreshViews : public FrameTest {
  protected:
    void SetUp() override {
        FrameTest::SetUp();
        settings.picture.freshViews = true;
        settings.picture.accumulate = kSets;
    }
    void renderTo(int sets) {
        while (render().accumulatedFrames < sets) {
        }
    }
    std::vector<float> radianceOf(const Settings& one) {
        FrameRenderer other;
        other.setScene(scene(), bvh(), hierarchy());
        FrameStatistics statistics;
        other.render(one, input, statistics);
        return other.radiance().readFloats(4);
    }
};

// Of full sums, which have no samples of their own: of each set the picture of its seed alone.
TEST_F(FreshViews, MeanIsThatOfThePicturesOfTheirSeeds) {
    settings.gather.samples = 0;
    settings.gather.filter = false;
    for (const Placement placement : {Placement::traced, Placement::importance}) {
        settings.views.placement = placement;
        for (const Method method : {Method::megaviews, Method::manylods, Method::none}) {
            setMethod(settings, method);
            std::vector<double> sum;
            std::vector<float> first;
            for (int n = 1; n <= kSets; ++n) {
                Settings one = settings;
                one.picture.freshViews = false;
                one.picture.accumulate = 1;
                one.seed = viewSeed(settings.seed, n);
                const auto light = radianceOf(one);
                if (n == 1) first = light;
                sum.resize(light.size());
                for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += double{light[k]} / kSets;
            }
            startAfresh();
            renderTo(kSets);
            const auto mean = radiance();
            double others = 0;
            for (std::size_t k = 0; k < sum.size(); ++k) {
                ASSERT_NEAR(mean[k], sum[k], 3e-6 * std::abs(sum[k]) + 1e-9)
                    << nameOf(method) << ' ' << k;
                others += std::abs(mean[k] - first[k]) > 0.05f * std::abs(first[k]) + 1e-6f;
            }
            EXPECT_GT(others, 300) << nameOf(method) << ": the views were others";
        }
    }
}

TEST_F(FreshViews, PointsOfPixelsHaveThemToo) {
    settings.picture.pixelSamples = kSets;
    settings.gather.samples = 0;
    settings.gather.filter = false;
    std::vector<double> sum;
    for (int n = 1; n <= kSets; ++n) {
        Settings one = settings;
        one.picture = {};
        one.seed = viewSeed(settings.seed, n);
        const FrameCamera camera = input.camera;
        input.camera.offset = 2.0f * pixelOffset(static_cast<std::uint32_t>(n - 1)) /
                              glm::vec2(one.resolution.width, one.resolution.height);
        const auto light = radianceOf(one);
        input.camera = camera;
        sum.resize(light.size());
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += double{light[k]} / kSets;
    }
    renderTo(kSets);
    const auto mean = radiance();
    for (std::size_t k = 0; k < sum.size(); ++k) {
        ASSERT_NEAR(mean[k], sum[k], 3e-6 * std::abs(sum[k]) + 1e-9) << k;
    }
}

// What an instrument shows or reads is of the frame's own views, whatever the picture averages.
TEST_F(FreshViews, InstrumentsStayWithTheFramesOwn) {
    render();
    const ViewSet views = renderer->readViews();
    const ReadMaps maps = renderer->readMaps(0);
    const std::uint64_t viewsVersion = renderer->viewsVersion(),
                        mapsVersion = renderer->mapsVersion(0);
    renderTo(kSets);
    EXPECT_EQ(renderer->viewsVersion(), viewsVersion);
    EXPECT_EQ(renderer->mapsVersion(0), mapsVersion);
    const ViewSet after = renderer->readViews();
    ASSERT_EQ(after.views.size(), views.views.size());
    for (std::size_t i = 0; i < views.views.size(); ++i) {
        ASSERT_EQ(after.views[i].positionX, views.views[i].positionX);
    }
    EXPECT_EQ(renderer->readMaps(0).maps.texels, maps.maps.texels);
    // The pixel's samples are those of the first set.
    Settings one = settings;
    one.picture = {};
    FrameRenderer other;
    other.setScene(scene(), bvh(), hierarchy());
    FrameStatistics statistics;
    other.render(one, input, statistics);
    const auto want = other.readSamples(31, 20, 0), got = renderer->readSamples(31, 20, 0);
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t i = 0; i < got.size(); ++i) {
        EXPECT_EQ(got[i].slot, want[i].slot);
        EXPECT_EQ(got[i].irradiance, want[i].irradiance);
    }
}

TEST_F(FreshViews, RestsRepeatsItselfAndBeginsAnew) {
    renderTo(kSets);
    const auto last = radiance();
    const FrameStatistics rest = render();
    EXPECT_EQ(rest.accumulatedFrames, kSets);
    EXPECT_TRUE(rest.stagesOfBothSides.empty());
    EXPECT_TRUE(rest.methods[0].stages.empty());
    // Another kind of mean is another picture.
    settings.picture.freshViews = false;
    EXPECT_EQ(render().accumulatedFrames, 1);
    renderTo(kSets);
    EXPECT_NE(radiance(), last);
    settings.picture.freshViews = true;
    EXPECT_EQ(render().accumulatedFrames, 1);
    renderTo(kSets);
    EXPECT_EQ(radiance(), last);
    settings.scene.lightScale = 2;
    EXPECT_EQ(render().accumulatedFrames, 1);
    renderTo(kSets);
    EXPECT_NE(radiance(), last);
    settings.scene.lightScale = 1;
    render();
    renderTo(kSets);
    EXPECT_EQ(radiance(), last);
}

TEST_F(FreshViews, BothSidesHaveTheSame) {
    compareWith(settings, Method::megaviews);
    renderTo(kSets);
    EXPECT_EQ(renderer->radianceOf(0).readFloats(4), renderer->radianceOf(1).readFloats(4));
    settings.display.difference = Difference::relative;
    compareWith(settings, Method::manylods);
    render();
    renderTo(kSets);
    settings.compare = false;
    setMethod(settings, Method::manylods);
    const auto right = renderer->radianceOf(1).readFloats(4);
    startAfresh();
    renderTo(kSets);
    EXPECT_EQ(radiance(), right) << "as alone";
}

// Cuts are kept from frame to frame, not from one set of views to another.
TEST_F(FreshViews, KeptCutsMakeTheSamePicture) {
    renderTo(kSets);
    const auto basic = radiance();
    settings.side[0].pairs.cut = Cut::incremental;
    startAfresh();
    renderTo(kSets);
    EXPECT_EQ(radiance(), basic);
}

// Where maps of two sets of views do not fit the budget, the frame's own serve every set.
TEST_F(FreshViews, ShareTheFramesOwnWhereThereIsNoRoom) {
    settings.views.vpls = 1200;
    renderTo(kSets);
    const auto fresh = radiance();
    settings.side[0].maps.memoryMiB = 3;
    const FrameStatistics statistics = render();
    EXPECT_GT(2 * statistics.methods[0].mapBytes, 3u << 20);
    renderTo(kSets);
    const auto shared = radiance();
    EXPECT_NE(shared, fresh);
    settings.picture.freshViews = false;
    startAfresh();
    renderTo(kSets);
    EXPECT_EQ(radiance(), shared);
}

// A window's frames wait for nothing, and come to the same picture.
TEST_F(FreshViews, LateResultsMakeTheSamePicture) {
    for (const Method method : {Method::megaviews, Method::manylods}) {
        setMethod(settings, method);
        for (const uint rules : {kCorrectedRules, kPublishedRules}) {
            settings.side[0].rules = rules;
            startAfresh();
            renderTo(kSets);
            const auto want = display();
            renderer = std::make_unique<FrameRenderer>(gl::Results::late);
            renderer->setScene(scene(), bvh(), hierarchy());
            render();
            gl::forgetWaits();
            int frames = 0;
            for (FrameStatistics statistics; statistics.accumulatedFrames < kSets; ++frames) {
                ASSERT_LT(frames, 20 * kSets);
                glFinish();
                gl::holdResults(true);
                FrameStatistics next;
                if (renderer->render(settings, input, next)) statistics = next;
            }
            for (int i = 0; i < 20 && renderer->underWay(); ++i) {
                glFinish();
                gl::holdResults(true);
                FrameStatistics next;
                renderer->render(settings, input, next);
            }
            std::string waited;
            for (const auto& [call, count] : gl::waits()) waited += call + ' ';
            gl::holdResults(false);
            EXPECT_EQ(waited, "") << nameOf(method);
            EXPECT_EQ(display(), want) << nameOf(method);
            EXPECT_GT(frames, kSets) << "views and maps come back first";
        }
    }
}

}  // namespace
}  // namespace mv
