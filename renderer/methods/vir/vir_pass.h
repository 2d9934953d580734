#pragma once
// View-independent rasterisation on the GPU [Marrs17]: points of the triangles as they stand, made
// for all views at once, then splatted into the maps of those that are near enough to need them.
// The CPU twin is mv::pointMaps, by the same lines (shaders/shared/vir.glsl).

#include <cstdint>

#include "megaviews/methods/vir/point_maps.h"
#include "megaviews/settings/statistics.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/passes/bvh_tables.h"
#include "renderer/passes/gpu_data.h"
#include "renderer/passes/triangle_points.h"

namespace mv {

struct VirInput {
    const BvhTables& scene;
    const GpuViewHierarchy& views;  // flat, corrected rules: map k is of sorted view k
    VirOptions options;
    std::uint64_t mostPoints = 0;  // of virMostPoints()
    std::uint64_t gpuMemoryBytes = 0;
};

class VirPass {
  public:
    explicit VirPass(std::uint32_t batch = TrianglePoints::kBatch) : points_(batch) {}
    // Reads the number of points back for each level. Throws Error(ExitCode::impossible), before
    // allocating and saying what would fit, if the maps exceed the budget or a storage block, or if
    // a level may have 2^32 points.
    void render(const VirInput& input, gl::Profiler& profiler, GpuViewMaps& out,
                MethodStatistics& statistics);
    std::uint64_t bytes() const { return points_.bytes(); }

  private:
    void findLevels(const VirInput& input);
    void splat(const VirInput& input, std::uint32_t level, std::uint32_t count,
               const GpuViewMaps& out);

    gl::Program levels_, splat_;  // made at first use
    TrianglePoints points_;
};

}  // namespace mv
