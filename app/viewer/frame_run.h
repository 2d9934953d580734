#pragma once
// Whole frames of the picture in the window, measured one after the other as --frames does without
// a window: at full quality, nothing taken from the frame before, the first to warm up.

#include "app/common/run_statistics.h"
#include "app/viewer/live_picture.h"

namespace mv {

class FrameRun {
  public:
    static constexpr int kWarmUps = 1;

    void begin(int frames, const Settings& settings, const FrameMoment& moment);
    void stop() { left_ = 0; }
    bool running() const { return left_ > 0; }
    // Ends the run and forgets its measurements if they are of another picture; true if there were
    // any.
    bool keepOnlyOf(const Settings& settings, const FrameMoment& moment);
    // Renders the next frame; true if it was measured. Throws as LivePicture::renderWhole.
    bool advance(LivePicture& picture, const Settings& settings, const FrameInput& input);

    const RunStatistics& statistics() const { return statistics_; }

  private:
    int left_ = 0, warmUpsLeft_ = 0;
    Settings settings_;
    FrameMoment moment_;
    RunStatistics statistics_;
};

}  // namespace mv
