#pragma once
// Lights as the panels show and move them: where each stands, where its handles are in the window,
// and the settings' text of those that stand elsewhere than in the scene's file.

#include <string>
#include <vector>

#include "app/common/scene_assets.h"
#include "ui/interface.h"
#include "ui/model.h"

namespace mv {

// How the lights are seen: handles lie in the window, and a light without a position has them at
// the point that the camera looks at.
struct LightView {
    const SceneAssets& assets;
    const FrameCamera& camera;
    float pivotDistance;  // root-cube units
    ui::Viewport viewport;
};

// All lights of a moment of the animation. `placements`: Settings' text.
std::vector<ui::LightRow> lightRows(const SceneAssets& assets, const std::string& placements,
                                    double timeS);
// Fills in where the handles are.
void placeHandles(const LightView& view, ui::LightRow& row);
// What a handle that is dragged asks for: it stays at its distance from the camera.
ui::LightEdit editOf(const LightView& view, const ui::LightRow& row, const ui::LightDrag& drag);
// The placements after an edit.
std::string edited(const std::string& placements, const ui::LightEdit& edit);

}  // namespace mv
