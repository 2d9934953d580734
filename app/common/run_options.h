#pragma once
// What a run is asked to do beside the picture's Settings: where input and output are, how many
// frames, what to print. Filled from the command line, see command_line.h.

#include <optional>
#include <string>
#include <vector>

#include "app/common/script.h"
#include "megaviews/measure/measurement.h"
#include "megaviews/settings/settings.h"
#include "renderer/gl/context.h"

namespace mv {

enum class GlPlatform { automatic, window, egl };
enum class InfoFormat { none, text, json };
enum class LogLevel { debug, info, warning, error, quiet };

struct RunOptions {
    std::string scene = "builtin:atrium";
    bool sceneGiven = false;
    std::vector<std::string> inputs;  // files the line was made of: configuration, state, script
    bool useCache = true;

    // output
    bool headless = false;
    GlPlatform gl = GlPlatform::automatic;
    gl::ContextWish glWish;
    std::vector<std::string> outputs;  // .png or .exr; {frame} and {frame:04} are replaced
    int frames = 1;
    int warmup = 0;         // frames rendered before the first one that counts
    double frameRate = 30;  // frames a second of the animation
    std::string statsFile, saveViewsFile, saveMapsFile, saveSceneFile;
    std::string saveStateFile;     // written when the program ends
    std::string referencesFolder;  // of the methods exact and pathtraced; empty: in the cache
    int mapReferences = 0;         // views whose exact maps are wanted
    bool deterministic = false;    // the window steps by 1/frameRate; headless always does

    // window
    double uiScale = 0;  // 0: from the display
    bool vsync = true;
    bool ui = false;         // headless: the whole window, panels included
    bool tour = false;       // the first of the actions begins it
    script::Script actions;  // performed once the scene stands

    MeasureOptions measure;

    // inform
    InfoFormat info = InfoFormat::none;
    std::string list;  // "cameras", "animations", "methods", "views", "presets", "actions",
                       // "metrics"; or empty
    LogLevel logLevel = LogLevel::info;
    std::string logFile;

    // From --load-state.
    std::optional<bool> playing;
    double speed = 1;
    std::string sceneHash;  // of the state's scene, if it is the one to load

    // Keys of the settings that a configuration file, a preset, a state or the command line gave:
    // what a program may choose for the user leaves these alone.
    std::vector<std::string> given;
    bool isGiven(const std::string& key) const;
    // Whether it asks for anything that only a run without a window gives. A reference alone and
    // exact maps are for the window's errors panel, too.
    bool wantsResults() const;
};

}  // namespace mv
