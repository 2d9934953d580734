#include "renderer/passes/history_pass.h"

#include <array>
#include <cassert>

#include "renderer/gl/context.h"
#include "shaders/shared/bindings.glsl"

namespace mv {

void HistoryPass::render(const GBuffer& gbuffer, const gl::Texture& surfaces, int scale,
                         const gl::Texture& set, int samples, const HistoryOptions& options) {
    assert(options.history && options.frames >= 1 && samples >= 1);
    LightHistory& old = *options.history;
    const int width = set.width(), height = set.height();
    light_.ensure("light before", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    samples_.ensure("samples before", GL_TEXTURE_2D, GL_R32F, width, height);
    surfaces.bind(kUnitSurfaces);
    gbuffer.normal.bind(kUnitNormal);
    const gl::Framebuffer before("reproject", {&light_, &samples_});
    if (old.light) {
        old.surfaces.bind(kUnitRememberedSurfaces);
        old.light.bind(kUnitRememberedLight);
        old.samples.bind(kUnitRememberedSamples);
        const bool moves = gbuffer.largestStep > 0;
        gl::Program& p = moves ? reprojectMoving_ : reproject_;
        if (!p) {
            gl::Defines defines;
            if (moves) defines.emplace_back("MV_MOVES", "1");
            p = gl::Program("reproject", {"passes/full_screen.vert", "passes/reproject.frag"},
                            defines);
        }
        if (moves) {
            gbuffer.position.bind(kUnitPosition);
            p.set("largestStep", gbuffer.largestStep);
        }
        p.set("clipFromRoot", old.clipFromRoot);
        p.set("oldPixels", old.pixels);
        p.set("oldScale", old.scale);
        p.set("scale", scale);
        p.set("pixelSize", gbuffer.pixelSize);
        p.use();
        before.bind();
        gl::drawFullScreen(empty_);
    } else {
        for (const gl::Texture* t : {&light_, &samples_}) {
            glClearTexImage(t->id(), 0, GL_RGBA, GL_FLOAT, nullptr);
        }
    }

    old.clipFromRoot = options.clipFromRoot;
    old.pixels = {gbuffer.width, gbuffer.height};
    old.scale = scale;
    old.light.ensure("remembered light", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    old.samples.ensure("remembered samples", GL_TEXTURE_2D, GL_R32F, width, height);
    old.surfaces.ensure("remembered surfaces", GL_TEXTURE_2D, GL_RGBA32UI, width, height);
    set.bind(kUnitFilterSource);
    light_.bind(kUnitRememberedLight);
    samples_.bind(kUnitRememberedSamples);
    remember_.set("scale", scale);
    remember_.set("pixelSize", gbuffer.pixelSize);
    remember_.set("samples", static_cast<float>(samples));
    remember_.set("mostSamples", static_cast<float>(samples * options.frames));
    remember_.set("mayChange", options.mayChange);
    remember_.use();
    const gl::Framebuffer target("remember", {&old.light, &old.samples});
    target.bind();
    gl::drawFullScreen(empty_);
    glCopyImageSubData(surfaces.id(), GL_TEXTURE_2D, 0, 0, 0, 0, old.surfaces.id(), GL_TEXTURE_2D,
                       0, 0, 0, 0, width, height, 1);
}

}  // namespace mv
