#pragma once
// The whole window, panels included, drawn without a display: for pictures of the interface and for
// its tests.

#include "app/common/run_options.h"

namespace mv {

// Loads the scene, performs options.actions, waits until the picture stands still and writes what
// the window would show to each output. Prints the names of the files.
int runHeadlessUi(const RunOptions& options, const Settings& settings);

}  // namespace mv
