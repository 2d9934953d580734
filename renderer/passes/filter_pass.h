#pragma once
// Stage "filter": a cross-bilateral filter of gathered irradiance on normals, planes and its own
// variance (shaders/passes/filter.frag), passes of 3 x 3 taps, each twice as wide, and then no
// fireflies (fireflies.frag).

#include <optional>

#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/gbuffer_pass.h"

namespace mv {

// How far a pixel alone may differ from the light of those around it
// (shaders/passes/fireflies.frag).
struct OutlierLimit {
    float factor = 0;
    bool dark = false;  // also the darker ones
};

class FilterPass {
  public:
    // noisy: RGBA32F, w = variance of the luminance; one texel for `scale` x `scale` pixels of the
    // G-buffer, whose surfaces are `surfaces`. passes: 0 gives `noisy` itself. outliers: unset,
    // they stay as they are. The result lies in `last` if that is given and passes > 0, else in a
    // texture that is valid until the next call.
    const gl::Texture& render(const GBuffer& gbuffer, const gl::Texture& surfaces, int scale,
                              const gl::Texture& noisy, int passes,
                              std::optional<OutlierLimit> outliers, gl::Texture* last);
    std::uint64_t bytes() const { return ping_.bytes() + pong_.bytes(); }

  private:
    void draw(gl::Program& program, const gl::Texture& source, gl::Texture& target);

    gl::Program program_{"filter", {"passes/full_screen.vert", "passes/filter.frag"}};
    gl::Program fireflies_{"fireflies", {"passes/full_screen.vert", "passes/fireflies.frag"}};
    gl::Texture ping_, pong_;
};

}  // namespace mv
