#include "renderer/passes/near_field_pass.h"

#include <string>

#include "renderer/gl/context.h"
#include "shaders/shared/bindings.glsl"

namespace mv {
void NearFieldPass::render(const BvhTables& triangles, float emissionScale,
                           const GpuViewHierarchy& hierarchy, const GatherViews& views,
                           const GatherLists& lists, double edge, std::uint32_t seed,
                           std::uint32_t accumulationIndex, const gl::Texture& irradiance) {
    const bool emits = emissionScale > 0;
    gl::Program& p = programs_[triangles.masks() ? 1 : 0][emits ? 1 : 0];
    if (!p) {
        gl::Defines defines = triangles.rayDefines();
        defines.emplace_back("MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize));
        if (emits) defines.emplace_back("MV_EMISSION", "1");
        p = gl::Program("near field", {"passes/near_field.comp"}, defines);
    }
    triangles.bind(p);
    lists.surfaces.bind(kUnitSurfaces);
    lists.planes.bind(kUnitPlanes);
    hierarchy.sortedViews.bindTexels(kUnitSortedViews);
    hierarchy.mortonKeys.bindTexels(kUnitViewKeys);
    views.clampDistances.bindTexels(kUnitClampDistances);
    irradiance.bindImage(kImageIrradiance, GL_READ_WRITE, GL_RGBA32F);
    p.set("size", glm::ivec2(irradiance.width(), irradiance.height()));
    p.set("viewCount", views.count);
    if (emits) p.set("emissionScale", emissionScale);
    p.set("seed", seed);
    p.set("accumulationIndex", accumulationIndex);
    p.set("inverseEdge2", static_cast<float>(1.0 / (edge * edge)));
    // Producers: surfaces, views and the gather's draws or stores.
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    p.dispatchInvocations(static_cast<std::uint64_t>(irradiance.width()) *
                          static_cast<std::uint64_t>(irradiance.height()));
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
}

}  // namespace mv
