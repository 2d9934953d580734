#pragma once
// What every panel is handed: the data of the frame, the window's layout, and what panels remember
// from one frame to the next.

#include <imgui.h>

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "megaviews/settings/settings_table.h"
#include "ui/file_browser.h"
#include "ui/frame_history.h"
#include "ui/interface.h"

namespace mv::ui {

struct Rect {
    float x = 0, y = 0, width = 0, height = 0;
    float right() const { return x + width; }
    float bottom() const { return y + height; }
};

// Where everything goes, in window pixels. A window too narrow for dock, picture and controls
// shows the dock where the controls stand otherwise.
struct Layout {
    Rect menu, status, controls, dock, picture;
    bool controlsShown = true;
};
Layout layoutOf(float width, float height, float scale, const Model& model);

// Rectangles of what was drawn, by name, and texts that did not fit: for scripts and tests.
struct Drawn {
    std::vector<ItemRect> items;
    std::vector<std::string> clipped;
    std::vector<Figure> figures;
    std::vector<std::string> outOfReach;  // named items that no scrolling brings into sight
    std::set<char32_t> missing;           // characters that the font lacks
};

// How long a stage still takes, from how long it took so far.
class TimeLeft {
  public:
    // "about 12 s left"; empty while too little is known. done: share of the stage, 0..1.
    std::string after(const std::string& stage, float done);

  private:
    std::string stage_;
    float begun_ = 0;  // where it was first seen
    double sinceS_ = 0;
};

// What panels remember.
struct PanelState {
    FrameHistory history;
    bool frozen = false;
    Drawn drawn;
    FileBrowser browser;
    struct Palette {
        char typed[64] = "";
        int chosen = 0, first = 0;  // of the commands found: the one that Enter takes, the top one
    };
    Palette palette;
    std::string helpSearch;
    std::string typing;  // key of the setting whose value is being typed, in `typed`
    char typed[64] = "";
    bool typingBegins = false;
    bool helpWasOpen = false;
    TimeLeft loading, reference;
    bool traversalShares = false;
    int mapOfA = 0, mapOfB = 0;  // which of PickedView::maps
    float magnification = 8;
    std::vector<Rect> plates;  // that this frame has put over the picture
};

struct Context {
    Settings& settings;
    Model& model;
    const FrameStatistics& statistics;
    Requests& requests;
    PanelState& state;
    Layout layout;
    float scale = 1;

    float px(float atScale1) const { return atScale1 * scale; }
    void act(Action action) { requests.actions.push_back(action); }
    bool comparing() const { return settings.compare && statistics.methods.size() > 1; }
    Method methodOf(std::size_t side) const {
        return settings.side.at(settings.compare ? side : 0).method;
    }
    // Remembers where the last item is.
    void named(std::string_view name);
    void named(std::string_view name, const Rect& rect);
    // Remembers a number that is shown: the sum of what saved numbers hold at these places.
    void figure(std::string_view text, std::vector<std::string> places);
    // Remembers a text that is wider than its place.
    void checkFits(std::string_view text, float width);
};

}  // namespace mv::ui
