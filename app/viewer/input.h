#pragma once
// What reaches the viewer from a window, a script or a test, in one form: a script that clicks is
// then the same thing as a hand that does. Positions are framebuffer pixels from the top left, keys
// GLFW's codes, which stand for places on the keyboard.

#include <deque>
#include <string>
#include <variant>
#include <vector>

namespace mv {

enum class MouseButton { left = 0, right = 1, middle = 2 };  // as GLFW and Dear ImGui count

struct MouseMoved {
    double x = 0, y = 0;
};
struct MouseButtonChanged {
    MouseButton button = MouseButton::left;
    bool pressed = false;
};
struct Scrolled {
    double x = 0, y = 0;
};
struct KeyChanged {
    int key = 0;
    int modifiers = 0;  // GLFW_MOD_*, held with it
    bool pressed = false;
    bool repeated = false;
};
struct TextTyped {
    unsigned codepoint = 0;
};
struct FilesDropped {
    std::vector<std::string> files;
};
struct FocusLost {};
using InputEvent = std::variant<MouseMoved, MouseButtonChanged, Scrolled, KeyChanged, TextTyped,
                                FilesDropped, FocusLost>;

// Events in order, given out frame by frame so that none is lost however slow frames are: a press
// and the release of the same button or key are never in one frame, nor are a movement and a
// button: what lies under the mouse is known when it is pressed, and a drag has ended where it is
// let go.
class InputQueue {
  public:
    void push(InputEvent event) { events_.push_back(std::move(event)); }
    std::vector<InputEvent> takeFrame();
    bool empty() const { return events_.empty(); }
    bool holdsOnlyMoves() const;  // of the mouse, or nothing
    bool holdsPress(int key) const;

  private:
    std::deque<InputEvent> events_;
};

}  // namespace mv
