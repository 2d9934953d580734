#include "renderer/passes/history_pass.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "shaders/shared/bindings.glsl"
#include "shaders/shared/history.glsl"

namespace mv {
namespace {

// Frames whose samples are enough to rest: the fewer, the sooner a picture moves faster
// (docs/viewer.md).
constexpr int kEnoughFrames = 4;

}  // namespace

void Resting::bind(gl::Program& program) const {
    if (samples) samples->bind(kUnitRememberedSamples);
    program.set("restsFrom", samples ? from : std::numeric_limits<float>::max());
    program.set("turn", turn);
}

Resting HistoryPass::reproject(const GBuffer& gbuffer, const gl::Texture& surfaces, int scale,
                               int samples, std::uint32_t frame, const HistoryOptions& options) {
    assert(options.history && options.frames >= 1 && samples >= 1);
    const LightHistory& old = *options.history;
    const int width = surfaces.width(), height = surfaces.height();
    light_.ensure("light before", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    samples_.ensure("samples before", GL_TEXTURE_2D, GL_R32F, width, height);
    surfaces.bind(kUnitSurfaces);
    gbuffer.normal.bind(kUnitNormal);
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
        p.drawFullScreen(gl::Framebuffer("reproject", {&light_, &samples_}));
    } else {
        light_.clear();
        samples_.clear();
    }

    if (!options.gathersInTurns || options.mayChange || !old.light) return {};
    const int enough = std::min(options.frames, kEnoughFrames);
    return {&samples_, static_cast<float>(samples * enough), frame % kRestTurns};
}

void HistoryPass::remember(const GBuffer& gbuffer, const gl::Texture& surfaces, int scale,
                           const gl::Texture& set, int samples, const Resting& resting,
                           const HistoryOptions& options) {
    LightHistory& old = *options.history;
    const int width = set.width(), height = set.height();
    surfaces.bind(kUnitSurfaces);
    gbuffer.normal.bind(kUnitNormal);
    old.clipFromRoot = options.clipFromRoot;
    old.pixels = {gbuffer.width, gbuffer.height};
    old.scale = scale;
    old.light.ensure("remembered light", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    old.samples.ensure("remembered samples", GL_TEXTURE_2D, GL_R32F, width, height);
    old.surfaces.ensure("remembered surfaces", GL_TEXTURE_2D, GL_RGBA32UI, width, height);
    set.bind(kUnitFilterSource);
    light_.bind(kUnitRememberedLight);
    remember_.set("scale", scale);
    remember_.set("pixelSize", gbuffer.pixelSize);
    remember_.set("samples", static_cast<float>(samples));
    remember_.set("mostSamples", static_cast<float>(samples * options.frames));
    remember_.set("mayChange", options.mayChange);
    resting.bind(remember_);
    samples_.bind(kUnitRememberedSamples);
    remember_.drawFullScreen(gl::Framebuffer("remember", {&old.light, &old.samples}));
    old.surfaces.copy(surfaces);
}

}  // namespace mv
