#include "renderer/passes/direct_light_pass.h"

#include "shaders/shared/bindings.glsl"

namespace mv {
namespace {

constexpr std::uint32_t kLightsAtOnce = 16;  // where somebody watches

}  // namespace

void DirectLightPass::render(const GpuLights& lights, const RootCube& root,
                             const BvhTables& triangles, const GBuffer& gbuffer,
                             gl::Profiler& profiler, gl::Texture& out) {
    const gl::PassScope scope(profiler, Stage::directLight);
    out.ensure("direct light", GL_TEXTURE_2D, GL_RGBA32F, gbuffer.width, gbuffer.height);
    const gl::Framebuffer target("direct light", {&out});
    constexpr float kZero[4] = {0, 0, 0, 0};
    glClearNamedFramebufferfv(target.id(), GL_COLOR, 0, kZero);
    const int gloss = gbuffer.glossKind();
    const bool clear = gloss > 0 && gbuffer.clear;
    gl::Program& p = programs_[triangles.passing()][gloss][clear ? 1 : 0];
    if (!p) {
        gl::Defines defines = triangles.rayDefines();
        gbuffer.addGlossDefines(defines);
        if (clear) defines.emplace_back("MV_CLEAR", "1");
        p = gl::Program("direct light", {"passes/full_screen.vert", "passes/direct.frag"}, defines);
    }
    const auto bind = [&] {
        triangles.bind(p, gbuffer.isFull());
        lights.bindTexels();
        gbuffer.position.bind(kUnitPosition);
        gbuffer.normal.bind(kUnitNormal);
        gbuffer.plane.bind(kUnitPlane);
        gbuffer.albedo.bind(kUnitAlbedo);
        p.set("edgeM", static_cast<float>(root.edge));
        if (gloss > 0) gbuffer.bindGloss(p);
        if (clear) gbuffer.clear.bind(kUnitClear);
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE);
    };
    bind();
    for (std::uint32_t i = 0; i < lights.count(); ++i) {
        if (profiler.watched() && i % kLightsAtOnce == kLightsAtOnce - 1) {
            glDisable(GL_BLEND);
            profiler.report(Stage::directLight, static_cast<double>(i) / lights.count());
            bind();  // who watches may have drawn
        }
        p.set("light", i);
        p.drawFullScreen(target);
    }
    glDisable(GL_BLEND);
}

}  // namespace mv
