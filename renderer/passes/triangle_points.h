#pragma once
// Points of the scene's triangles as they stand [Marrs17], batch by batch, for passes that splat
// them into many maps at once (shaders/shared/vir.glsl).

#include <cstdint>

#include "renderer/gl/program.h"
#include "renderer/gl/texel_buffer.h"
#include "renderer/passes/bvh_tables.h"
#include "renderer/passes/prefix_sum.h"
#include "shaders/shared/vir.glsl"

namespace mv {

inline std::uint32_t divideUp(std::uint32_t n, std::uint32_t by) { return (n + by - 1) / by; }

class TrianglePoints {
  public:
    // Points held at once, at most; they take 16 bytes each.
    static constexpr std::uint32_t kBatch = 1u << 20;
    explicit TrianglePoints(std::uint32_t batch = kBatch) : batch_(batch) {}
    // Which levels of detail the triangles of each group need, a bit each: written by who knows
    // the views.
    gl::TexelBuffer<std::uint32_t>& groupLevels(const BvhTables& scene);
    static std::uint32_t groupsOf(const BvhTables& scene);
    // How many points a level of detail has at a spacing (root-cube units): read back.
    std::uint32_t count(const BvhTables& scene, std::uint32_t level, float spacing);
    // Makes those that were counted last, from `first` on, as many as are held at once; returns
    // how many.
    std::uint32_t make(const BvhTables& scene, std::uint32_t first);
    static std::uint32_t clustersOf(std::uint32_t points);
    void bind() const;  // the batch: kUnitSurfacePoints, and its clusters: kUnitClusters
    std::uint64_t bytes() const;

  private:
    std::uint32_t batch_, total_ = 0;
    float spacing_ = 0;
    gl::Program count_, points_[2];  // made at first use; with alpha masks: the second
    PrefixSum sums_;
    gl::TexelBuffer<std::uint32_t> groupLevels_;
    gl::TexelBuffer<std::uint32_t> counts_, firsts_;  // of each triangle, and behind the last
    gl::TexelBuffer<VirPoint> batchPoints_;
    gl::TexelBuffer<glm::vec4> clusters_;  // lowest and highest corner of each
};

}  // namespace mv
