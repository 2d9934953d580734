#include "renderer/passes/average_pixels_pass.h"

#include <cassert>
#include <cmath>

#include "shaders/shared/bindings.glsl"

namespace mv {

void AveragePixelsPass::render(const gl::Texture& radiance, int ev, gl::Profiler& profiler,
                               PixelMeans& means) {
    const gl::PassScope scope(profiler, Stage::accumulate);
    const int width = radiance.width(), height = radiance.height();
    if (!program_) {
        program_ = gl::Program("average pixels", {"passes/average_pixels.comp"});
    }
    if (means.points == 0) {
        means.radiance.ensure("mean radiance", GL_TEXTURE_2D, GL_RGBA32F, width, height);
        means.display.ensure("mean for display", GL_TEXTURE_2D, GL_RGBA32F, width, height);
        means.ev = ev;
    }
    assert(means.radiance.width() == width && means.radiance.height() == height);
    ++means.points;
    radiance.bind(kUnitRadiance);
    means.radiance.bindImage(kImageMean, GL_READ_WRITE, GL_RGBA32F);
    means.display.bindImage(kImageDisplayMean, GL_READ_WRITE, GL_RGBA32F);
    program_.set("size", glm::ivec2(width, height));
    program_.set("points", static_cast<float>(means.points));
    program_.set("exposure", std::exp2(static_cast<float>(means.ev)));
    program_.dispatch2D(width, height);
}

}  // namespace mv
