#pragma once
// Point, spot and directional lights on the GPU, for passes that ask what they give a surface
// (shaders/passes/punctual_lights.glsl).

#include <cstdint>
#include <vector>

#include "renderer/gl/texel_buffer.h"
#include "shaders/shared/types.glsl"

namespace mv {

class GpuLights {
  public:
    // Each is a draw of the picture; a hall or a street has hundreds.
    static constexpr int kMostLights = 1024;
    // lights: LightRecords in root-cube units (mv::makeEmitters), of which the strongest
    // kMostLights are taken; those left out are warned of once.
    void set(const std::vector<LightRecord>& lights);
    std::uint32_t count() const { return count_; }
    void bindTexels() const;
    std::uint64_t bytes() const { return records_.bytes(); }

  private:
    gl::TexelBuffer<LightRecord> records_;
    std::uint32_t count_ = 0;
    std::size_t warnedOf_ = 0;
};

}  // namespace mv
