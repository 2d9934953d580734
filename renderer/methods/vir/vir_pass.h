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

class VirPass {
  public:
    explicit VirPass(std::uint32_t batch = TrianglePoints::kBatch) : points_(batch) {}
    // views: flat, one leaf a view, corrected rules: map k belongs to sorted view k. mostPoints: of
    // virMostPoints(). Reads the number of points back for each level. Throws
    // Error(ExitCode::impossible), before allocating and saying what would fit, if the maps exceed
    // the budget or a storage block, or if a level may have 2^32 points.
    void render(const BvhTables& scene, const GpuViewHierarchy& views, const VirOptions& options,
                std::uint64_t mostPoints, std::uint64_t gpuMemoryBytes, gl::Profiler& profiler,
                GpuViewMaps& out, MethodStatistics& statistics);
    std::uint64_t bytes() const { return points_.bytes(); }

  private:
    struct Frame;  // what all steps of a frame read
    void findLevels(const Frame& frame);
    void splat(const Frame& frame, std::uint32_t level, std::uint32_t count,
               const GpuViewMaps& out);

    gl::Program levels_, splat_;  // made at first use
    TrianglePoints points_;
};

}  // namespace mv
