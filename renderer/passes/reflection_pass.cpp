#include "renderer/passes/reflection_pass.h"

#include <numbers>

#include "megaviews/core/colour.h"
#include "shaders/shared/bindings.glsl"

namespace mv {
namespace {

constexpr int kFilterPasses = 4;

}  // namespace

void ReflectionPass::trace(Follow what, const GBuffer& gbuffer, const ReflectedScene& scene,
                           std::uint32_t seed, std::uint32_t set, gl::Profiler& profiler,
                           GBuffer& met) {
    const gl::PassScope scope(profiler, Stage::reflections);
    const bool through = what == Follow::clear;
    const bool coats = !through && gbuffer.coat;
    const bool asks = !through && scene.lamps && !scene.lamps->triangles.empty();
    gl::Defines defines = scene.triangles.rayDefines();
    if (scene.sky) defines.emplace_back("MV_SKY", "1");
    if (through) defines.emplace_back("MV_THROUGH", "1");
    if (coats) defines.emplace_back("MV_COAT", "1");
    if (gbuffer.filled) defines.emplace_back("MV_FILLED", "1");
    if (scene.triangles.mirrors()) defines.emplace_back("MV_MIRRORS", "1");
    if (asks) defines.emplace_back("MV_LAMPS", "1");
    gl::Program& p = trace_[defines];
    if (!p) {
        p = gl::Program("reflect", {"passes/full_screen.vert", "passes/reflect.frag"}, defines);
    }
    met.resize(gbuffer.width, gbuffer.height, {.gloss = true});
    met.pixelSize = gbuffer.pixelSize;
    scene.triangles.bind(p, true);
    if (scene.sky) scene.sky->bind(p);
    gbuffer.position.bind(kUnitPosition);
    gbuffer.normal.bind(kUnitNormal);
    gbuffer.plane.bind(kUnitPlane);
    if (through) gbuffer.clear.bind(kUnitClear);
    if (through && gbuffer.filled) gbuffer.emission.bind(kUnitEmission);
    gbuffer.bindGloss(p);
    if (asks) {
        const EmissiveSurfaces& surfaces = *scene.lamps;
        if (lampsInBuffer_ != scene.lamps) lamps_ = {"lamps", surfaces.triangles};
        lampsInBuffer_ = scene.lamps;
        lamps_.bindTexels(kUnitEmissive);
        // Triangles are drawn by their flux, pi * area * radiance.
        const double luminance = luminanceOf(glm::dvec3(surfaces.fluxW));
        p.set("lampTriangles", static_cast<std::uint32_t>(surfaces.triangles.size()));
        p.set("lampDensity", static_cast<float>(std::numbers::pi / luminance));
        p.set("rootEdge2", static_cast<float>(scene.rootEdge * scene.rootEdge));
    }
    p.set("emissionScale", scene.lampScale);
    p.set("seed", seed);
    p.set("set", set);
    p.drawFullScreen(met.framebuffer);
}

void ReflectionPass::reflect(Follow what, const GBuffer& gbuffer, const GBuffer& met,
                             const gl::Texture& light, bool filter, gl::Profiler& profiler,
                             gl::Texture& out) {
    const gl::PassScope scope(profiler, Stage::reflections);
    const bool coats = what == Follow::gloss && gbuffer.coat;
    gl::Program& p = filter_[coats ? 1 : 0];
    if (!p) {
        gl::Defines defines;
        if (coats) defines.emplace_back("MV_COAT", "1");
        p = gl::Program("reflections' filter",
                        {"passes/full_screen.vert", "passes/reflect_filter.frag"}, defines);
    }
    out.ensure("reflected light", GL_TEXTURE_2D, GL_RGBA32F, gbuffer.width, gbuffer.height);
    p.set("pixelSize", gbuffer.pixelSize);
    const gl::Texture* source = &light;
    const int passes = filter ? kFilterPasses : 1;
    for (int i = 0; i < passes; ++i) {
        const bool last = i + 1 == passes;
        gl::Texture& target = last ? out : i % 2 == 0 ? ping_ : pong_;
        target.ensure("reflected light", GL_TEXTURE_2D, GL_RGBA32F, gbuffer.width, gbuffer.height);
        source->bind(kUnitFilterSource);
        gbuffer.position.bind(kUnitPosition);
        gbuffer.normal.bind(kUnitNormal);
        (what == Follow::gloss ? gbuffer.gloss : gbuffer.clear).bind(kUnitGloss);
        if (coats) gbuffer.coat.bind(kUnitCoat);
        met.gloss.bind(kUnitReflectionWeight);
        p.set("spacing", filter ? 1 << i : 0);
        p.set("last", last ? 1 : 0);
        if (last && what == Follow::clear) {
            glEnable(GL_BLEND);
            glBlendFunc(GL_ONE, GL_ONE);
        }
        p.drawFullScreen(gl::Framebuffer("reflected light", {&target}));
        glDisable(GL_BLEND);
        source = &target;
    }
}

}  // namespace mv
