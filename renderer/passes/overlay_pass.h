#pragma once
// Picture -> picture with the instruments' lines over it. Of the lines that cross a pixel the
// nearest is drawn; where a surface hides it, it is dimmed, not removed.

#include <memory>
#include <span>

#include "megaviews/inspect/lines.h"
#include "megaviews/views/frame_camera.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/texture.h"

namespace mv {

struct OverlayOptions {
    float widthPixels = 1.25f;
    float hiddenAlpha = 0.25f;
};

class OverlayPass {
  public:
    OverlayPass();
    ~OverlayPass();
    // display: RGBA8 with sRGB-encoded values, which the lines' colours are too. depth: of the
    // same size, as GBuffer::depth. out becomes the same picture with the lines over it, alpha 1.
    // Without lines nothing is done, out is empty, and what an earlier call allocated is freed.
    void draw(std::span<const Line> lines, const FrameCamera& camera, const gl::Texture& depth,
              const OverlayOptions& options, gl::Profiler& profiler, const gl::Texture& display,
              gl::Texture& out);
    std::uint64_t bytes() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv
