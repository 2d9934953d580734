#pragma once
// Everything a user can make the viewer do, named once: keys, menus, the help overlay and tests are
// made from this list. ui/ names actions, app/ performs them.

#include <span>
#include <string_view>

namespace mv {

enum class Action {
    quit,
    screenshotPng,
    playPause,
    stepBackward,
    stepForward,
    slower,
    faster,
    restart,
    nextMethod,
    previousMethod,
    toggleSplit,
    splitLeft,
    splitRight,
    frameScene,
    resetCamera,
    nextCamera,
    previousCamera,
    exposureDown,
    exposureUp,
    exposureReset,
    nextDebugView,
    previousDebugView,
    hideUi,
    help,
    vsync,
};

struct ActionInfo {
    Action action;
    std::string_view name;  // "Next method"
    std::string_view key;   // "Shift+M"; several are separated by a space; "" = none
    std::string_view menu;  // "View" etc.: the menu it stands in
    std::string_view help;  // one sentence
};

std::span<const ActionInfo> actionsTable();
const ActionInfo& infoOf(Action action);

// What the mouse and held keys do, for the help overlay only.
struct ControlInfo {
    std::string_view control, help;
};
std::span<const ControlInfo> controlsTable();

}  // namespace mv
