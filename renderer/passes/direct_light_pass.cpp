#include "renderer/passes/direct_light_pass.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <spdlog/spdlog.h>

#include "renderer/gl/context.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/light.glsl"

namespace mv {

// By luminance of their flux; equals in the order of the scene.
std::vector<LightRecord> DirectLightPass::strongest(const std::vector<LightRecord>& lights) {
    const auto power = [](const LightRecord& l) {
        // The sky has flux and no intensity: its light is the gather's.
        const float p = luminance({l.intensityR, l.intensityG, l.intensityB}) > 0
                            ? luminance({l.fluxR, l.fluxG, l.fluxB})
                            : 0.0f;
        return std::isfinite(p) ? p : 0.0f;
    };
    std::vector<LightRecord> out;
    std::copy_if(lights.begin(), lights.end(), std::back_inserter(out),
                 [&](const LightRecord& l) { return power(l) > 0; });
    std::stable_sort(out.begin(), out.end(), [&](const LightRecord& a, const LightRecord& b) {
        return power(a) > power(b);
    });
    constexpr std::size_t kMost = kMostLights;
    ignored_ = static_cast<int>(std::max(out.size(), kMost) - kMost);
    out.resize(std::min(out.size(), kMost));
    if (ignored_ > 0 && ignored_ != loggedIgnored_) {
        spdlog::warn("{} of {} punctual lights give no direct light: only the {} strongest do",
                     ignored_, lights.size(), kMostLights);
    }
    loggedIgnored_ = ignored_;
    return out;
}

void DirectLightPass::render(const std::vector<LightRecord>& lights, const RootCube& root,
                             const BvhTables& triangles, const GBuffer& gbuffer,
                             gl::Profiler& profiler, gl::Texture& out) {
    const gl::PassScope scope(profiler, Stage::directLight);
    out.ensure("direct light", GL_TEXTURE_2D, GL_RGBA32F, gbuffer.width, gbuffer.height);
    const gl::Framebuffer target("direct light", {&out});
    constexpr float kZero[4] = {0, 0, 0, 0};
    glClearNamedFramebufferfv(target.id(), GL_COLOR, 0, kZero);
    target.bind();
    const int gloss = gbuffer.glossKind();
    gl::Program& p = programs_[triangles.masks() ? 1 : 0][gloss];
    if (!p) {
        gl::Defines defines = triangles.rayDefines();
        gbuffer.addGlossDefines(defines);
        p = gl::Program("direct light", {"passes/full_screen.vert", "passes/direct.frag"}, defines);
    }
    triangles.bind(p);
    gbuffer.position.bind(kUnitPosition);
    gbuffer.normal.bind(kUnitNormal);
    gbuffer.plane.bind(kUnitPlane);
    gbuffer.albedo.bind(kUnitAlbedo);
    p.set("edgeM", static_cast<float>(root.edge));
    if (gloss > 0) gbuffer.bindGloss(p);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    for (const LightRecord& l : strongest(lights)) {
        p.set("type", l.type);
        p.set("place", glm::vec3(l.positionX, l.positionY, l.positionZ));
        p.set("direction", glm::vec3(l.directionX, l.directionY, l.directionZ));
        p.set("intensity", glm::vec3(l.intensityR, l.intensityG, l.intensityB));
        p.set("cosInner", l.cosInner);
        p.set("cosOuter", l.cosOuter);
        p.use();
        gl::drawFullScreen(empty_);
    }
    glDisable(GL_BLEND);
}

}  // namespace mv
