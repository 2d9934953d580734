// Views chosen on the GPU against the CPU's choice, and what frames show of them.

#include "renderer/passes/thin_views_pass.h"

#include <cstring>

#include "gl/gl_fixture.h"
#include "gpu/frame_fixture.h"
#include "renderer/passes/vpl_pass.h"
#include "views/rooms.h"

namespace mv {
namespace {

using testing::furnishedRoom;
using testing::Lit;

class ThinViewsPassTest : public GlTest {};

TEST_F(ThinViewsPassTest, ChoosesWhatItsTwinDoes) {
    gl::Profiler profiler;
    ThinViewsPass pass;
    const Lit lit(furnishedRoom(3, testing::everything));
    ImportanceCamera from;
    from.camera.position = {0.6f, 0.5f, 0.6f};
    from.camera.forward = glm::normalize(glm::vec3(-1, -0.2f, -1));
    const ViewGuide guide = makeViewGuide(lit.bvh, lit.emitters, from, 4, 5);
    // Around a block, a group of lanes, and all alive or none wanted.
    for (const std::uint64_t count : {1u, 63u, 64u, 65u, 1000u, 16385u}) {
        for (const std::uint64_t wanted : {std::uint64_t{1}, count / 4 + 1, 2 * count}) {
            ViewSet cpu = traceVpls(lit.bvh, lit.emitters, {count, 4, 5}, &guide);
            GpuViews gpu;
            upload(cpu, gpu);
            pass.thin(guide.importance, wanted, 5, profiler, gpu);
            thinViews(cpu, guide.importance, wanted, 5);
            const std::vector<View> made = gpu.views.read(0, gpu.count);
            ASSERT_EQ(made.size(), cpu.views.size());
            std::size_t different = 0;
            for (std::size_t i = 0; i < made.size(); ++i) {
                different += std::memcmp(&made[i], &cpu.views[i], sizeof(View)) != 0;
            }
            EXPECT_EQ(different, 0u) << count << " candidates, " << wanted << " wanted";
        }
    }
}

// ---------------------------------------------------------------- frames as they are by default

class ChosenViews : public test::FrameTest {
  protected:
    void SetUp() override {
        FrameTest::SetUp();
        const Settings plain;
        settings.views.placement = Placement::importance;
        settings.gather = plain.gather;
        settings.gather.samples = 16;
        settings.gather.nearField = false;
    }
    double distance(const std::vector<float>& a, const std::vector<float>& b) {
        double sum = 0, all = 0;
        for (std::size_t i = 0; i < a.size(); ++i) {
            sum += std::abs(double{a[i]} - double{b[i]});
            all += std::abs(double{b[i]});
        }
        return sum / all;
    }
};

TEST_F(ChosenViews, AreAboutAsManyAsAskedForAndRepeat) {
    const FrameStatistics s = render();
    EXPECT_EQ(s.viewsRequested, 200u);
    EXPECT_NEAR(static_cast<double>(s.viewsAlive), 200, 60);
    const auto first = renderer->display().readBytes(4);
    startAfresh();
    render();
    EXPECT_EQ(renderer->display().readBytes(4), first);
}

TEST_F(ChosenViews, OfASteadyCameraStayUntilWhatIsImportantMoves) {
    render();
    const std::uint64_t version = renderer->viewsVersion();
    input.moving = true;
    input.camera.position += 0.002f * input.camera.forward;
    render();
    EXPECT_EQ(renderer->viewsVersion(), version);
    input.camera.position += 0.25f * input.camera.forward;
    input.camera.forward = glm::normalize(glm::vec3(1, 0.2f, -0.2f));
    render();
    EXPECT_GT(renderer->viewsVersion(), version);
    input.moving = false;  // at rest: a function of this frame alone
    render();
    const auto shown = renderer->display().readBytes(4);
    startAfresh();
    render();
    EXPECT_EQ(renderer->display().readBytes(4), shown);
}

// Rays where maps do not know bring the sum over all views to that of rays for every view.
TEST_F(ChosenViews, MapsAndRaysAgreeWithRaysAlone) {
    settings.side[0].maps.resolution = 16;
    settings.side[0].method = Method::shadowRays;
    EXPECT_EQ(render().methods.at(0).undecidedShare, 1);
    settings.side[0].method = Method::megaviews;
    const double share = render().methods.at(0).undecidedShare;
    EXPECT_GT(share, 0.05);
    EXPECT_LT(share, 0.95);
    settings.gather.samples = 0;
    render();
    const auto undecidedAsked = renderer->radiance().readFloats(4);
    settings.side[0].method = Method::shadowRays;
    render();
    const auto exact = renderer->radiance().readFloats(4);
    const double asked = distance(undecidedAsked, exact);
    settings.side[0].method = Method::megaviews;
    settings.gather.undecided = Undecided::off;
    EXPECT_EQ(render().methods.at(0).undecidedShare, 0);
    const double alone = distance(renderer->radiance().readFloats(4), exact);
    EXPECT_LT(asked, 0.5 * alone);
    EXPECT_LT(asked, 0.02);
}

// What the clamp takes comes back, and only light is added.
TEST_F(ChosenViews, TheNearFieldGivesLightBack) {
    settings.side[0].method = Method::shadowRays;
    settings.gather.filter = false;
    render();
    const auto without = renderer->radiance().readFloats(4);
    settings.gather.nearField = true;
    render();
    const auto with = renderer->radiance().readFloats(4);
    double added = 0, all = 0;
    for (std::size_t i = 0; i < with.size(); ++i) {
        EXPECT_GE(with[i], without[i] * (1 - 1e-5f));
        added += double{with[i]} - double{without[i]};
        all += double{without[i]};
    }
    EXPECT_GT(added, 2e-4 * all);
    EXPECT_LT(added, 0.3 * all);
}

TEST_F(ChosenViews, UndecidedSamplesAreShown) {
    settings.picture.view = DebugView::undecided;
    const double share = render().methods.at(0).undecidedShare;
    const auto shown = renderer->radiance().readFloats(4);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < shown.size(); i += 4) {
        EXPECT_GE(shown[i], 0);
        EXPECT_LE(shown[i], 1);
        sum += double{shown[i]};
        count += shown[i] > 0;
    }
    ASSERT_GT(count, 0);
    EXPECT_NEAR(sum / count, share, 0.3);  // of pixels, not of samples
}

}  // namespace
}  // namespace mv
