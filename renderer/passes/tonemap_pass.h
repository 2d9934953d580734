#pragma once
// Radiance -> picture: direct + albedo/pi * irradiance + emission, then exposure, tone map, sRGB;
// debug views; the count of texels that are NaN or infinite.

#include <memory>
#include <optional>

#include "megaviews/settings/settings.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/read_back.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/gbuffer_pass.h"

namespace mv {

class TonemapPass {
  public:
    TonemapPass();
    ~TonemapPass();
    struct Input {
        const GBuffer* gbuffer = nullptr;
        const gl::Texture* direct = nullptr;
        const gl::Texture* irradiance = nullptr;  // filtered; nullptr: none
        const gl::Texture* unfilteredIrradiance = nullptr;
        const gl::Texture* candidates = nullptr;  // of GatherResult
        const gl::Texture* reflected = nullptr;   // radiance of gloss; nullptr: none
        float emissionScale = 1;                  // of the G-buffer's surfaces
    };
    // The linear radiance of the chosen view, RGBA32F, before exposure: what EXR stores. Data
    // views hold their data: normals in [-1,1], linear albedo, depth in root-cube units, the
    // share of candidates in [0,1]; 0 where there is no surface. DebugView::nan composes the final
    // picture.
    void compose(const Input& input, DebugView view, gl::Profiler& profiler, gl::Texture& radiance);
    // EV so that the log-mean luminance of the radiance becomes 0.18; nothing for a black picture.
    // Texels without a surface and emitters do not count, nor do black ones; what is darker than
    // 1 % of the mean counts as that, so that a shadow does not set the exposure. Less where the
    // tone map would show more than 2 % of those texels as 94 % of white or above: sun must not
    // drown in the shade's exposure. Where the sky takes more than a third of the picture, its
    // log-mean is at most 2.5 EV above 0.18, and surfaces of a mean albedo above 0.4 are brighter
    // by that ratio, at most twice as bright: a white statue is shown lighter than grey.
    std::optional<double> fitExposure(const gl::Texture& radiance, const GBuffer& gbuffer,
                                      ToneMap toneMap);
    // Means over the points of each pixel, RGBA32F: of radiance, for files and measurements, and
    // for a display at an exposure near 2^ev (shaders/passes/average_pixels.comp).
    struct Means {
        gl::Texture radiance, display;
        int points = 0, ev = 0;
        std::uint64_t bytes() const { return radiance.bytes() + display.bytes(); }
    };
    // One more point of every pixel into the means; the first decides their ev.
    void average(const gl::Texture& radiance, int ev, gl::Profiler& profiler, Means& means);
    // Counts texels that are NaN or infinite; badPixels() sums up what `counts` then gives.
    void countBadPixels(const gl::Texture& radiance, gl::ReadBack& counts);
    static std::uint64_t badPixels(const std::vector<std::uint32_t>& counts);
    // radiance * 2^ev, tone mapped (data views like normals are not), sRGB encoded into RGBA8,
    // alpha 1.
    void tonemap(const gl::Texture& radiance, double exposureEv, ToneMap toneMap, DebugView view,
                 gl::Profiler& profiler, gl::Texture& display);
    // The same of Means::display.
    void tonemap(const Means& means, double exposureEv, ToneMap toneMap, DebugView view,
                 gl::Profiler& profiler, gl::Texture& display);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv
