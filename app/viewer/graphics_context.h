#pragma once
// The OpenGL context of a run without a visible window: EGL without a display, or a hidden window
// where only the window system offers OpenGL.

#include <memory>

#include "app/common/run_options.h"
#include "renderer/gl/context.h"

namespace mv {

// Owns a current context of at least OpenGL 4.5 that gl::limits() describes.
class GraphicsContext {
  public:
    // automatic: EGL, then a hidden window if there is a display. Throws
    // Error(ExitCode::graphics) listing what was tried and why it failed.
    GraphicsContext(GlPlatform platform, const gl::ContextWish& wish);
    ~GraphicsContext();
    GraphicsContext(const GraphicsContext&) = delete;
    GraphicsContext& operator=(const GraphicsContext&) = delete;

  private:
    class HiddenWindow;
    std::unique_ptr<gl::HeadlessContext> egl_;
    std::unique_ptr<HiddenWindow> window_;
};

}  // namespace mv
