#include <gtest/gtest.h>

#include "ui/format.h"
#include "ui/frame_history.h"

namespace mv::ui {
namespace {

FrameStatistics frameOf(double ms, std::vector<StageTime> bothSides, std::size_t methods = 1) {
    FrameStatistics s;
    s.clock = "test clock";
    s.frameMs = ms;
    s.stagesOfBothSides = std::move(bothSides);
    for (std::size_t i = 0; i < methods; ++i) {
        s.methods.push_back({});
        s.methods.back().stages = {{Stage::traverse, 1.0 + static_cast<double>(i)},
                                   {Stage::traverse, 1.0}};
    }
    return s;
}

TEST(FrameHistory, KeepsTheLastFramesOnly) {
    FrameHistory h;
    for (int i = 0; i < 1000; ++i) h.add(frameOf(i, {{Stage::gBuffer, static_cast<double>(i)}}, 2));
    ASSERT_EQ(h.frameMs().size(), kPlottedFrames);
    EXPECT_EQ(h.frameMs().front(), 488.0f);
    EXPECT_EQ(h.frameMs().back(), 999.0f);
    ASSERT_EQ(h.stages(0).size(), 1u);
    EXPECT_EQ(h.stages(0)[0].ms.size(), kSummarisedFrames);
    EXPECT_EQ(h.stages(0)[0].ms.back(), 999.0);
    // A stage that ran twice in a frame is one stage with the sum.
    ASSERT_EQ(h.stages(2).size(), 1u);
    EXPECT_EQ(h.stages(2)[0].ms.back(), 3.0);
}

TEST(FrameHistory, StagesStandInTheOrderOfTheFrameAndGoWhenTheyNoLongerRun) {
    FrameHistory h;
    h.add(frameOf(1, {{Stage::traceViews, 1}, {Stage::gBuffer, 1}}));
    h.add(frameOf(1, {{Stage::traceViews, 1}, {Stage::sortViews, 1}, {Stage::gBuffer, 1}}));
    ASSERT_EQ(h.stages(0).size(), 3u);
    EXPECT_EQ(h.stages(0)[1].stage, Stage::sortViews);
    for (std::size_t i = 0; i < kSummarisedFrames + 1; ++i)
        h.add(frameOf(1, {{Stage::traceViews, 1}}));
    ASSERT_EQ(h.stages(0).size(), 1u);
    EXPECT_EQ(h.stages(0)[0].stage, Stage::traceViews);
}

// Frames that kept the maps or the gather's samples do not make a frame with both cheaper.
TEST(FrameHistory, SumsTheMediansOfStagesThatNotEveryFrameRuns) {
    FrameHistory h;
    const auto side = [](std::vector<StageTime> stages) {
        FrameStatistics frame = frameOf(1, {}, 1);
        frame.methods[0].stages = std::move(stages);
        return frame;
    };
    for (const double ms : {10.0, 30.0, 20.0})
        h.add(side({{Stage::traverse, ms}, {Stage::fill, 1}}));
    for (int i = 0; i < 9; ++i) h.add(side({{Stage::gather, 5}, {Stage::filter, 2}}));
    EXPECT_EQ(h.medianOf(1, StageGroup::maps).ms, 21);
    EXPECT_EQ(h.medianOf(1, StageGroup::maps).frames, 3u);
    EXPECT_EQ(h.medianOf(1, StageGroup::gather).ms, 7);
    EXPECT_EQ(h.medianOf(1, StageGroup::gather).frames, 9u);
    EXPECT_EQ(h.medianOf(1).ms, 28);
}

TEST(FrameHistory, DoesNotMixClocks) {
    FrameHistory h;
    h.add(frameOf(1, {{Stage::gBuffer, 1}}));
    FrameStatistics other = frameOf(2, {{Stage::gBuffer, 2}});
    other.clock = "another clock";
    h.add(other);
    EXPECT_EQ(h.frameMs().size(), 1u);
    EXPECT_EQ(h.clock(), "another clock");
}

// A draft's times are no part of the whole picture's medians; the plot shows both.
TEST(FrameHistory, DoesNotMixDraftsAndPictures) {
    FrameHistory h;
    Settings picture, draft;
    for (int i = 0; i < 9; ++i) {
        draft.resolution.width = 100 + i;  // as its pace allows
        h.add(frameOf(1, {{Stage::gBuffer, 1}}), {draft, true});
    }
    EXPECT_EQ(h.medianOf(0).frames, 9u);
    h.add(frameOf(50, {{Stage::gBuffer, 50}}), {picture, false});
    EXPECT_EQ(h.medianOf(0).ms, 50);
    EXPECT_EQ(h.medianOf(1).frames, 1u);
    EXPECT_EQ(h.frameMs().size(), 10u);
    // Another method's times are its own, what both sides share goes on.
    h.add(frameOf(50, {{Stage::gBuffer, 50}}, 2), {picture, false});
    picture.side[1].method = Method::rays;
    h.add(frameOf(50, {{Stage::gBuffer, 50}}, 2), {picture, false});
    EXPECT_EQ(h.medianOf(0).frames, 3u);
    EXPECT_EQ(h.medianOf(1).frames, 3u);
    EXPECT_EQ(h.medianOf(2).frames, 1u);
    // Another gather: maps (the sides' stages here) and what both share go on.
    picture.gather.samples = 4;
    h.add(frameOf(50, {{Stage::gBuffer, 50}}, 2), {picture, false});
    EXPECT_EQ(h.medianOf(1).frames, 4u);
    EXPECT_EQ(h.medianOf(1, StageGroup::maps).frames, 4u);
    // A draft in between changes nothing.
    h.add(frameOf(1, {{Stage::gBuffer, 1}}, 2), {draft, true});
    EXPECT_EQ(h.medianOf(0).ms, 1);
    h.add(frameOf(50, {{Stage::gBuffer, 50}}, 2), {picture, false});
    EXPECT_EQ(h.medianOf(0).frames, 5u);
}

TEST(FrameHistory, ForgetsASideThatIsGone) {
    FrameHistory h;
    h.add(frameOf(1, {}, 2));
    EXPECT_FALSE(h.stages(2).empty());
    h.add(frameOf(1, {}, 1));
    EXPECT_TRUE(h.stages(2).empty());
}

TEST(Percentile, IsTheSmallestThatEnoughSamplesDoNotExceed) {
    EXPECT_EQ(percentile({}, 0.5), 0);
    EXPECT_EQ(percentile({3}, 0.0), 3);
    std::vector<float> samples;
    for (int i = 100; i > 0; --i) samples.push_back(static_cast<float>(i));
    EXPECT_EQ(percentile(samples, 0.5), 50);
    EXPECT_EQ(percentile(samples, 0.95), 95);
    EXPECT_EQ(percentile(samples, 1.0), 100);
}

TEST(Format, SeparatesThousandsAndKeepsUnits) {
    EXPECT_EQ(withThousands(std::uint64_t{0}), "0");
    EXPECT_EQ(withThousands(std::uint64_t{999}), "999");
    EXPECT_EQ(withThousands(std::uint64_t{1234567}), "1,234,567");
    EXPECT_EQ(withThousands(std::int64_t{-1234}), "-1,234");
    EXPECT_EQ(withThousands(std::uint64_t{18446744073709551615u}), "18,446,744,073,709,551,615");
    EXPECT_EQ(fixedText(-1234567.5, 1), "-1,234,567.5");
    EXPECT_EQ(fixedText(1e300, 0).size(), 301u + 100u);
    EXPECT_EQ(bytesText(3500000), "3.3 MiB");
    EXPECT_EQ(bytesText(1ull << 31), "2.00 GiB");
    EXPECT_EQ(numberText(0.01234), "0.01234");
    EXPECT_EQ(numberText(12.34), "12.34");
    EXPECT_EQ(numberText(0), "0");
    EXPECT_EQ(shortText(0.5), "0.5");
    EXPECT_EQ(shortText(512), "512");
    EXPECT_EQ(percentText(0.5), "50.0 %");
    EXPECT_EQ(escapedFormat("5 % of"), "5 %% of");
}

}  // namespace
}  // namespace mv::ui
