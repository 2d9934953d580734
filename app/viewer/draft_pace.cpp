#include "app/viewer/draft_pace.h"

#include <algorithm>

namespace mv {
namespace {

// What is within these of the wanted time stays, so that the size does not swing.
constexpr double kFast = 0.75, kSlow = 1.25;
constexpr double kMostGrowth = 1.5;  // at once

}  // namespace

void DraftPace::note(double seconds, double pixels, double mostPixels) {
    if (!adapts_) return;
    if (pixels != noted_) {
        noted_ = pixels;
        drafts_ = -1;
    }
    if (++drafts_ == 0) return;
    shortest_ = drafts_ == 1 ? seconds : std::min(shortest_, seconds);
    longest_ = drafts_ == 1 ? seconds : std::max(longest_, seconds);
    if (drafts_ < kDrafts) return;
    drafts_ = 0;
    const bool slow = shortest_ > kSlow * kWantedS, fast = longest_ < kFast * kWantedS;
    if (!slow && !fast) return;
    // As if time grew with the pixels alone; the next step corrects what does not.
    const double wanted =
        pixels * (slow ? kWantedS / shortest_ : std::min(kWantedS / longest_, kMostGrowth));
    pixels_ = std::max(std::min(wanted, mostPixels), kLeastPixels);
}

}  // namespace mv
