#include "megaviews/settings/actions.h"

#include <cassert>

namespace mv {
namespace {

using A = Action;

constexpr ActionInfo kActions[] = {
    {A::open, "Open", "Ctrl+O", "File", "Chooses a scene, a saved state or a picture to open."},
    {A::reload, "Reload scene", "Ctrl+R", "File", "Reads the scene's file again."},
    {A::loadState, "Load state", "Ctrl+L", "File",
     "Chooses a saved state, or a picture that carries one, and restores it."},
    {A::saveState, "Save state", "Ctrl+S", "File",
     "Writes scene, camera and settings to a file that Load state restores."},
    {A::saveScene, "Save scene", "Ctrl+E", "File",
     "Writes the scene as the picture shows it as a glTF file (.glb): its geometry, materials and "
     "lights, and as cameras the picture's, the bookmarks and the scene's own."},
    {A::screenshotPng, "Save picture", "F12", "File",
     "Writes the picture without the panels as a PNG file that carries its settings."},
    {A::screenshotExr, "Save radiance", "Shift+F12", "File",
     "Writes the picture's linear radiance as an EXR file that carries its settings."},
    {A::screenshotWindow, "Save window", "Ctrl+F12", "File",
     "Writes the whole window with its panels as a PNG file."},
    {A::saveNumbers, "Save numbers", "Ctrl+Shift+S", "File",
     "Writes the frame's times, counts, memory and errors as JSON, as --stats does, and the "
     "numbers of the open panel."},
    {A::copyNumbers, "Copy numbers", "", "File", "Puts the same JSON on the clipboard."},
    {A::copyTable, "Copy numbers as CSV", "", "File",
     "Puts the same on the clipboard as lines for a spreadsheet: place, value."},
    {A::measureFrames, "Measure frames", "", "File",
     "Renders whole frames of the picture as it stands and measures them, as --frames does; again "
     "ends it. Saved numbers are then theirs."},
    {A::startPage, "Start page", "", "File",
     "Shows the built-in scenes, files that were open lately and those that lie near."},
    {A::aboutScene, "About the scene", "", "File",
     "Lists what the scene's file uses, what of it is not used, what was added, and warnings."},
    {A::reloadShaders, "Reload shaders", "F5", "File",
     "Compiles the shaders again; a broken one is shown and the last good one goes on."},
    {A::quit, "Quit", "Ctrl+Q", "File", "Leaves the program."},
    {A::undo, "Undo", "Ctrl+Z", "Edit", "Takes back the last change of a setting.", true},
    {A::redo, "Redo", "Ctrl+Shift+Z", "Edit", "Makes the change again that was taken back.", true},
    {A::resetSettings, "Reset all settings", "", "Edit",
     "Sets everything but camera and scene to its default."},
    {A::presetFast, "Preset: fast", "", "Edit", "Few views and samples, for moving about."},
    {A::presetBalanced, "Preset: balanced", "", "Edit", "The defaults of the method."},
    {A::presetQuality, "Preset: quality", "", "Edit", "Many views and samples, larger maps."},
    {A::presetBench, "Preset: bench", "", "Edit", "What measurements are made with."},
    {A::presetPaperMegaviews, "Preset: paper MegaViews", "", "Edit",
     "MegaViews with the rules as published."},
    {A::presetPaperManylods, "Preset: paper ManyLoDs", "", "Edit",
     "ManyLoDs with the rules as published."},
    {A::playPause, "Play or pause", "Space", "Animation", "Starts or stops the animation."},
    {A::stepBackward, "Step backward", "Left", "Animation",
     "Goes back by one thirtieth of a second.", true},
    {A::stepForward, "Step forward", "Right", "Animation", "Goes on by one thirtieth of a second.",
     true},
    {A::slower, "Slower", "Down", "Animation", "Halves the speed of the animation."},
    {A::faster, "Faster", "Up", "Animation", "Doubles the speed of the animation."},
    {A::restart, "Restart", "", "Animation", "Goes back to the start time."},
    {A::pauseRendering, "Pause rendering", "Ctrl+Space", "Animation",
     "Keeps the picture as it is, or goes on."},
    {A::nextMethod, "Next method", "M", "Method", "Lights the scene by the next method."},
    {A::previousMethod, "Previous method", "Shift+M", "Method",
     "Lights the scene by the previous method."},
    {A::toggleSplit, "Side by side", "B", "Method",
     "Shows a second method right of a split, with the same views and seed."},
    {A::splitLeft, "Move split left", "Shift+Left", "Method", "Moves the split to the left.", true},
    {A::splitRight, "Move split right", "Shift+Right", "Method", "Moves the split to the right.",
     true},
    {A::swapSides, "Swap sides", "", "Method", "Exchanges what is left and right of the split."},
    {A::showOtherSide, "Show other side", "X", "Method",
     "While held, shows in the whole picture the side that has less of it, the left one of "
     "halves."},
    {A::flipSides, "Flip sides", "Shift+X", "Method",
     "Shows the left side in the whole picture, and the right one when pressed again."},
    {A::nextDifference, "Next difference", "N", "Method",
     "Shows the difference of both sides: absolute, signed, relative, FLIP, off."},
    {A::loadReference, "Load reference", "", "Method",
     "Chooses a picture that the errors panel measures both sides against."},
    {A::keepReference, "Keep left as reference", "", "Method",
     "Keeps the left side's picture; the errors panel measures what comes after against it."},
    {A::frameScene, "Frame scene", "F", "Camera",
     "Moves the camera so that all of the scene is seen."},
    {A::resetCamera, "Reset camera", "Enter", "Camera", "Goes back to where the camera started."},
    {A::nextCamera, "Next camera", "C", "Camera", "Takes the scene's next camera."},
    {A::previousCamera, "Previous camera", "Shift+C", "Camera",
     "Takes the scene's previous camera."},
    {A::storeBookmark1, "Store bookmark 1", "Ctrl+1", "Bookmarks",
     "Remembers the camera under 1, for this scene."},
    {A::storeBookmark2, "Store bookmark 2", "Ctrl+2", "Bookmarks",
     "Remembers the camera under 2, for this scene."},
    {A::storeBookmark3, "Store bookmark 3", "Ctrl+3", "Bookmarks",
     "Remembers the camera under 3, for this scene."},
    {A::storeBookmark4, "Store bookmark 4", "Ctrl+4", "Bookmarks",
     "Remembers the camera under 4, for this scene."},
    {A::storeBookmark5, "Store bookmark 5", "Ctrl+5", "Bookmarks",
     "Remembers the camera under 5, for this scene."},
    {A::storeBookmark6, "Store bookmark 6", "Ctrl+6", "Bookmarks",
     "Remembers the camera under 6, for this scene."},
    {A::storeBookmark7, "Store bookmark 7", "Ctrl+7", "Bookmarks",
     "Remembers the camera under 7, for this scene."},
    {A::storeBookmark8, "Store bookmark 8", "Ctrl+8", "Bookmarks",
     "Remembers the camera under 8, for this scene."},
    {A::storeBookmark9, "Store bookmark 9", "Ctrl+9", "Bookmarks",
     "Remembers the camera under 9, for this scene."},
    {A::recallBookmark1, "Bookmark 1", "1", "Bookmarks", "Goes to the camera remembered under 1."},
    {A::recallBookmark2, "Bookmark 2", "2", "Bookmarks", "Goes to the camera remembered under 2."},
    {A::recallBookmark3, "Bookmark 3", "3", "Bookmarks", "Goes to the camera remembered under 3."},
    {A::recallBookmark4, "Bookmark 4", "4", "Bookmarks", "Goes to the camera remembered under 4."},
    {A::recallBookmark5, "Bookmark 5", "5", "Bookmarks", "Goes to the camera remembered under 5."},
    {A::recallBookmark6, "Bookmark 6", "6", "Bookmarks", "Goes to the camera remembered under 6."},
    {A::recallBookmark7, "Bookmark 7", "7", "Bookmarks", "Goes to the camera remembered under 7."},
    {A::recallBookmark8, "Bookmark 8", "8", "Bookmarks", "Goes to the camera remembered under 8."},
    {A::recallBookmark9, "Bookmark 9", "9", "Bookmarks", "Goes to the camera remembered under 9."},
    {A::exposureDown, "Darker", "-", "View", "Lowers the exposure by a quarter of a stop.", true},
    {A::exposureUp, "Brighter", "=", "View", "Raises the exposure by a quarter of a stop.", true},
    {A::exposureReset, "Fit exposure", "0", "View", "Fits the exposure to the picture again."},
    {A::nextDebugView, "Next debug view", "]", "View", "Shows the next debug view.", true},
    {A::previousDebugView, "Previous debug view", "[", "View", "Shows the previous debug view.",
     true},
    {A::hideUi, "Hide panels", "F2", "View", "Hides the panels, or shows them again."},
    {A::largerInterface, "Larger interface", "Ctrl+=", "View", "Draws panels and text larger."},
    {A::smallerInterface, "Smaller interface", "Ctrl+-", "View", "Draws panels and text smaller."},
    {A::fullScreen, "Full screen", "F11", "View", "Fills the screen, or leaves it again."},
    {A::vsync, "Vertical sync", "V", "View", "Waits for the display between frames, or does not."},
    {A::showProfiler, "Profiler", "P", "Instruments", "Shows how long each stage takes."},
    {A::showTraversal, "Traversal", "T", "Instruments",
     "Shows what happened to the pairs of scene and view nodes."},
    {A::showMemory, "Memory", "Y", "Instruments", "Shows what lies in the GPU's memory."},
    {A::showViews, "Views", "L", "Instruments",
     "Shows the views, their maps, and what two of them share."},
    {A::showPixel, "Pixel", "I", "Instruments",
     "Shows what a pixel is made from; a click picks one."},
    {A::showSteps, "Steps", "U", "Instruments", "Walks through the traversal step by step."},
    {A::showErrors, "Errors", "K", "Instruments",
     "Measures the right side against the left, and both against a reference."},
    {A::stepTraversal, "Next step", ".", "Instruments", "Goes on to the traversal's next step.",
     true},
    {A::stepTraversalBack, "Previous step", ",", "Instruments",
     "Goes back to the traversal's previous step.", true},
    {A::tour, "Tour", "", "Help",
     "Five steps from what a view is to what the error is; begins anew while it is taken."},
    {A::commands, "Commands", "Ctrl+K", "Help",
     "Finds an action by a part of its name, and performs it."},
    {A::help, "Help", "F1 ?", "Help", "Shows the keys and what they do."},
};

constexpr ControlInfo kControls[] = {
    {"Left drag", "Looks around in a room; from outside, orbits around the point looked at."},
    {"Middle or Shift drag", "Moves the camera sideways."},
    {"Wheel", "Moves nearer or away; while flying, sets the speed."},
    {"Right drag", "Looks around."},
    {"W A S D Q E", "Flies forward, left, back, right, down and up, through walls too."},
    {"Shift, Ctrl held", "Flies faster, slower; Ctrl only with the right button held."},
    {"Alt, F10", "Opens the menu bar for the keyboard; arrows and Space or Enter choose."},
    {"Ctrl+Tab held",
     "Chooses a panel for the keyboard; arrows move in it, Space presses, or holds a slider for "
     "the arrows, Enter types a value."},
    {"Escape", "Leaves a list or a field, then the panel: keys are the picture's again."},
    {"Ctrl+click", "On a slider: types a number, such as 64K."},
};

}  // namespace

std::span<const ActionInfo> actionsTable() { return kActions; }
std::span<const ControlInfo> controlsTable() { return kControls; }

std::string idOf(const ActionInfo& action) {
    std::string id;
    for (const char c : action.name) {
        if (c == ' ') {
            id += '-';
        } else if (c != ':') {
            id += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
        }
    }
    return id;
}

const ActionInfo* findAction(std::string_view id) {
    for (const ActionInfo& info : kActions) {
        if (idOf(info) == id) return &info;
    }
    return nullptr;
}

const ActionInfo& infoOf(Action action) {
    for (const ActionInfo& info : kActions) {
        if (info.action == action) return info;
    }
    assert(false && "every action stands in the table");
    return kActions[0];
}

}  // namespace mv
