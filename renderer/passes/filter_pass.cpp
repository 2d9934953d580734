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
    for (int i = 0; i < 2 * passes; ++i) {
        const bool across = i % 2 == 0;
        gl::Texture* target = across ? &ping_ : &pong_;
        if (i + 1 == 2 * passes && last) target = last;
        target->ensure("filtered irradiance", GL_TEXTURE_2D, GL_RGBA32F, noisy.width(),
                       noisy.height());
        source->bind(kUnitFilterSource);
        surfaces.bind(kUnitSurfaces);
        gbuffer.normal.bind(kUnitNormal);
        program_.set("spacing", across ? glm::ivec2(1 << i / 2, 0) : glm::ivec2(0, 1 << i / 2));
        program_.use();
        const gl::Framebuffer framebuffer("filter", {target});
        framebuffer.bind();
        gl::drawFullScreen(empty_);
        source = target;
    }
    return *source;
}

}  // namespace mv
