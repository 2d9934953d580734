#pragma once
// Dear ImGui on OpenGL, fed by InputEvents: the same panels in a window and without one.

#include <functional>
#include <string>

#include "app/viewer/input.h"

namespace mv {

class ImGuiLayer {
  public:
    ImGuiLayer();  // needs a current context
    ~ImGuiLayer();
    ImGuiLayer(const ImGuiLayer&) = delete;
    ImGuiLayer& operator=(const ImGuiLayer&) = delete;

    // Of the window system; without one, copied text stays in the program.
    void setClipboard(std::function<std::string()> read, std::function<void(const char*)> write);

    void copy(const std::string& text);

    // Between frames: style and font of this size.
    void setScale(float scale);

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
    std::function<std::string()> readClipboard_;
    std::function<void(const char*)> writeClipboard_;
    std::string clipboard_;
};

}  // namespace mv
