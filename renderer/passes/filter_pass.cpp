#include "renderer/passes/filter_pass.h"

#include "shaders/shared/bindings.glsl"

namespace mv {

void FilterPass::draw(gl::Program& program, const gl::Texture& source, gl::Texture& target) {
    target.ensure("filtered irradiance", GL_TEXTURE_2D, GL_RGBA32F, source.width(),
                  source.height());
    source.bind(kUnitFilterSource);
    program.drawFullScreen(gl::Framebuffer("filter", {&target}));
}

const gl::Texture& FilterPass::render(const GBuffer& gbuffer, const gl::Texture& surfaces,
                                      int scale, const gl::Texture& noisy, int passes,
                                      std::optional<OutlierLimit> outliers, gl::Texture* last) {
    program_.set("scale", scale);
    program_.set("pixelSize", gbuffer.pixelSize);
    if (outliers) {
        fireflies_.set("factor", outliers->factor);
        fireflies_.set("dark", outliers->dark ? 1 : 0);
    }
    surfaces.bind(kUnitSurfaces);
    gbuffer.normal.bind(kUnitNormal);
    const int draws = passes > 0 && outliers ? passes + 1 : passes;
    const gl::Texture* source = &noisy;
    for (int i = 0; i < draws; ++i) {
        gl::Texture* target = i % 2 == 0 ? &ping_ : &pong_;
        if (i + 1 == draws && last) target = last;
        if (i < passes) program_.set("spacing", 1 << i);
        draw(i < passes ? program_ : fireflies_, *source, *target);
        source = target;
    }
    return *source;
}

}  // namespace mv
