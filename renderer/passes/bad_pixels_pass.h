#pragma once
// Radiance -> how many of its texels are NaN or infinite.

#include <cstdint>
#include <optional>

#include "renderer/gl/program.h"
#include "renderer/gl/read_back.h"
#include "renderer/gl/texture.h"

namespace mv {

class BadPixelsPass {
  public:
    // Asks for the counts of runs of texels, which take() sums up once they are there.
    void count(const gl::Texture& radiance, gl::ReadBack& counts);
    static std::optional<std::uint64_t> take(gl::ReadBack& counts);

  private:
    gl::Program program_{"count bad pixels", {"passes/count_bad.comp"}};
    gl::Buffer counts_;
};

}  // namespace mv
