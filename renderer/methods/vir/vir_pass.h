#pragma once
// View-independent rasterisation on the GPU [Marrs17]: points of the triangles as they stand, made
// for all views at once, then splatted into the maps of those that are near enough to need them.
// The CPU twin is mv::pointMaps, by the same lines (shaders/shared/vir.glsl).

#include <cstdint>
#include <vector>

#include "megaviews/methods/vir/point_maps.h"
#include "megaviews/settings/statistics.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/passes/bvh_tables.h"
#include "renderer/passes/gpu_data.h"
#include "renderer/passes/prefix_sum.h"

namespace mv {

class VirPass {
  public:
    // Points held at once, at most; they take 16 bytes each.
    static constexpr std::uint32_t kBatch = 1u << 20;
    explicit VirPass(std::uint32_t batch = kBatch) : batch_(batch) {}
    // views: flat, one leaf a view, corrected rules: map k belongs to sorted view k. mostPoints: of
    // virMostPoints(). Reads the number of points back for each level. Throws
    // Error(ExitCode::impossible), before allocating and saying what would fit, if the maps exceed
    // the budget or a storage block, or if a level may have 2^32 points.
    void render(const BvhTables& scene, const GpuViewHierarchy& views, const VirOptions& options,
                std::uint64_t mostPoints, std::uint64_t gpuMemoryBytes, gl::Profiler& profiler,
                GpuViewMaps& out, MethodStatistics& statistics);
    std::uint64_t bytes() const;  // of points and what they are made by

  private:
    struct Frame;  // what all steps of a frame read
    void makePrograms(bool masks);
    void findLevels(const Frame& frame);
    std::uint32_t countPoints(const Frame& frame, std::uint32_t level);
    void makePoints(const Frame& frame, std::uint32_t level, std::uint32_t first,
                    std::uint32_t count);
    void splat(const Frame& frame, std::uint32_t level, std::uint32_t count,
               const GpuViewMaps& out);

    std::uint32_t batch_;
    gl::Program levels_, count_, points_[2], splat_;  // made at first use
    PrefixSum sums_;
    gl::TexelBuffer<std::uint32_t> groupLevels_;      // of each group of triangles: bits
    gl::TexelBuffer<std::uint32_t> counts_, firsts_;  // of each triangle, and behind the last
    gl::TexelBuffer<VirPoint> batchPoints_;
    gl::TexelBuffer<glm::vec4> clusters_;  // lowest and highest corner of each
};

}  // namespace mv
