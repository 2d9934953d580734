#pragma once
// Stage "accumulate", of pixels: radiance of one more point of every pixel -> means over its points
// so far (shaders/passes/average_pixels.comp).

#include <cstdint>

#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"

namespace mv {

// Means over the points of each pixel, RGBA32F: of radiance, for files and measurements, and for a
// display at an exposure near 2^ev.
struct PixelMeans {
    gl::Texture radiance, display;
    int points = 0, ev = 0;
    std::uint64_t bytes() const { return radiance.bytes() + display.bytes(); }
};

class AveragePixelsPass {
  public:
    // One more point of every pixel into the means; the first decides their ev.
    void render(const gl::Texture& radiance, int ev, gl::Profiler& profiler, PixelMeans& means);

  private:
    gl::Program program_;  // made at first use
};

}  // namespace mv
