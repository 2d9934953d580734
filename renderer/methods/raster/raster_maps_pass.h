#pragma once
// The brute force that many-view methods are measured against [Kol19 fig. 10]: every triangle of
// the scene is rasterised into every view's own map. No hierarchy over scene or views is used, and
// nothing is shared. Depths are exact at the texels' centres: those that mv::exactMaps finds by
// rays, up to rounding, from the view's own position.

#include <cstdint>
#include <memory>

#include "megaviews/settings/statistics.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/passes/bvh_tables.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

class RasterMapsPass {
  public:
    // Triangles times views of one dispatch, at most: by default a fraction of a second on a GPU.
    static constexpr std::uint64_t kPairsPerDispatch = std::uint64_t{1} << 28;
    explicit RasterMapsPass(std::uint64_t pairsPerDispatch = kPairsPerDispatch);
    ~RasterMapsPass();
    // views: flat, one leaf a view, corrected rules: map k belongs to sorted view k. Alpha masks
    // are honoured; nothing else is left out. Texels that no direction falls into stay empty. Takes
    // time in proportion to triangles times views. Throws Error(ExitCode::impossible), before
    // allocating and saying what would fit, if the maps exceed the budget or a storage block.
    void render(const BvhTables& scene, const GpuViewHierarchy& views, int mapRes,
                std::uint64_t gpuMemoryBytes, gl::Profiler& profiler, GpuViewMaps& out,
                MethodStatistics& statistics);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv
