// How large a draft is, from how long drafts have taken.

#include "app/viewer/draft_pace.h"

#include <gtest/gtest.h>

namespace mv {
namespace {

constexpr double kPicture = 1920 * 1080;

// Drafts on a machine where one takes fixedS and so long a pixel; the last one's time.
double draw(DraftPace& pace, int drafts, double fixedS, double perPixelS) {
    double seconds = 0;
    for (int i = 0; i < drafts; ++i) {
        seconds = fixedS + perPixelS * pace.pixels();
        pace.note(seconds, pace.pixels(), kPicture);
    }
    return seconds;
}

TEST(DraftPace, SettlesNearTheWantedTime) {
    for (const double fixedS : {0.0, 0.02, 0.08}) {
        for (const double perPixelS : {3e-7, 1e-6, 1.6e-6}) {
            DraftPace pace(true);
            EXPECT_NEAR(draw(pace, 60, fixedS, perPixelS), DraftPace::kWantedS,
                        0.26 * DraftPace::kWantedS)
                << fixedS << " s and " << perPixelS << " s a pixel";
            const double settled = pace.pixels();
            draw(pace, 60, fixedS, perPixelS);
            EXPECT_EQ(pace.pixels(), settled) << "and does not swing";
        }
    }
}

TEST(DraftPace, StaysWithinTheLeastAndThePicture) {
    DraftPace slow(true), fast(true);
    draw(slow, 60, 1, 1e-5);
    EXPECT_EQ(slow.pixels(), DraftPace::kLeastPixels);
    draw(fast, 100, 0.001, 1e-9);
    EXPECT_EQ(fast.pixels(), kPicture);
}

TEST(DraftPace, OneSlowDraftChangesNothing) {
    DraftPace pace(true);
    const double atEase = DraftPace::kWantedS / pace.pixels();
    draw(pace, 20, 0, atEase);
    const double before = pace.pixels();
    for (int i = 0; i < 20; ++i) {
        pace.note(i % 5 == 0 ? 3 : DraftPace::kWantedS, before, kPicture);
        ASSERT_EQ(pace.pixels(), before);
    }
    draw(pace, 20, 0, 2 * atEase);
    EXPECT_NEAR(pace.pixels(), before / 2, 0.01 * before) << "several do";
}

TEST(DraftPace, IsTheSameForAllWhereItDoesNotAdapt) {
    DraftPace pace(false);
    draw(pace, 60, 1, 1e-5);
    EXPECT_EQ(pace.pixels(), DraftPace::kFirstPixels);
}

}  // namespace
}  // namespace mv
