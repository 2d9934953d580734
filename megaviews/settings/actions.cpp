#include "megaviews/settings/actions.h"

#include <cassert>

namespace mv {
namespace {

using A = Action;

constexpr ActionInfo kActions[] = {
    {A::quit, "Quit", "Ctrl+Q", "File", "Leaves the program."},
    {A::screenshotPng, "Save picture", "F12", "File",
     "Writes the picture without the panels as a PNG file that carries its settings."},
    {A::playPause, "Play or pause", "Space", "Animation", "Starts or stops the animation."},
    {A::stepBackward, "Step backward", "Left", "Animation",
     "Goes back by one thirtieth of a second."},
    {A::stepForward, "Step forward", "Right", "Animation", "Goes on by one thirtieth of a second."},
    {A::slower, "Slower", "Down", "Animation", "Halves the speed of the animation."},
    {A::faster, "Faster", "Up", "Animation", "Doubles the speed of the animation."},
    {A::restart, "Restart", "", "Animation", "Goes back to the start time."},
    {A::nextMethod, "Next method", "M", "Method", "Lights the scene by the next method."},
    {A::previousMethod, "Previous method", "Shift+M", "Method",
     "Lights the scene by the previous method."},
    {A::toggleSplit, "Side by side", "B", "Method",
     "Shows a second method right of a split, with the same views and seed."},
    {A::splitLeft, "Move split left", "Shift+Left", "Method", "Moves the split to the left."},
    {A::splitRight, "Move split right", "Shift+Right", "Method", "Moves the split to the right."},
    {A::frameScene, "Frame scene", "F", "Camera",
     "Moves the camera so that all of the scene is seen."},
    {A::resetCamera, "Reset camera", "Enter", "Camera", "Goes back to where the camera started."},
    {A::nextCamera, "Next camera", "C", "Camera", "Takes the scene's next camera."},
    {A::previousCamera, "Previous camera", "Shift+C", "Camera",
     "Takes the scene's previous camera."},
    {A::exposureDown, "Darker", "-", "View", "Lowers the exposure by a quarter of a stop."},
    {A::exposureUp, "Brighter", "=", "View", "Raises the exposure by a quarter of a stop."},
    {A::exposureReset, "Fit exposure", "0", "View", "Fits the exposure to the picture again."},
    {A::nextDebugView, "Next debug view", "]", "View", "Shows the next debug view."},
    {A::previousDebugView, "Previous debug view", "[", "View", "Shows the previous debug view."},
    {A::hideUi, "Hide panels", "F2", "View", "Hides the panels, or shows them again."},
    {A::vsync, "Vertical sync", "V", "View", "Waits for the display between frames, or does not."},
    {A::help, "Help", "F1 ?", "Help", "Shows the keys and what they do."},
};

constexpr ControlInfo kControls[] = {
    {"Left drag", "Orbits around the point looked at."},
    {"Middle or Shift drag", "Moves the camera sideways."},
    {"Wheel", "Moves nearer or away; while flying, sets the speed."},
    {"Right drag", "Looks around."},
    {"W A S D Q E", "Flies forward, left, back, right, down and up."},
    {"Shift, Ctrl held", "Flies faster, slower."},
};

}  // namespace

std::span<const ActionInfo> actionsTable() { return kActions; }
std::span<const ControlInfo> controlsTable() { return kControls; }

const ActionInfo& infoOf(Action action) {
    for (const ActionInfo& info : kActions) {
        if (info.action == action) return info;
    }
    assert(false && "every action stands in the table");
    return kActions[0];
}

}  // namespace mv
