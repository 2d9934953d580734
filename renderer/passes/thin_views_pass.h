#pragma once
// Candidates -> views: of the traced candidates those stay that light what the camera sees. The CPU
// twin is mv::thinViews, by the same lines (shaders/shared/importance.glsl).

#include <array>

#include "megaviews/views/view_guide.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

template <>
constexpr GLenum gl::texelFormat<ImportancePoint>() {
    return GL_RGBA32F;
}

class ThinViewsPass {
  public:
    // Leaves about `wanted` of the candidates alive, whose slots and number stay.
    void thin(const Importance& by, std::uint64_t wanted, std::uint32_t seed,
              gl::Profiler& profiler, GpuViews& candidates);
    std::uint64_t bytes() const;

  private:
    std::array<gl::Program, 6> programs_;  // by MV_STAGE of thin_views.comp; made at first use
    gl::TexelBuffer<ImportancePoint> points_;
    gl::Buffer places_;
    gl::Buffer importance_;
    gl::Buffer sums_;
    gl::Buffer totals_;
};

}  // namespace mv
