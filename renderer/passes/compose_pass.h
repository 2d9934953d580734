#pragma once
// Stage "compose": light on the G-buffer -> radiance, direct + albedo/pi * irradiance + reflected +
// emission, or one of them alone, or other data of the surfaces, as a debug view asks.

#include <map>

#include "megaviews/settings/settings.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/gbuffer_pass.h"

namespace mv {

class ComposePass {
  public:
    ComposePass();
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
    void render(const Input& input, DebugView view, gl::Profiler& profiler, gl::Texture& radiance);

  private:
    gl::Program& programOf(DebugView view);

    std::map<DebugView, gl::Program> programs_;
    gl::Texture black_{"no light", GL_TEXTURE_2D, GL_RGBA32F, 1, 1};
};

}  // namespace mv
