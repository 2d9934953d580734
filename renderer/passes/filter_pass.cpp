#include "renderer/passes/filter_pass.h"

#include "renderer/gl/context.h"
#include "shaders/shared/bindings.glsl"

namespace mv {

const gl::Texture& FilterPass::render(const GBuffer& gbuffer, const gl::Texture& surfaces,
                                      int scale, const gl::Texture& noisy, int passes,
                                      gl::Texture* last) {
    program_.set("scale", scale);
    program_.set("pixelSize", gbuffer.pixelSize);
    const gl::Texture* source = &noisy;
    for (int i = 0; i < passes; ++i) {
        gl::Texture* target = i % 2 == 0 ? &ping_ : &pong_;
        if (i + 1 == passes && last) target = last;
        target->ensure("filtered irradiance", GL_TEXTURE_2D, GL_RGBA32F, noisy.width(),
                       noisy.height());
        source->bind(kUnitFilterSource);
        surfaces.bind(kUnitSurfaces);
        gbuffer.normal.bind(kUnitNormal);
        program_.set("spacing", 1 << i);
        program_.use();
        const gl::Framebuffer framebuffer("filter", {target});
        framebuffer.bind();
        gl::drawFullScreen(empty_);
        source = target;
    }
    return *source;
}

}  // namespace mv
