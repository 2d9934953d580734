#pragma once
// Pictures, views, maps and statistics without a window: what --headless does.

#include "app/common/run_options.h"
#include "megaviews/settings/settings.h"

namespace mv {

// Renders options.frames frames, 1/frameRate apart, from scene.timeS on, and writes what the
// options name; the files' names go to standard output. Every frame is rendered from nothing, so
// that times are those of a whole frame. Returns ok, checkFailed if a picture holds NaN or
// infinity, or interrupted with what was finished written and marked partial.
int runHeadless(const RunOptions& options, const Settings& settings);

}  // namespace mv
