#pragma once
// The panels without a window: made-up data in, ImGui's draw lists out, a mouse and a keyboard that
// tests move. drawTo() renders the last frame where there is an OpenGL context.

#include <imgui.h>

#include <string>
#include <utility>

#include "ui/interface.h"

struct ImGuiWindow;

namespace mv::ui {

// A scene, two methods, views, a pixel and steps, as an application would report them.
void fillExample(Settings& settings, Model& model, FrameStatistics& statistics);

class Screen {
  public:
    Screen(int width, int height, float scale);
    ~Screen();
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    // One frame; what it asks for is kept in `requests`.
    void frame(int count = 1);

    // Where to point: the middle of an item, which must be there.
    bool has(const std::string& item) const { return panels.findItem(item).has_value(); }
    void show(const std::string& item);  // scrolls the controls to it with the wheel
    void point(const std::string& item);
    void pointAt(float x, float y);
    const ImGuiWindow* tooltip() const;  // that is shown; null: none
    void click(const std::string& item, int button = 0);
    void doubleClick(const std::string& item);
    void drag(const std::string& item, float dx, float dy);
    void press(ImGuiKey key);
    void type(const std::string& text);

    Settings settings;
    Model model;
    FrameStatistics statistics;
    Interface panels;
    Requests requests;       // of the last frame
    Requests everRequested;  // actions and texts of all frames since clear()
    void clear() { everRequested = {}; }

    const int width, height;
    const float scale;

  private:
    ImGuiContext* context_;
};

}  // namespace mv::ui
