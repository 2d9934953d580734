// A frame that somebody follows and may give up at any stage.

#include <algorithm>
#include <set>

#include "gpu/frame_fixture.h"
#include "megaviews/settings/statistics_table.h"

namespace mv {
namespace {

using test::FrameTest;

class FrameWatchTest : public FrameTest {
  protected:
    void SetUp() override {
        FrameTest::SetUp();
        if (IsSkipped()) return;
        settings.resolution.height = 90;  // several slices
        settings.views.placement = Placement::importance;
        settings.gather.clampDistance.reset();
        settings.gather.nearField = true;
        settings.gather.undecided = Undecided::rays;
        compareWith(settings, Method::manylods);
        settings.side[1].pairs.traversal = Traversal::queue;
    }
};

TEST_F(FrameWatchTest, SlicesAreTheWholeToTheBit) {
    render();
    const auto picture = display();
    const auto light = radiance();
    std::set<Stage> stages;
    std::vector<double> gathered;
    input.watch = [&](Stage stage, double done) {
        stages.insert(stage);
        EXPECT_GE(done, 0);
        EXPECT_LE(done, 1);
        if (stage == Stage::gather) gathered.push_back(done);
    };
    startAfresh();
    render();
    EXPECT_EQ(display(), picture);
    EXPECT_EQ(radiance(), light);
    for (const Stage stage : {Stage::traceViews, Stage::gBuffer, Stage::traverse, Stage::gather}) {
        EXPECT_TRUE(stages.count(stage)) << infoOf(stage).name;
    }
    EXPECT_GT(std::count_if(gathered.begin(), gathered.end(),
                            [](double done) { return done > 0 && done < 1; }),
              2);
}

std::set<Stage> stagesOf(const std::vector<StageTime>& times) {
    std::set<Stage> out;
    for (const StageTime& time : times) out.insert(time.stage);
    return out;
}

// Whether no stage counts for another owner than in the whole frame.
bool hasSameOwners(const FrameStatistics& frame, const FrameStatistics& whole) {
    const auto isPart = [](const auto& times, const auto& all) {
        const std::set<Stage> part = stagesOf(times), set = stagesOf(all);
        return std::includes(set.begin(), set.end(), part.begin(), part.end());
    };
    return isPart(frame.stagesOfBothSides, whole.stagesOfBothSides) &&
           isPart(frame.methods.at(0).stages, whole.methods.at(0).stages) &&
           isPart(frame.methods.at(1).stages, whole.methods.at(1).stages);
}

TEST_F(FrameWatchTest, GivenUpAnywhereTheNextFrameIsWhole) {
    const FrameStatistics whole = render();
    const auto picture = display();
    Settings other = settings;
    other.views.vpls = 100;
    other.resolution.width = 48;
    other.resolution.height = 40;
    struct GivenUp {};
    int reports = 0;
    for (int at = -1; at < reports; ++at) {  // the first counts them
        startAfresh();
        input.watch = {};
        render(other);
        const auto before = display();
        int n = 0;
        input.watch = [&](Stage, double) {
            if (n++ == at) throw GivenUp();
        };
        if (at < 0) {
            render();
            reports = n;
            continue;
        }
        EXPECT_THROW(render(), GivenUp) << at;
        EXPECT_EQ(display(), before) << "the picture stays, report " << at;
        input.watch = {};
        const FrameStatistics statistics = render();
        ASSERT_EQ(display(), picture) << "given up at report " << at;
        ASSERT_EQ(statistics.methods.size(), 2u);
        for (const MethodStatistics& method : statistics.methods) {
            EXPECT_GT(method.pairs.processed, 0u) << at;
        }
        EXPECT_TRUE(hasSameOwners(statistics, whole)) << at;
    }
    EXPECT_GT(reports, 20);
}

// One side becomes two, two become one, and the size changes with them.
TEST_F(FrameWatchTest, UntilTheFrameIsDoneTheLastPictureStands) {
    Settings other = settings;
    other.compare = false;
    other.resolution.width = 48;
    for (const auto& [from, to] : {std::pair(other, settings), std::pair(settings, other)}) {
        input.watch = {};
        render(from);
        const auto before = display();
        int reports = 0;
        input.watch = [&](Stage stage, double) {
            ++reports;
            EXPECT_EQ(display(), before) << infoOf(stage).name;
        };
        render(to);
        EXPECT_GT(reports, 10);
        EXPECT_NE(display(), before);
    }
}

}  // namespace
}  // namespace mv
