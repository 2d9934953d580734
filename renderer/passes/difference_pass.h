#pragma once
// Radiance of two sides -> their difference in colours: absolute, signed or relative, as
// shaders/shared/colour_map.glsl defines it, over a range that is given or found.

#include <memory>
#include <optional>

#include "megaviews/settings/settings.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/texture.h"

namespace mv {

class DifferencePass {
  public:
    DifferencePass();
    ~DifferencePass();
    // kind: not off. radiance: RGBA32F, right minus left. display: RGBA8 in colours; magenta where
    // either side is NaN or infinite. exposureEv: relative differences take 1 % of middle grey at
    // this exposure for black. Returns the end of the colour scale: `range`, or where there is none
    // the 99th percentile of |difference| over all numbers of the picture, rounded up by less than
    // 1 %; its maximum where that is 0; 1 where there is no difference at all. Without a given
    // range it reads a histogram back (one synchronisation).
    double render(const gl::Texture& left, const gl::Texture& right, Difference kind,
                  std::optional<double> range, double exposureEv, gl::Profiler& profiler,
                  gl::Texture& radiance, gl::Texture& display);
    std::uint64_t bytes() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv
