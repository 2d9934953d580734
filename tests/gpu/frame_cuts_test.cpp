// ManyLoDs' cuts that are kept, through whole frames: pictures of incremental cuts are those from
// the root, lazy ones catch up where nothing moves, and other methods keep none.

#include "gpu/frame_fixture.h"

namespace mv {
namespace {

using test::FrameTest;

class KeptCuts : public FrameTest {
  protected:
    void SetUp() override {
        FrameTest::SetUp();
        settings.side[0].method = Method::manylods;
        settings.picture.view = DebugView::indirect;
        settings.gather.samples = 0;
        settings.views.particles = 60;  // that fly, and so do their views
        input.reuse = false;
    }
    MethodStatistics frameAt(double timeS, Cut cut) {
        settings.side[0].pairs.cut = cut;
        input.timeS = timeS;
        return render().methods[0];
    }
    std::vector<std::uint32_t> maps() const { return renderer->readMaps().maps.texels; }
};

TEST_F(KeptCuts, PicturesAreThoseOfCutsFromTheRoot) {
    std::vector<std::vector<float>> basic;
    std::vector<MethodStatistics> from;
    for (int k = 0; k < 3; ++k) {
        from.push_back(frameAt(k / 30.0, Cut::basic));
        basic.push_back(radiance());
    }
    EXPECT_NE(basic[0], basic[1]);
    startAfresh();
    for (int k = 0; k < 3; ++k) {
        const MethodStatistics kept = frameAt(k / 30.0, Cut::incremental);
        EXPECT_EQ(radiance(), basic[static_cast<std::size_t>(k)]);
        const PairCounts& want = from[static_cast<std::size_t>(k)].pairs;
        EXPECT_EQ(kept.cuts.nodes, want.processed - want.subdivided);
        if (k == 0) {
            EXPECT_EQ(kept.pairs, want);
        } else {
            EXPECT_LT(kept.pairs.processed, want.processed);
            EXPECT_GT(kept.cuts.kept, 0u);
        }
        EXPECT_FALSE(renderer->mapsLag());
    }
    EXPECT_EQ(frameAt(0, Cut::basic).cuts, CutCounts{});
}

TEST_F(KeptCuts, LazyOnesCatchUpWhereNothingMoves) {
    frameAt(1, Cut::basic);
    const auto want = maps();
    startAfresh();
    frameAt(0, Cut::lazy);
    EXPECT_FALSE(renderer->mapsLag());
    EXPECT_GT(frameAt(1, Cut::lazy).cuts.coarse, 0u);
    EXPECT_NE(maps(), want);
    ASSERT_TRUE(renderer->mapsLag());
    // The same frame again has the same maps, unless it may catch up.
    input.reuse = true;
    const auto lagging = maps();
    render();
    EXPECT_EQ(maps(), lagging);
    input.refineLaggingMaps = true;
    int frames = 0;
    for (; renderer->mapsLag() && frames < settings.scene.octreeDepth; ++frames) render();
    EXPECT_FALSE(renderer->mapsLag());
    EXPECT_GT(frames, 0);
    EXPECT_EQ(maps(), want);
}

TEST_F(KeptCuts, MegaViewsKeepsNone) {
    settings.side[0].method = Method::megaviews;
    const MethodStatistics basic = frameAt(0, Cut::basic);
    const MethodStatistics kept = frameAt(0, Cut::incremental);
    EXPECT_EQ(kept.cuts, CutCounts{});
    EXPECT_EQ(kept.pairs, basic.pairs);
}

}  // namespace
}  // namespace mv
