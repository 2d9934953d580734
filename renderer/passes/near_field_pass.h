#pragma once
// Stage "near field": adds to gathered irradiance what the clamp has taken, by short rays
// (shaders/shared/near_field.glsl).

#include <cstdint>
#include <optional>

#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/bvh_tables.h"
#include "renderer/passes/gather_cull_pass.h"
#include "renderer/passes/gather_views_pass.h"
#include "renderer/passes/gpu_data.h"
#include "renderer/passes/history_pass.h"
#include "renderer/passes/punctual_lights.h"
#include "renderer/passes/sky_pass.h"

namespace mv {

// What its rays find, and what lights that. Samples hash (seed, pixel, accumulationIndex).
struct NearFieldScene {
    const BvhTables* triangles = nullptr;  // null: there is no near field
    const GpuLights* lights = nullptr;
    const GpuSky* sky = nullptr;  // null: none
    float emissionScale = 0;      // of surfaces that glow, whose light is the views'; 0: none does
    int bounces = 1;              // of the views' paths
    bool gloss = false;           // surfaces reflect with theirs, as for those
    std::optional<double> clampDistance = {};  // of all views; unset: by their neighbours
    double rootEdge = 1;                       // m
    std::uint32_t seed = 0, accumulationIndex = 0;
};

class NearFieldPass {
  public:
    // irradiance: RGBA32F, W/m^2, one texel for each of `lists.surfaces`.
    void render(const NearFieldScene& scene, const GpuViewHierarchy& hierarchy,
                const GatherViews& views, const GatherLists& lists, const Resting& resting,
                const gl::Texture& irradiance);

  private:
    gl::Program& program(const NearFieldScene& scene);

    // Programs [BvhTables::passing()][surfaces glow][there is a sky].
    gl::Program programs_[BvhTables::kPassings][2][2];
};

}  // namespace mv
