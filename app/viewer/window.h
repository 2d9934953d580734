#pragma once
// The window: GLFW and Dear ImGui around FrameRenderer. Loads the scene on a worker thread, turns
// input into actions, settings and camera motion, and shows the picture.

#include "app/common/run_options.h"
#include "megaviews/settings/settings.h"

namespace mv {

// Runs until the window is closed; returns the exit code. Throws Error(ExitCode::graphics) if no
// window with OpenGL 4.5 can be made.
int runWindow(const RunOptions& options, const Settings& settings);

// Whether a display that a window could open on is named in the environment.
bool displayAvailable();

}  // namespace mv
