#include "renderer/passes/tonemap_pass.h"

#include <cmath>
#include <string>

#include "megaviews/settings/debug_legends.h"
#include "shaders/shared/bindings.glsl"

namespace mv {

static_assert(static_cast<int>(ToneMap::none) == 0 && static_cast<int>(ToneMap::aces) == 1 &&
              static_cast<int>(ToneMap::neutral) == 2 && static_cast<int>(ToneMap::agx) == 3);

gl::Program& TonemapPass::programOf(DebugView view, ToneMap toneMap) {
    gl::Program& p = programs_[{view, toneMap}];
    if (!p) {
        p = gl::Program("tone map", {"passes/full_screen.vert", "passes/tonemap.frag"},
                        {{"MV_VIEW", std::to_string(static_cast<int>(view))},
                         {"MV_TONE_MAP", std::to_string(static_cast<int>(toneMap))}});
    }
    return p;
}

void TonemapPass::render(const gl::Texture& radiance, const Options& options,
                         gl::Profiler& profiler, gl::Texture& display) {
    draw(radiance, 0, options, profiler, display);
}

void TonemapPass::render(const PixelMeans& means, const Options& options, gl::Profiler& profiler,
                         gl::Texture& display) {
    draw(means.display, std::exp2(static_cast<float>(means.ev)), options, profiler, display);
}

void TonemapPass::draw(const gl::Texture& radiance, float meanExposure, const Options& options,
                       gl::Profiler& profiler, gl::Texture& display) {
    const gl::PassScope scope(profiler, Stage::toneMap);
    display.ensure("display", GL_TEXTURE_2D, GL_RGBA8, radiance.width(), radiance.height());
    radiance.bind(kUnitRadiance);
    gl::Program& program = programOf(options.view, options.curve);
    program.set("exposure", static_cast<float>(std::exp2(options.exposureEv)));
    program.set("meanExposure", meanExposure);
    if (const DebugLegend& legend = legendOf(options.view); legend.kind == LegendKind::scale) {
        const auto axis = [&](double x) { return legend.logarithmic ? std::log2(x) : x; };
        const double slope = 1 / (axis(legend.high) - axis(legend.low));
        program.set("scale", static_cast<float>(slope));
        program.set("scaleOffset", static_cast<float>(-axis(legend.low) * slope));
        program.set("logarithmic", legend.logarithmic ? 1 : 0);
        program.set("grey", legend.colours == ColourMap::grey ? 1 : 0);
    }
    program.drawFullScreen(gl::Framebuffer("display", {&display}));
}

}  // namespace mv
