#include "renderer/passes/reflection_pass.h"

#include "renderer/gl/context.h"
#include "shaders/shared/bindings.glsl"

namespace mv {
namespace {

constexpr int kFilterPasses = 4;

}  // namespace

void ReflectionPass::trace(Follow what, const GBuffer& gbuffer, const FrameCamera& camera,
                           const BvhTables& triangles, const GpuSky* sky, std::uint32_t seed,
                           std::uint32_t set, gl::Profiler& profiler, GBuffer& met) {
    const gl::PassScope scope(profiler, Stage::reflections);
    const bool through = what == Follow::clear;
    gl::Program& p = trace_[static_cast<std::size_t>(what)][triangles.masks() ? 1 : 0][sky ? 1 : 0];
    if (!p) {
        gl::Defines defines = triangles.rayDefines();
        if (sky) defines.emplace_back("MV_SKY", "1");
        if (through) defines.emplace_back("MV_THROUGH", "1");
        p = gl::Program("reflect", {"passes/full_screen.vert", "passes/reflect.frag"}, defines);
    }
    met.resize(gbuffer.width, gbuffer.height, false, true, false);
    met.pixelSize = gbuffer.pixelSize;
    triangles.bind(p, true);
    if (sky) sky->bind(p);
    gbuffer.position.bind(kUnitPosition);
    gbuffer.normal.bind(kUnitNormal);
    gbuffer.plane.bind(kUnitPlane);
    if (through) {
        gbuffer.clear.bind(kUnitClear);
    } else {
        gbuffer.gloss.bind(kUnitGloss);
        gbuffer.albedo.bind(kUnitAlbedo);
    }
    p.set("eye", camera.position);
    p.set("forward", camera.forward);
    p.set("eyeShare", camera.orthoHalfHeight > 0 ? 0.0f : 1.0f);
    p.set("seed", seed);
    p.set("set", set);
    p.use();
    met.framebuffer.bind();
    gl::drawFullScreen(empty_);
}

void ReflectionPass::reflect(Follow what, const GBuffer& gbuffer, const GBuffer& met,
                             const gl::Texture& light, bool filter, gl::Profiler& profiler,
                             gl::Texture& out) {
    const gl::PassScope scope(profiler, Stage::reflections);
    if (!filter_) {
        filter_ = gl::Program("reflections' filter",
                              {"passes/full_screen.vert", "passes/reflect_filter.frag"});
    }
    out.ensure("reflected light", GL_TEXTURE_2D, GL_RGBA32F, gbuffer.width, gbuffer.height);
    filter_.set("pixelSize", gbuffer.pixelSize);
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
        met.gloss.bind(kUnitReflectionWeight);
        filter_.set("spacing", filter ? 1 << i : 0);
        filter_.set("last", last ? 1 : 0);
        filter_.use();
        const gl::Framebuffer framebuffer("reflected light", {&target});
        framebuffer.bind();
        if (last && what == Follow::clear) {
            glEnable(GL_BLEND);
            glBlendFunc(GL_ONE, GL_ONE);
        }
        gl::drawFullScreen(empty_);
        glDisable(GL_BLEND);
        source = &target;
    }
}

}  // namespace mv
