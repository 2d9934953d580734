#include "app/viewer/live_picture.h"

#include <utility>

#include "renderer/gl/context.h"

namespace mv {
bool LivePicture::advance(const Settings& wanted, const Settings& draft, FrameInput input) {
    const FrameMoment& moment = input;
    const bool moved =
        !shown_ || outdated_ || wanted.light() != wanted_.light() || moment != input_;
    const bool changed = moved || wanted != wanted_ || input.countLevels != input_.countLevels;
    moving_ = moved && (shown_ || outdated_);
    if (moving_) settled_ = false;
    const bool asDraft = (moving_ || settled_) && gl::limits().software;
    input.moving = moving_;
    input.gathersInTurns = asDraft;
    // Once nothing moves any more, a draft gives way to the whole picture, with views of its own,
    // which then gathers more and more samples.
    if (!changed && !interrupted_) {
        if (draft_ && settled_) {
            still_ = true;
            return false;
        }
        const bool whole = !draft_ && statistics_.accumulatedFrames >= effective_.setsWanted();
        if (whole && !supplied_ && !renderer_.underWay() && !renderer_.mapsLag()) {
            still_ = !renderer_.awaitsReferences() && renderer_.wantedFlip() == 0;
            return false;
        }
    }
    still_ = false;
    input.refineLaggingMaps = !changed;
    makesDraft_ = asDraft;
    // The exposure is that of the first whole picture, until the camera rests where it is far off.
    if (!shown_) fitted_ = !asDraft;
    if (!asDraft && !std::exchange(fitted_, true)) renderer_.forgetExposure();
    const bool wholeAtRest = !asDraft && !moving_;
    input.adaptExposure = wholeAtRest && shown_ && input.camera != exposedFrom_;
    if (!renderAs(asDraft ? draft : wanted, input)) return false;
    if (wholeAtRest) exposedFrom_ = input.camera;
    draft_ = moving_ || asDraft;
    show(wanted, asDraft ? draft : wanted, input);
    return true;
}

bool LivePicture::renderAs(const Settings& settings, FrameInput& input) {
    if (!gl::limits().software) input.watch = {};
    interrupted_ = static_cast<bool>(input.watch);  // if it throws
    FrameStatistics statistics;
    if (!renderer_.render(settings, input, statistics)) return false;
    interrupted_ = false;
    statistics_ = std::move(statistics);
    return true;
}

void LivePicture::show(const Settings& wanted, const Settings& effective, const FrameInput& input) {
    shown_ = true;
    supplied_ = outdated_ = false;
    ++number_;
    wanted_ = wanted;
    effective_ = effective;
    input_ = input;
    input_.watch = {};
    input_.pose = {};
    input_.adaptExposure = input_.refineLaggingMaps = input_.gathersInTurns = false;
    input_.usesHistory = true;
}

void LivePicture::keep(const Settings& wanted) {
    if (!std::exchange(draft_, false)) wanted_ = wanted;
    still_ = shown_;
    // Instruments cannot read what failed. Once: it may fail again.
    outdated_ = !outdated_ && shown_;
}

void LivePicture::supply(Measuring& measuring) {
    if (shown_ && measuring.supply(renderer_, effective_, input_, moving_)) supplied_ = true;
}

bool LivePicture::renderWhole(const Settings& settings, FrameInput input) {
    input.reuse = false;
    makesDraft_ = false;
    if (!renderAs(settings, input)) return false;
    input.reuse = true;
    moving_ = draft_ = still_ = false;
    show(settings, settings, input);
    return true;
}

void LivePicture::complete(Measuring& measuring, bool countLevels,
                           const std::function<bool()>& wait) {
    FrameInput input = input_;
    if (countLevels) {
        input.countLevels = true;
        FrameStatistics counted;
        renderer_.render(effective_, input, counted);
        for (std::size_t i = 0; i < statistics_.methods.size(); ++i) {
            statistics_.methods[i].pairsPerLevel = std::move(counted.methods[i].pairsPerLevel);
        }
        input.countLevels = input_.countLevels;
    }
    while (true) {
        supply(measuring);
        if (!wait()) break;
        supply(measuring);
        const bool more = std::exchange(supplied_, false);
        if (!more && statistics_.accumulatedFrames >= effective_.setsWanted()) break;
        FrameStatistics next;
        renderer_.render(effective_, input, next);
        if (!more && next.accumulatedFrames <= statistics_.accumulatedFrames) break;  // full sums
        statistics_.accumulatedFrames = next.accumulatedFrames;
        statistics_.badPixels = next.badPixels;
        statistics_.differenceRange = next.differenceRange;
        statistics_.exposureEv = next.exposureEv;
        statistics_.memory = next.memory;
    }
    still_ = true;
    ++number_;
}

}  // namespace mv
