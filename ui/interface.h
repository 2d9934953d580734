#pragma once
// The window's panels. They edit Settings, read FrameStatistics and Model (ui/model.h), and return
// what the user asked for as Requests; they touch no GL. One Interface belongs to one ImGui
// context.

#include <memory>
#include <optional>
#include <set>
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

// A number as it stands in the window, and where Session::numbers() and --stats have it: JSON
// pointers, of several the sum.
struct Figure {
    std::string text;
    std::vector<std::string> places;
};

// A TrueType or OpenType file as it is, and which of its faces.
struct FontFile {
    std::vector<unsigned char> data;
    int face = 0;
};
// Characters beyond Latin to draw, and where to look for those that the built-in font lacks.
struct MoreGlyphs {
    std::set<char32_t> characters;
    std::vector<FontFile> fonts;
};

// Colours, spacing and the font at its size times the scale: once after ImGui::CreateContext and
// again when the scale or the glyphs change, before the next NewFrame. The font atlas is built
// anew: a backend that holds its texture must destroy it before and create it after.
void applyStyle(float scale, const MoreGlyphs& more = {});

// Between ImGui::NewFrame and Interface::draw: the keyboard goes to the menu bar, or from it to the
// picture. Dear ImGui's own Alt knows only the bars of the window that has the keyboard.
void toggleMenuBar();

// `scale`, or the largest below it with which the parts of such a window have room; but not below 1
// for that.
float fittingScale(int windowWidth, int windowHeight, float scale);
Viewport pictureViewport(int windowWidth, int windowHeight, float scale, const Model& model);

class Interface {
  public:
    Interface();
    ~Interface();
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;

    // After each rendered frame: what the profiler's history is made from. made: the settings in
    // effect, of a draft or of the whole picture.
    void addFrame(const FrameStatistics& statistics, const Settings& made, bool draft);
    void forgetFrames();  // a new scene's times are no continuation
    // While frozen, addFrame() does nothing.
    void freezeFrames(bool frozen);

    // Between ImGui::NewFrame and ImGui::Render.
    Requests draw(Settings& settings, Model& model, const FrameStatistics& statistics,
                  int windowWidth, int windowHeight, float scale);

    // Where the last draw placed its items.
    const std::vector<ItemRect>& itemRects() const;
    std::optional<ItemRect> findItem(std::string_view name) const;
    // Numbers of the last draw that saved numbers hold too: for tests, which compare them.
    const std::vector<Figure>& figures() const;
    // Characters in names, paths and messages of the last draw that the font has no glyph for.
    const std::set<char32_t>& missingCharacters() const;
    // Texts of the last draw that were wider than their place: for tests, which want none.
    const std::vector<std::string>& clippedTexts() const;
    // Named items of the last draw that no scrolling brings into sight: for tests, too.
    const std::vector<std::string>& outOfReach() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace mv::ui
