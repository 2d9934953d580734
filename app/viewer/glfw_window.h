#pragma once
// The window system's side of the viewer: GLFW with a window and its OpenGL 4.5 context, whose
// events become InputEvents.

#include <string>

#include "app/common/user_state.h"
#include "app/viewer/input.h"
#include "app/viewer/session.h"

struct GLFWwindow;

namespace mv {

inline constexpr int kInitialWidth = 1280, kInitialHeight = 720;

// GLFW itself, its window and context, current on this thread.
class GlfwWindow : public Host {
  public:
    explicit GlfwWindow(bool vsync);  // throws Error(ExitCode::graphics)
    ~GlfwWindow() override;
    GlfwWindow(const GlfwWindow&) = delete;
    GlfwWindow& operator=(const GlfwWindow&) = delete;

    void setTitle(const std::string& title) override;
    void setVsync(bool on) override;
    void setFullScreen(bool on) override;
    void catchMouse(bool on) override;
    void resize(int width, int height) override;
    bool isAlive() const override { return true; }
    bool poll(int width, int height) override;
    void present() override;

    // Where it stands when it is not full screen; put() ignores places that no monitor shows.
    WindowPlace place() const;
    void put(const WindowPlace& place);

    // Where events go from now on.
    void sendTo(Session& session);
    GLFWwindow* handle = nullptr;

  private:
    void installCallbacks();
    InputQueue* queue_ = nullptr;
    int x_ = 0, y_ = 0, width_ = kInitialWidth, height_ = kInitialHeight;  // before full screen
};

}  // namespace mv
