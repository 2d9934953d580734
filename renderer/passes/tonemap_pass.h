#pragma once
// Stage "tone map": radiance -> picture, by exposure, tone curve and sRGB.

#include <map>
#include <utility>

#include "megaviews/settings/settings.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/average_pixels_pass.h"

namespace mv {

class TonemapPass {
  public:
    struct Options {
        double exposureEv = 0;
        ToneMap curve{};
        DebugView view{};  // views of data, like normals, have neither exposure nor curve
    };
    // radiance * 2^ev, tone mapped, sRGB encoded into RGBA8, alpha 1.
    void render(const gl::Texture& radiance, const Options& options, gl::Profiler& profiler,
                gl::Texture& display);
    // The same of PixelMeans::display.
    void render(const PixelMeans& means, const Options& options, gl::Profiler& profiler,
                gl::Texture& display);

  private:
    gl::Program& programOf(DebugView view, ToneMap toneMap);
    // meanExposure: of the display's mean over a pixel; 0: of radiance as it is.
    void draw(const gl::Texture& radiance, float meanExposure, const Options& options,
              gl::Profiler& profiler, gl::Texture& display);

    std::map<std::pair<DebugView, ToneMap>, gl::Program> programs_;
};

}  // namespace mv
