#include "app/viewer/frame_run.h"

namespace mv {

void FrameRun::begin(int frames, const Settings& settings, const FrameMoment& moment) {
    *this = {};
    left_ = frames;
    warmUpsLeft_ = kWarmUps;
    settings_ = settings;
    moment_ = moment;
}

bool FrameRun::keepOnlyOf(const Settings& settings, const FrameMoment& moment) {
    // Display and instruments do not change what a frame takes, nor do the points of its pixels and
    // the views of further sets, of which a whole frame has the first alone.
    PictureSettings picture = settings.picture;
    picture.pixelSamples = settings_.picture.pixelSamples;
    picture.freshViews = settings_.picture.freshViews;
    if (settings.light() == settings_.light() && picture == settings_.picture &&
        moment == moment_) {
        return false;
    }
    const bool measured = statistics_.frames() > 0;
    if (running() || measured) *this = {};
    return measured;
}

bool FrameRun::advance(LivePicture& picture, const Settings& settings, const FrameInput& input) {
    FrameInput alone = input;
    alone.usesHistory = false;  // as without a window, where every frame is made from nothing
    if (!picture.renderWhole(settings, alone)) return false;
    if (warmUpsLeft_ > 0) {
        --warmUpsLeft_;
        return false;
    }
    statistics_.add(picture.statistics());
    --left_;
    return true;
}

}  // namespace mv
