#pragma once
// Stage "sky maps": depth maps of the whole scene along many parallel views of the sky at once, by
// view-independent rasterisation [Marrs17]. Kept while neither geometry nor sky changes. The CPU
// twin is mv::parallelMaps, by the same lines (shaders/shared/parallel.glsl).

#include <cstdint>
#include <memory>

#include "megaviews/scene/triangle_bvh.h"
#include "megaviews/views/sky.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/passes/triangle_points.h"

namespace mv {

template <>
constexpr GLenum gl::texelFormat<SkyView>() {
    return GL_RGBA32F;
}

class SkyMaps {
  public:
    // Throws Error(ExitCode::impossible), before allocating and saying what would fit, if the maps
    // exceed the budget or a storage block, or if their points cannot be counted.
    void make(const BvhTables& scene, const TriangleBvh& bvh, const Sky& sky, int views, int res,
              std::uint64_t gpuMemoryBytes, gl::Profiler& profiler);
    void bind(gl::Program& program) const;
    std::uint32_t viewCount() const { return viewCount_; }
    const gl::TexelBuffer<std::uint32_t>& texels() const { return texels_; }
    std::uint64_t points() const { return madePoints_; }
    std::uint64_t bytes() const { return views_.bytes() + texels_.bytes() + points_.bytes(); }

  private:
    void splat(const BvhTables& scene, std::uint32_t count, float spacing);

    gl::Program splat_;  // made at first use
    TrianglePoints points_;
    gl::TexelBuffer<SkyView> views_;
    gl::TexelBuffer<std::uint32_t> texels_;
    std::uint32_t viewCount_ = 0, res_ = 0;
    glm::vec3 centre_{0};
    float radius_ = 1;
    std::uint64_t madePoints_ = 0;
};

}  // namespace mv
