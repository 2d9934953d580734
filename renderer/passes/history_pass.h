#pragma once
// Stage "history": a frame's gathered light, averaged with that of the frames before for pixels
// that show the same surfaces (shaders/passes/reproject.frag, remember.frag). It lies between
// gather and filter, so what is remembered are samples, not what a filter has made of them.

#include <glm/glm.hpp>

#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/gl/vertex_array.h"
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
    bool beside = false;              // the frame's own light is wanted too
};

class HistoryPass {
  public:
    // set: RGBA32F, w = variance of the luminance, of `samples` a pixel; the same texels as
    // `surfaces`, one for scale x scale pixels of the G-buffer. Leaves the mean in `history.light`.
    void render(const GBuffer& gbuffer, const gl::Texture& surfaces, int scale,
                const gl::Texture& set, int samples, const HistoryOptions& options);
    std::uint64_t bytes() const { return light_.bytes() + samples_.bytes(); }

  private:
    gl::Program reproject_, reprojectMoving_;  // made at first use
    gl::Program remember_{"remember", {"passes/full_screen.vert", "passes/remember.frag"}};
    gl::VertexArray empty_{"history: no attributes"};
    gl::Texture light_, samples_;  // of the frame before, at this frame's pixels
};

}  // namespace mv
