#pragma once
// Dear ImGui on OpenGL, fed by InputEvents: the same panels in a window and without one.

#include <functional>
#include <set>
#include <string>

#include "app/viewer/input.h"
#include "ui/interface.h"

namespace mv {

class ImGuiLayer {
  public:
    ImGuiLayer();  // needs a current context
    ~ImGuiLayer();
    ImGuiLayer(const ImGuiLayer&) = delete;
    ImGuiLayer& operator=(const ImGuiLayer&) = delete;

    // Joins the window system's clipboard; without it, copied text stays in the program.
    void setClipboard(std::function<std::string()> read, std::function<void(const char*)> write);

    void copy(const std::string& text);

    // Between frames: style and font of this size.
    void setScale(float scale);
    // Between frames too: what the font lacks is drawn from now on, where the built-in font or one
    // of the system's has it. Costs nothing for characters that were asked for before.
    void addGlyphs(const std::set<char32_t>& characters);
    // How often the system was asked for fonts.
    int fontSearches() const { return fontSearches_; }

    void handle(const InputEvent& event);
    void beginFrame(int width, int height, double dt);
    void endFrame(unsigned framebuffer);  // draws into it

    bool editing() const;     // a widget is held
    bool takesMouse() const;  // a panel is under the mouse or held by it
    // Text is typed, a widget was reached by the keyboard, or something is open that arrows move
    // in.
    bool takesKeyboard() const;
    bool popupOpen() const;  // a menu, a list or a dialog

  private:
    void noteMenuKey(const InputEvent& event);

    bool altAlone_ = false, menuKey_ = false;
    float scale_ = 1;
    ui::MoreGlyphs glyphs_;
    int fontSearches_ = 0;
    std::function<std::string()> readClipboard_;
    std::function<void(const char*)> writeClipboard_;
    std::string clipboard_;
};

}  // namespace mv
