#pragma once
// GBuffer x punctual lights -> direct radiance, highlights on gloss included, shadowed by a ray a
// pixel and light: as fine as the picture.

#include <vector>

#include "megaviews/scene/scene.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/gl/vertex_array.h"
#include "renderer/passes/bvh_tables.h"
#include "renderer/passes/gbuffer_pass.h"

namespace mv {

class DirectLightPass {
  public:
    // lights: LightRecords in root-cube units (mv::makeEmitters), the strongest kMostLights of
    // them. out: RGB of RGBA32F, radiance = albedo/pi * E_direct (no emission); what gloss
    // reflects is in it, too, but of surfaces that rays met.
    void render(const std::vector<LightRecord>& lights, const RootCube& root,
                const BvhTables& triangles, const GBuffer& gbuffer, gl::Profiler& profiler,
                gl::Texture& out);
    static constexpr int kMostLights = 64;
    int ignoredLights() const { return ignored_; }  // by the last render

  private:
    std::vector<LightRecord> strongest(const std::vector<LightRecord>& lights);
    gl::Program programs_[2][3];  // with alpha masks: the second; GBuffer::glossKind()
    gl::VertexArray empty_{"direct light: no attributes"};
    int ignored_ = 0, loggedIgnored_ = 0;
};

}  // namespace mv
