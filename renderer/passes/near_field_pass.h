#pragma once
// Stage "near field": adds to gathered irradiance what the clamp has taken, by a short ray a pixel
// (shaders/shared/near_field.glsl).

#include <array>
#include <cstdint>

#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/bvh_tables.h"
#include "renderer/passes/gather_cull_pass.h"
#include "renderer/passes/gather_views_pass.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

class NearFieldPass {
  public:
    // irradiance: RGBA32F, W/m^2, one texel for each of `lists.surfaces`. edge: of the root cube,
    // m. emissionScale: of surfaces that glow, whose light is the views'; 0: none does. Samples
    // hash (seed, pixel, accumulationIndex).
    void render(const BvhTables& triangles, float emissionScale, const GpuViewHierarchy& hierarchy,
                const GatherViews& views, const GatherLists& lists, double edge, std::uint32_t seed,
                std::uint32_t accumulationIndex, const gl::Texture& irradiance);

  private:
    // With alpha masks; with surfaces that glow.
    std::array<std::array<gl::Program, 2>, 2> programs_;
};

}  // namespace mv
