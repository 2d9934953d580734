#include "renderer/passes/temporal_pass.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "shaders/shared/bindings.glsl"

namespace mv {

void TemporalPass::render(const gl::Texture& radiance, const GBuffer& gbuffer, FrameCamera camera,
                          int ev, gl::Profiler& profiler, TemporalMeans& means) {
    const gl::PassScope scope(profiler, Stage::accumulate);
    if (!program_) {
        program_ = gl::Program("temporal", {"passes/temporal.comp"});
    }
    PixelMeans& now = means.means;
    const int width = radiance.width(), height = radiance.height();
    const bool fits = now.display && now.display.width() == width && now.display.height() == height;
    const bool remembers = now.points > 0 && now.ev == ev && fits;
    std::swap(now.display, means.oldDisplay);
    now.radiance.ensure("moving radiance", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    now.display.ensure("moving display", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    now.points = remembers ? std::min(now.points + 1, kTemporalFrames) : 1;
    now.ev = ev;

    camera.offset = {};
    const glm::mat4 clipFromRoot =
        camera.clipFromWorld(static_cast<float>(width) / static_cast<float>(height));
    radiance.bind(kUnitRadiance);
    gbuffer.position.bind(kUnitPosition);
    gbuffer.normal.bind(kUnitNormal);
    (remembers ? means.oldDisplay : radiance).bind(kUnitRememberedLight);
    now.radiance.bindImage(kImageMean, GL_WRITE_ONLY, GL_RGBA32F);
    now.display.bindImage(kImageDisplayMean, GL_WRITE_ONLY, GL_RGBA32F);
    program_.set("size", glm::ivec2(width, height));
    program_.set("clipFromRoot", clipFromRoot);
    program_.set("rootFromClip", glm::inverse(clipFromRoot));
    program_.set("oldClipFromRoot", remembers ? means.clipFromRoot : clipFromRoot);
    program_.set("remembers", remembers);
    program_.set("largestStep", gbuffer.largestStep);
    program_.set("exposure", std::exp2(static_cast<float>(ev)));
    program_.set("mostFrames", static_cast<float>(kTemporalFrames));
    program_.dispatch2D(width, height);
    means.clipFromRoot = clipFromRoot;
}

}  // namespace mv
