#pragma once
// The pixels that a gather at a lower resolution leaves to themselves, listed on the GPU
// (shaders/passes/alone_pixels.glsl).

#include <cstdint>

#include "renderer/gl/buffer.h"
#include "renderer/gl/program.h"

namespace mv {

class AlonePixels {
  public:
    void clear(int width, int height);  // room for all pixels of a picture
    void bind() const;
    // Dispatches an invocation for each pixel of the list. Waits for what lists them, and for the
    // images that the dispatch before wrote.
    void dispatch(gl::Program& program) const;
    std::uint64_t bytes() const { return list_.bytes(); }

  private:
    gl::Buffer list_;
};

}  // namespace mv
