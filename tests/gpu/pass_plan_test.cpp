// PassPlan against traversals of known entries a view.
#include "renderer/methods/megaviews/pass_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>

namespace mv {
namespace {

constexpr std::uint64_t kRoom = 1000;

// Makes all passes over `views`, each of which takes `entries`; counts how many were begun.
PassCounts plan(PassPlan& plan, std::uint32_t views, double usual, double fill,
                const std::function<std::uint64_t(std::uint32_t view)>& entries) {
    plan.begin(views, usual, fill);
    for (std::uint32_t first = 0; first < views;) {
        const std::uint32_t end = plan.endFrom(first, kRoom);
        EXPECT_GT(end, first);
        EXPECT_LE(end, views);
        std::uint64_t taken = 0;
        for (std::uint32_t view = first; view < end; ++view) taken += entries(view);
        if (taken > kRoom && end - first > 1) {
            plan.overflowed(first, end, kRoom);
        } else {
            plan.passed(first, end, taken, kRoom);
            first = end;
        }
    }
    return plan.counts();
}

TEST(PassPlan, TakesAllViewsAtOnceWhereTheyAreExpectedToFit) {
    PassPlan p;
    const PassCounts got = plan(p, 50, 10, 0.9, [](auto) { return 10; });
    EXPECT_EQ(got.made, 1u);
    EXPECT_EQ(got.overflows, 0u);
    EXPECT_EQ(got.falseAlarms, 0u);
}

TEST(PassPlan, FillsAShareOfTheRoom) {
    PassPlan p;
    // 90 views fill 0.9 of it: 5 passes of 400 views. With all of it, 4.
    EXPECT_EQ(plan(p, 400, 10, 0.9, [](auto) { return 10; }).made, 5u);
    PassPlan full;
    const PassCounts got = plan(full, 400, 10, 1, [](auto) { return 10; });
    EXPECT_EQ(got.made, 4u);
    EXPECT_EQ(got.overflows, 0u);
    EXPECT_EQ(got.predictionError, 0);
}

TEST(PassPlan, OnlyWhatOverflowsIsHalved) {
    PassPlan p;
    // A view takes 20 where 5 were usual: 180 at once, then 90, then 45; all others as many.
    const PassCounts got = plan(p, 500, 5, 0.9, [](auto) { return 20; });
    EXPECT_EQ(got.overflows, 2u);
    EXPECT_EQ(got.made, 12u);
}

TEST(PassPlan, TheFrameBeforeTellsWhereViewsTakeMore) {
    PassPlan p;
    const auto entries = [](std::uint32_t view) { return view < 500 ? 2u : 40u; };
    const PassCounts first = plan(p, 1000, 2, 0.9, entries);
    EXPECT_GT(first.overflows, 0u);
    const PassCounts second = plan(p, 1000, 2, 0.9, entries);
    EXPECT_EQ(second.overflows, 0u);
    EXPECT_LT(second.predictionError, 0.2);
    EXPECT_LT(second.predictionError, first.predictionError);
    // Places are shares of all views: half as many are as well known.
    const PassCounts fewer =
        plan(p, 500, 2, 0.9, [](std::uint32_t view) { return view < 250 ? 2u : 40u; });
    EXPECT_EQ(fewer.overflows, 0u);
}

// [TSK13 eq. 3]: the largest of narrow and wide means.
TEST(PassPlan, ExpectsTheMostOfWhatWasSeen) {
    PassPlan p;
    p.begin(1000, 1, 1);
    p.passed(0, 100, 1000, kRoom);  // 10 a view
    EXPECT_NEAR(p.expected(100, 200), 1000, 1e-9);
    p.passed(100, 200, 200, kRoom);  // 2 a view: 6 in the mean
    EXPECT_NEAR(p.expected(200, 300), 600, 1e-9);
    p.passed(200, 220, 200, kRoom);  // 10 a view again: the narrowest is largest
    EXPECT_NEAR(p.expected(220, 230), 100, 1e-9);
}

TEST(PassPlan, CountsSplitsThatWereNotNeeded) {
    PassPlan p;
    // 100 a view were expected, 1 was had: nine views first, then as many as there are.
    const PassCounts got = plan(p, 100, 100, 0.9, [](auto) { return 1; });
    EXPECT_EQ(got.made, 2u);
    EXPECT_EQ(got.falseAlarms, 1u);
    // Where maps ended a pass, its entries do not say that it was needless.
    PassPlan cut;
    cut.begin(100, 1, 1);
    cut.passed(0, 50, 50, kRoom);
    cut.passed(50, 100, 50, kRoom);
    EXPECT_EQ(cut.counts().falseAlarms, 0u);
}

TEST(PassPlan, AnOverflowKnownLateHalvesTheNextFrame) {
    PassPlan p;
    p.begin(100, 1, 0.9);
    EXPECT_EQ(p.endFrom(0, kRoom), 100u);
    p.overflowed(0, 100, kRoom);
    p.begin(100, 1, 0.9);
    EXPECT_EQ(p.endFrom(0, kRoom), 50u);
}

TEST(PassPlan, ASingleViewIsTriedInAnyCase) {
    PassPlan p;
    const PassCounts got = plan(p, 3, 1e9, 0.5, [](auto) { return 5000; });
    EXPECT_EQ(got.made, 3u);
}

}  // namespace
}  // namespace mv
