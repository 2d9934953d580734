#pragma once
// Pictures, views, maps and statistics without a window: what --headless does, with the panels
// (--ui) or without, and after a script (--actions) or at once.

#include "app/common/run_options.h"
#include "megaviews/settings/settings.h"

namespace mv {

// Loads the scene, does options.actions and renders options.frames frames, 1/frameRate apart, from
// the time that the script left, or settings.timeS, on. Every frame is rendered from nothing, so
// that times are those of a whole frame. Writes what the options name, the last frame's views, maps
// and measurements among it; the files' names go to standard output. Returns ok, or throws
// Error(checkFailed) if a picture holds NaN or infinity or misses a threshold, or Cancelled with
// what was finished written and marked partial.
int runHeadless(const RunOptions& options, const Settings& settings);

}  // namespace mv
