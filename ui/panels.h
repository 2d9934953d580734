#pragma once
// Every part of the window, one source file each, in the order they are drawn.

#include "ui/context.h"

namespace mv::ui {

// ---------------------------------------------------------------- frame of the window
void menuBar(Context& c);
void statusBar(Context& c);
void controlsPanel(Context& c);
void dock(Context& c);

// ---------------------------------------------------------------- sections of the controls
void transport(Context& c);
void cameraControls(Context& c);
void environmentControls(Context& c);
void lightControls(Context& c);
void methodControls(Context& c);

// ---------------------------------------------------------------- instruments, within the dock
void profilerPanel(Context& c);
void traversalPanel(Context& c);
void memoryPanel(Context& c);
void viewsPanel(Context& c);
void pixelPanel(Context& c);
void stepsPanel(Context& c);
void errorsPanel(Context& c);

// ---------------------------------------------------------------- over the picture
void splitOverlay(Context& c);
void lightHandles(Context& c);
void legendOverlay(Context& c);
void shaderErrors(Context& c);
void outsideHint(Context& c);
void tour(Context& c);
void pictureOverlay(Context& c);
void loadingOverlay(Context& c);
void toasts(Context& c);

// ---------------------------------------------------------------- over everything
void helpOverlay(Context& c);
void browserDialog(Context& c);
void commandPalette(Context& c);
void aboutScene(Context& c);
void startPage(Context& c);
void errorDialog(Context& c);

// ---------------------------------------------------------------- characters that the font lacks
void noteTyped(Context& c);    // before fields take what is typed
void noteMissing(Context& c);  // in what all of these show

// A window that is part of the frame: no title, never moved, square corners.
inline constexpr ImGuiWindowFlags kFixedWindow =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
    ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoFocusOnAppearing;
bool beginFixed(Context& c, const char* id, const Rect& rect, ImGuiWindowFlags flags = 0);
void endFixed();
// A small dark plate over the picture; `pivot` says which of its corners stands at x, y. It sizes
// itself to what is in it, and gives way to plates drawn before it: up where its pivot is at the
// bottom, else down; but not from under the mouse, whose press would miss what it is for.
bool beginPlate(Context& c, const char* id, float x, float y, ImVec2 pivot,
                ImGuiWindowFlags flags = 0);
void endPlate(Context& c, const char* id);
// A modal window in the middle, `width` pixels wide at scale 1 where there is room, as high as what
// is in it. Ended by ImGui::EndPopup() where true. open: cleared by the cross in its title;
// nullptr: there is none.
bool beginDialog(Context& c, const char* title, const char* name, float width, bool* open);

Action actionOf(Instrument instrument);

}  // namespace mv::ui
