#pragma once
// Everything a user can make the viewer do, named once: keys, menus, the help overlay and tests are
// made from this list. ui/ names actions, app/ performs them.

#include <span>
#include <string>
#include <string_view>

namespace mv {

enum class Action {
    open,
    reload,
    saveState,
    saveScene,
    loadState,
    screenshotPng,
    screenshotExr,
    screenshotWindow,
    saveNumbers,
    copyNumbers,
    copyTable,
    measureFrames,
    aboutScene,
    startPage,
    reloadShaders,
    quit,
    playPause,
    stepBackward,
    stepForward,
    slower,
    faster,
    restart,
    pauseRendering,
    nextMethod,
    previousMethod,
    toggleSplit,
    splitLeft,
    splitRight,
    swapSides,
    showOtherSide,
    flipSides,
    nextDifference,
    loadReference,
    keepReference,
    frameScene,
    resetCamera,
    nextCamera,
    previousCamera,
    storeBookmark1,
    storeBookmark2,
    storeBookmark3,
    storeBookmark4,
    storeBookmark5,
    storeBookmark6,
    storeBookmark7,
    storeBookmark8,
    storeBookmark9,
    recallBookmark1,
    recallBookmark2,
    recallBookmark3,
    recallBookmark4,
    recallBookmark5,
    recallBookmark6,
    recallBookmark7,
    recallBookmark8,
    recallBookmark9,
    exposureDown,
    exposureUp,
    exposureReset,
    nextDebugView,
    previousDebugView,
    showProfiler,
    showTraversal,
    showMemory,
    showViews,
    showPixel,
    showSteps,
    showErrors,
    stepTraversal,
    stepTraversalBack,
    undo,
    redo,
    resetSettings,
    presetFast,
    presetBalanced,
    presetQuality,
    presetBench,
    presetPaperMegaviews,
    presetPaperManylods,
    hideUi,
    largerInterface,
    smallerInterface,
    fullScreen,
    vsync,
    tour,
    commands,
    help,
};

struct ActionInfo {
    Action action;
    std::string_view name;  // "Next method"
    std::string_view key;   // "Shift+M"; several are separated by a space; "" = none
    std::string_view menu;  // "View" etc.: the menu it stands in
    std::string_view help;  // one sentence
    bool repeats = false;   // again and again while its key is held
};

std::span<const ActionInfo> actionsTable();
// The name as scripts write it: "next-method"; findAction gives nullptr if there is none.
std::string idOf(const ActionInfo& action);
const ActionInfo* findAction(std::string_view id);
const ActionInfo& infoOf(Action action);

// What the mouse and held keys do, for the help overlay only.
struct ControlInfo {
    std::string_view control, help;
};
std::span<const ControlInfo> controlsTable();

}  // namespace mv
