#pragma once
// Stage "history": a frame's gathered light, averaged with that of the frames before for pixels
// that show the same surfaces (shaders/passes/reproject.frag, remember.frag). It lies between
// gather and filter, so what is remembered are samples, not what a filter has made of them.

#include <glm/glm.hpp>

#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/gbuffer_pass.h"

namespace mv {

// What is remembered of the frame before; empty textures: nothing.
struct LightHistory {
    glm::mat4 clipFromRoot{1};  // of its camera
    glm::ivec2 pixels{0};       // of its G-buffer
    int scale = 1;              // of those, each way, a pixel of the gather
    gl::Texture surfaces;       // RGBA32UI, as GatherLists::surfaces
    gl::Texture light;          // RGBA32F: irradiance, w = variance of its luminance
    gl::Texture samples;        // R32F: that its mean is worth
    std::uint64_t bytes() const { return surfaces.bytes() + light.bytes() + samples.bytes(); }
};

struct HistoryOptions {
    LightHistory* history = nullptr;  // null: every frame stands alone
    glm::mat4 clipFromRoot{1};        // of this frame's camera
    int frames = 1;                   // as many samples as theirs are remembered, >= 1
    bool mayChange = false;           // the light is not that of the frame before
    bool keepsOwnLight = false;       // the light without the history is wanted, too
    bool gathersInTurns = false;      // pixels that remember enough, of light that stays
};

// Which pixels gather nothing in a frame, for they remember enough (shaders/passes/rests.glsl).
struct Resting {
    const gl::Texture* samples = nullptr;  // that pixels remember; null: all gather
    float from = 0;                        // so many are enough
    std::uint32_t turn = 0;
    void bind(gl::Program& program) const;
};

class HistoryPass {
  public:
    // Before the gather: finds what the pixels of `surfaces`, one for scale x scale pixels of the
    // G-buffer, remember. samples: that each will gather, in the `frame`-th frame.
    Resting reproject(const GBuffer& gbuffer, const gl::Texture& surfaces, int scale, int samples,
                      std::uint32_t frame, const HistoryOptions& options);
    // After the gather, with the same arguments: averages. set: RGBA32F, w = variance of the
    // luminance, of `samples` a pixel but for those that rest; the same texels as `surfaces`.
    // Leaves the mean in `history.light`.
    void remember(const GBuffer& gbuffer, const gl::Texture& surfaces, int scale,
                  const gl::Texture& set, int samples, const Resting& resting,
                  const HistoryOptions& options);
    std::uint64_t bytes() const { return light_.bytes() + samples_.bytes(); }

  private:
    gl::Program reproject_, reprojectMoving_;  // made at first use
    gl::Program remember_{"remember", {"passes/full_screen.vert", "passes/remember.frag"}};
    gl::Texture light_, samples_;  // of the frame before, at this frame's pixels
};

}  // namespace mv
