#pragma once
// Mouse and keys that the panels leave -> movements of a CameraController: left drag orbits, in a
// room looks around, middle or Shift drag pans, the wheel dollies, right drag looks, W A S D Q E
// fly. A press and release without a movement between is a click on the picture.

#include <optional>
#include <set>

#include "app/viewer/camera_controller.h"
#include "app/viewer/input.h"

namespace mv {

// What a hand asks of the camera in one frame, by CameraController's functions.
struct CameraMovement {
    glm::vec2 look{0}, orbit{0};  // radians: yaw, pitch
    glm::vec2 pan{0};             // shares of the picture's height: right, up
    float dolly = 0;              // steps
    glm::vec3 fly{0};             // seconds at flying speed along right, up and forward
    float faster = 1;             // what the flying speed is multiplied by first

    bool flies() const { return fly != glm::vec3(0); }
    bool moves() const;
    // share: of the movement, 0 to 1.
    void apply(CameraController& camera, float share) const;
};

class CameraInput {
  public:
    struct Click {
        double x = 0, y = 0;  // framebuffer pixels
        bool shift = false;
    };
    // mouseTaken: a panel is under the mouse. A drag that begins on a panel stays the panel's, one
    // that begins on the picture the camera's.
    void handle(const InputEvent& event, bool mouseTaken);
    // What came since the last call; seconds: of the frame. inRoom: a left drag looks around;
    // keysFree: no panel has the keyboard.
    CameraMovement take(double seconds, int pictureHeight, bool inRoom, bool keysFree);
    std::optional<Click> takeClick();

    bool dragging() const { return drag_.has_value(); }
    bool flying() const { return drag_ == MouseButton::right; }
    // While looking around the mouse should be caught, so that it does not leave the window.
    bool wantsMouseCaught() const { return flying() && moved_; }
    // Positions before and after the mouse is caught or let go have nothing to do with each other.
    void forgetPosition() { known_ = false; }
    double x() const { return x_; }
    double y() const { return y_; }

  private:
    bool down(int key) const { return held_.count(key) > 0; }
    std::set<int> held_;
    int modifiers_ = 0;
    double x_ = 0, y_ = 0;
    bool known_ = false;  // x_, y_ are where the mouse was
    double dx_ = 0, dy_ = 0, scroll_ = 0;
    std::optional<MouseButton> drag_;  // the button that drags the picture
    double travelled_ = 0;             // pixels since it was pressed
    bool moved_ = false;               // far enough to be a drag
    bool flew_ = false;                // in the last frame
    std::optional<Click> click_;
};

}  // namespace mv
