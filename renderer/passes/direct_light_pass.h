#pragma once
// GBuffer x punctual lights -> direct radiance, highlights on gloss included, shadowed by a ray a
// pixel and light: as fine as the picture.

#include "megaviews/scene/scene.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/bvh_tables.h"
#include "renderer/passes/gbuffer_pass.h"
#include "renderer/passes/punctual_lights.h"

namespace mv {

class DirectLightPass {
  public:
    // out: RGB of RGBA32F, radiance = albedo/pi * E_direct (no emission); what gloss reflects is in
    // it, too, but of surfaces that rays met.
    void render(const GpuLights& lights, const RootCube& root, const BvhTables& triangles,
                const GBuffer& gbuffer, gl::Profiler& profiler, gl::Texture& out);

  private:
    // Programs [BvhTables::passing()][GBuffer::glossKind()][anything is clear].
    gl::Program programs_[BvhTables::kPassings][3][2];
};

}  // namespace mv
