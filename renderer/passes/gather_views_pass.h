#pragma once
// What the gather needs of every view, packed once a frame: power as whole units for sampling, and
// one record of position, normal, flux, map and the map's centre.

#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

struct GatherViews {
    gl::Buffer prefix;   // uint[n + 1]: power units before each sorted view
    gl::Buffer records;  // 3 texels RGBA32UI a view, see shaders/passes/gather_power.comp
    gl::Buffer guide;    // uint[slots]: the view that owns unit slot << slotShift
    gl::TextureBuffer prefixTexels, recordTexels, guideTexels;
    std::uint32_t slotShift = 0;
    std::uint32_t count = 0;
};

class GatherViewsPass {
  public:
    GatherViewsPass();
    // hierarchy: of the maps; any hierarchy of the same sorted views if maps are not present.
    void render(const GpuViewHierarchy& hierarchy, const GpuViewMaps& maps, GatherViews& out);

  private:
    gl::Program stages_[5], guide_;
    gl::Buffer blockPower_, blockUnits_;
};

}  // namespace mv
