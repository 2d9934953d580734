#pragma once
// Imperfect shadow maps on the GPU [RGK08]: each view splats its own few of the scene's points into
// its own map, then pull-push fills the holes. The CPU twin is mv::imperfectMaps, by the same lines
// (shaders/shared/ism.glsl).

#include "megaviews/methods/ism/imperfect_maps.h"
#include "megaviews/settings/statistics.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

struct GpuSurfacePoints {
    gl::TexelBuffer<SurfacePoint> points;
    std::uint32_t count = 0;
    std::uint32_t requested = 0;  // 0 triangles give no points
    double area = 0;
};
GpuSurfacePoints upload(const SurfacePoints& points);

class IsmPass {
  public:
    // views: flat, one leaf a view, corrected rules: map k belongs to sorted view k. surface: none,
    // or at least options.pointsPerView points. Takes time in proportion to points times views.
    // Throws Error(ExitCode::impossible), before allocating and saying what would fit, if maps and
    // their coarser levels exceed the budget or a storage block.
    void render(const GpuSurfacePoints& surface, const GpuViewHierarchy& views,
                const IsmOptions& options, std::uint64_t gpuMemoryBytes, gl::Profiler& profiler,
                GpuViewMaps& out, MethodStatistics& statistics);

  private:
    void splat(const GpuSurfacePoints& surface, const GpuViewHierarchy& views,
               const IsmOptions& options, const GpuViewMaps& out);
    void fill(const IsmOptions& options, const GpuViewMaps& out);
    gl::Program splat_, pull_, push_;  // made at first use
    gl::Buffer mips_;
};

}  // namespace mv
