#include "renderer/passes/near_field_pass.h"

#include "shaders/shared/bindings.glsl"

namespace mv {

gl::Program& NearFieldPass::program(const NearFieldScene& scene) {
    const bool emits = scene.emissionScale > 0, sky = scene.sky;
    gl::Program& p = programs_[scene.triangles->passing()][emits ? 1 : 0][sky ? 1 : 0];
    if (!p) {
        gl::Defines defines = scene.triangles->rayDefines();
        if (emits) defines.emplace_back("MV_EMISSION", "1");
        if (sky) defines.emplace_back("MV_SKY", "1");
        p = gl::Program("near field", {"passes/near_field.comp"}, defines);
    }
    scene.triangles->bind(p, scene.gloss);
    scene.lights->bindTexels();
    p.set("lightCount", scene.lights->count());
    p.set("bounces", static_cast<std::uint32_t>(scene.bounces));
    p.set("fixedDistance", static_cast<float>(scene.clampDistance.value_or(-1)));
    if (emits) p.set("emissionScale", scene.emissionScale);
    if (sky) {
        scene.sky->bind(p);
        p.set("tableShare", scene.sky->sky()->tableShare);
    }
    return p;
}

void NearFieldPass::render(const NearFieldScene& scene, const GpuViewHierarchy& hierarchy,
                           const GatherViews& views, const GatherLists& lists,
                           const Resting& resting, const gl::Texture& irradiance) {
    gl::Program& p = program(scene);
    resting.bind(p);
    lists.surfaces.bind(kUnitSurfaces);
    lists.planes.bind(kUnitPlanes);
    hierarchy.sortedViews.bindTexels(kUnitSortedViews);
    hierarchy.mortonKeys.bindTexels(kUnitViewKeys);
    views.clampDistances.bindTexels(kUnitClampDistances);
    irradiance.bindImage(kImageIrradiance, GL_READ_WRITE, GL_RGBA32F);
    p.set("size", glm::ivec2(irradiance.width(), irradiance.height()));
    p.set("viewCount", views.count);
    p.set("seed", scene.seed);
    p.set("accumulationIndex", scene.accumulationIndex);
    p.set("edgeM", static_cast<float>(scene.rootEdge));
    p.dispatch2D(irradiance.width(), irradiance.height());
}

}  // namespace mv
