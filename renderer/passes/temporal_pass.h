#pragma once
// Radiance of a frame that moves -> radiance and display with soft edges: the mean of the frames so
// far, each of which was drawn at another point of its pixels (shaders/passes/temporal.comp).

#include <glm/glm.hpp>

#include "megaviews/views/frame_camera.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/passes/average_pixels_pass.h"
#include "renderer/passes/gbuffer_pass.h"

namespace mv {

// Frames that a mean is worth at most. Those before fade by 1 - 1/kTemporalFrames each.
inline constexpr int kTemporalFrames = 12;

struct TemporalMeans {
    PixelMeans means;           // points: frames in them, at most kTemporalFrames; 0: none
    gl::Texture oldDisplay;     // means.display of the frame before
    glm::mat4 clipFromRoot{1};  // of its pixels' centres
    std::uint64_t bytes() const { return means.bytes() + oldDisplay.bytes(); }
};

class TemporalPass {
  public:
    // radiance and gbuffer: of one frame at any point of its pixels, camera.offset. ev: as
    // AveragePixelsPass::render() takes it; means of another one, or of another size, begin anew. A
    // pixel that is NaN or infinite stays so, and is not remembered.
    void render(const gl::Texture& radiance, const GBuffer& gbuffer, FrameCamera camera, int ev,
                gl::Profiler& profiler, TemporalMeans& means);

  private:
    gl::Program program_;  // made at first use
};

}  // namespace mv
