#pragma once
// The window's panels. They edit Settings and read FrameStatistics; whatever else a user asks for
// is an action (megaviews/settings/actions.h) that the application performs.

#include <string>
#include <vector>

#include "megaviews/settings/actions.h"
#include "megaviews/settings/settings.h"
#include "megaviews/settings/statistics.h"

namespace mv::ui {

// Everything the panels show that is neither a setting nor a statistic.
struct Model {
    std::string sceneName;
    std::string sceneSummary;           // "262,267 triangles, 3.1 M octree leaves"
    std::string renderer;               // GL renderer string
    std::vector<std::string> cameras;   // names; the settings hold the chosen one
    std::vector<std::string> notices;   // what the program decided for the user: "software ..."
    std::vector<std::string> warnings;  // of the scene
    std::string error;                  // shown in a dialog until dismissed
    std::string loadingStage;           // non-empty while a scene loads
    float loadingFraction = 0;
    bool playing = true;
    double speed = 1;       // of the animation
    double animationS = 0;  // its duration, 0 = nothing moves
    double timeS = 0;
    double framesPerSecond = 0;
    std::vector<float> frameMs;  // the last frames, oldest first
    bool hidden = false;
    bool help = false;
};

// What the user asked for while the panels were drawn.
struct Requests {
    std::vector<Action> actions;
    bool timeChanged = false;  // Model::timeS was scrubbed
    bool errorDismissed = false;
};

// Where the picture goes, in window pixels from the top left.
struct Viewport {
    int x = 0, y = 0, width = 1, height = 1;
};

// Colours, spacing and font size; once, and again when the scale changes.
void applyStyle(float scale);

Viewport pictureViewport(int windowWidth, int windowHeight, float scale, bool hidden);

// Between ImGui::NewFrame and ImGui::Render. Moving the split edits Settings::split.
Requests draw(Settings& settings, Model& model, const FrameStatistics& statistics, int windowWidth,
              int windowHeight, float scale);

}  // namespace mv::ui
