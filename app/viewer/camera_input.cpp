#include "app/viewer/camera_input.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace mv {
namespace {

constexpr float kRadPerPixel = 0.005f;  // look and orbit
constexpr double kClickPixels = 4;      // a press that moves less is a click
constexpr double kLongestStepS = 0.5;   // flying never jumps further at once
constexpr double kFirstStepS = 1.0 / 30;

}  // namespace

bool CameraMovement::moves() const {
    return look != glm::vec2(0) || orbit != glm::vec2(0) || pan != glm::vec2(0) || dolly != 0 ||
           flies();
}

void CameraMovement::apply(CameraController& camera, float share) const {
    if (look != glm::vec2(0)) camera.look(share * look.x, share * look.y);
    if (orbit != glm::vec2(0)) camera.orbit(share * orbit.x, share * orbit.y);
    if (pan != glm::vec2(0)) camera.pan(share * pan.x, share * pan.y);
    if (dolly != 0) camera.dolly(share * dolly);
    if (flies()) camera.fly(share * camera.flySpeed() * fly);
}

void CameraInput::handle(const InputEvent& event, bool mouseTaken) {
    if (const auto* move = std::get_if<MouseMoved>(&event)) {
        if (known_ && drag_) {
            dx_ += move->x - x_;
            dy_ += move->y - y_;
            travelled_ += std::hypot(move->x - x_, move->y - y_);
        }
        x_ = move->x;
        y_ = move->y;
        known_ = true;
    } else if (const auto* button = std::get_if<MouseButtonChanged>(&event)) {
        if (button->pressed && !drag_ && !mouseTaken) {
            drag_ = button->button;
            travelled_ = dx_ = dy_ = 0;
            moved_ = false;
        } else if (!button->pressed && drag_ == button->button) {
            if (!moved_ && travelled_ < kClickPixels && *drag_ == MouseButton::left) {
                click_ = Click{x_, y_, (modifiers_ & GLFW_MOD_SHIFT) != 0};
            }
            drag_.reset();
            moved_ = false;
        }
    } else if (const auto* scroll = std::get_if<Scrolled>(&event)) {
        if (!mouseTaken) scroll_ += scroll->y;
    } else if (const auto* key = std::get_if<KeyChanged>(&event)) {
        modifiers_ = key->modifiers;
        if (key->pressed) {
            // With these a letter is a command's, but for a hand that flies.
            const bool command = key->key < GLFW_KEY_ESCAPE &&
                                 (key->modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) != 0;
            if (!command || drag_ == MouseButton::right) held_.insert(key->key);
        } else {
            held_.erase(key->key);
        }
    } else if (std::holds_alternative<FocusLost>(event)) {
        held_.clear();
        modifiers_ = 0;
        drag_.reset();
        moved_ = false;
    }
}

CameraMovement CameraInput::take(double seconds, int pictureHeight, bool inRoom, bool keysFree) {
    CameraMovement asked;
    if (drag_ && travelled_ >= kClickPixels) moved_ = true;
    if (moved_ && (dx_ != 0 || dy_ != 0)) {
        const glm::vec2 way(dx_, -dy_);
        const auto height = static_cast<float>(std::max(pictureHeight, 1));
        const bool pans = *drag_ == MouseButton::middle || (modifiers_ & GLFW_MOD_SHIFT) != 0;
        if (*drag_ == MouseButton::right || (inRoom && !pans)) {
            asked.look = way * kRadPerPixel;
        } else if (pans) {
            asked.pan = way / height;
        } else {
            asked.orbit = way * kRadPerPixel;
        }
        dx_ = dy_ = 0;
    }
    const auto steps = static_cast<float>(std::exchange(scroll_, 0));
    if (flying()) {
        asked.faster = std::pow(1.25f, steps);
    } else {
        asked.dolly = steps;
    }
    const bool keysFly = keysFree && (modifiers_ & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) == 0;
    if (flying() || keysFly) {
        const auto axis = [&](int forward, int back) {
            return static_cast<float>(down(forward)) - static_cast<float>(down(back));
        };
        float haste = 1;
        if (down(GLFW_KEY_LEFT_SHIFT) || down(GLFW_KEY_RIGHT_SHIFT)) haste *= 4;
        if (down(GLFW_KEY_LEFT_CONTROL) || down(GLFW_KEY_RIGHT_CONTROL)) haste *= 0.25f;
        // The previous frame may have been long ago.
        const double longest = flew_ ? kLongestStepS : kFirstStepS;
        asked.fly = haste * static_cast<float>(std::min(seconds, longest)) *
                    glm::vec3(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q),
                              axis(GLFW_KEY_W, GLFW_KEY_S));
    }
    flew_ = asked.flies();
    return asked;
}

std::optional<CameraInput::Click> CameraInput::takeClick() {
    return std::exchange(click_, std::nullopt);
}

}  // namespace mv
