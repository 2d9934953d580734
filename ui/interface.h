#pragma once
// The window's panels. They edit Settings, read FrameStatistics and Model (ui/model.h), and return
// what the user asked for as Requests; they touch no GL. One Interface belongs to one ImGui
// context.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "megaviews/settings/settings.h"
#include "megaviews/settings/statistics.h"
#include "ui/model.h"

namespace mv::ui {

// Where the picture goes, in window pixels from the top left.
struct Viewport {
    int x = 0, y = 0, width = 1, height = 1;
};

// Where something that can be clicked was drawn last, by name: a setting's key ("vpls"), an
// action's id ("next-method"), a panel ("panel:controls", "panel:dock", "panel:status",
// "panel:menu"), what stands over the picture ("plate:loading"), an instrument's tab ("tab:views"),
// a menu ("menu:File"), or a part of a panel
// ("views.pick-a").
struct ItemRect {
    std::string name;
    float x = 0, y = 0, width = 0, height = 0;  // window pixels
    float centerX() const { return x + width / 2; }
    float centerY() const { return y + height / 2; }
};

// Colours, spacing and the font at its size times the scale: once after ImGui::CreateContext and
// again when the scale changes, before the next NewFrame. The font atlas is built anew: where a
// backend holds its texture already, call ImGui_ImplOpenGL3_DestroyFontsTexture() first.
void applyStyle(float scale);

Viewport pictureViewport(int windowWidth, int windowHeight, float scale, const Model& model);

class Interface {
  public:
    Interface();
    ~Interface();
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;

    // After each rendered frame: what the profiler's history is made from.
    void addFrame(const FrameStatistics& statistics);
    void forgetFrames();  // a new scene's times are no continuation

    // Between ImGui::NewFrame and ImGui::Render.
    Requests draw(Settings& settings, Model& model, const FrameStatistics& statistics,
                  int windowWidth, int windowHeight, float scale);

    // Of the last draw.
    const std::vector<ItemRect>& itemRects() const;
    std::optional<ItemRect> findItem(std::string_view name) const;
    // Texts of the last draw that were wider than their place: for tests, which want none.
    const std::vector<std::string>& clippedTexts() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace mv::ui
