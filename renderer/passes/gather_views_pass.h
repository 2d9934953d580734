#pragma once
// What the gather needs of every view: power as whole units for sampling, which depends on the
// views alone, and one record of position, normal, flux, map and the map's centre.

#include <optional>

#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/passes/gpu_data.h"
#include "shaders/shared/gather_data.glsl"

namespace mv {

// Sampling data that depend on the views alone, not their maps: one copy serves both sides.
struct GatherViews {
    gl::TexelBuffer<std::uint32_t> prefix;       // n + 1: power units before each sorted view
    gl::TexelBuffer<std::uint32_t> searchTable;  // slots: the view that owns unit slot << slotShift
    gl::TexelBuffer<float> clampDistances;       // n: below which a view lights no brighter
    std::uint32_t slotShift = 0;
    std::uint32_t count = 0;
    std::uint64_t bytes() const {
        return prefix.bytes() + searchTable.bytes() + clampDistances.bytes();
    }
};

struct GatherRecords {
    gl::TexelBuffer<GatherRecord> records;  // of each sorted view
};

class GatherViewsPass {
  public:
    GatherViewsPass();
    // clampDistance: of all views, root-cube units; nullopt: of each by its neighbours.
    void render(const GpuViewHierarchy& hierarchy, std::optional<double> clampDistance,
                GatherViews& out);
    // hierarchy: of the maps; any hierarchy of the same sorted views if maps are not present.
    // mapViews: the views that it is of; null: all.
    void record(const GpuViewHierarchy& hierarchy, const GpuViewMaps& maps,
                const GpuMapViews* mapViews, const GatherViews& views, GatherRecords& out);

  private:
    gl::Program stages_[5], searchTable_, spread_, clamp_, records_, borrowedRecords_;
    gl::Buffer blockPower_, blockUnits_;
};

}  // namespace mv
