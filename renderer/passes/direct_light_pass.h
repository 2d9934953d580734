#pragma once
// GBuffer x punctual lights -> direct radiance, with shadow maps: 2-D for spot and sun, the six
// faces of a cube for point lights (and spots too wide for one map); the eight strongest.

#include <memory>
#include <vector>

#include "megaviews/scene/scene.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/gbuffer_pass.h"

namespace mv {

class DirectLightPass {
  public:
    DirectLightPass();
    ~DirectLightPass();
    // lights: LightRecords in root-cube units (mv::makeEmitters). Shadow maps are kept while the
    // lights are unchanged. out: RGBA32F radiance = albedo/pi * E_direct (no emission).
    void render(const std::vector<LightRecord>& lights, const RootCube& root, GBufferPass& scene,
                const GBuffer& gbuffer, gl::Profiler& profiler, gl::Texture& out);
    int ignoredLights() const;    // beyond the eight strongest
    int renderedShadows() const;  // shadow maps drawn by the last render, cube faces counted singly
    std::uint64_t bytes() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv
