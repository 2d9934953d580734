#pragma once
// Stage "sky light": adds to gathered irradiance the light of the sky, by rays towards it
// (shaders/shared/sky.glsl) or by the maps of parallel views.

#include <cstdint>

#include "megaviews/views/sky.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texel_buffer.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/alone_pixels.h"
#include "renderer/passes/bvh_tables.h"
#include "renderer/passes/gather_cull_pass.h"
#include "renderer/passes/gbuffer_pass.h"
#include "renderer/passes/history_pass.h"
#include "renderer/passes/sky_maps.h"

namespace mv {

template <>
constexpr GLenum gl::texelFormat<SkyTexel>() {
    return GL_RGBA32F;
}

// A sky's table on the GPU.
class GpuSky {
  public:
    // Uploads where it is another than before; null frees it.
    void set(const std::shared_ptr<const Sky>& sky);
    const Sky* sky() const { return sky_.get(); }  // null: there is none
    void bindTexels() const;                       // where there is one
    void bind(gl::Program& program) const;         // and what says how to read it
    std::uint64_t bytes() const { return texels_.bytes(); }

  private:
    std::shared_ptr<const Sky> sky_;
    gl::TexelBuffer<SkyTexel> texels_;
};

// What a set of samples asks of the sky: choices hash (seed, pixel, accumulationIndex, number).
struct SkyRays {
    const GpuSky* sky = nullptr;  // null: none
    const BvhTables* triangles = nullptr;
    int samples = 4;  // directions a pixel
    // Of parallel views: asked instead, and rays only where they cannot tell; null: rays alone.
    const SkyMaps* maps = nullptr;
    // RGB: the share that is seen of the light of each pixel of the G-buffer; null: all. Where it
    // is small rays are fewer (samplesForOne()).
    const gl::Texture* seenShares = nullptr;
    std::uint32_t seed = 0, accumulationIndex = 0;
};

class SkyPass {
  public:
    // irradiance: RGBA32F, W/m^2, one texel for each of `lists.surfaces`; w gains the variance of
    // what is added.
    void render(const SkyRays& rays, const GBuffer& gbuffer, const GatherLists& lists,
                const Resting& resting, gl::Profiler& profiler, const gl::Texture& irradiance);
    // Where a gather at a lower resolution left pixels to themselves: adds to both, of the
    // G-buffer's size.
    void renderAlone(const SkyRays& rays, const GBuffer& gbuffer, const AlonePixels& pixels,
                     gl::Profiler& profiler, const gl::Texture& irradiance,
                     const gl::Texture& unfiltered);

  private:
    gl::Program& prepare(const SkyRays& rays, const GBuffer& gbuffer, bool alone,
                         const gl::Texture& irradiance);
    // A few rays a pixel at once, so that a driver that bounds loops is not in their way; and
    // where somebody watches, a few rows.
    // pixels: of the irradiance; null: all.
    static void trace(gl::Program& program, const SkyRays& rays, const gl::Texture& irradiance,
                      const AlonePixels* pixels, gl::Profiler& profiler);
    // Programs [uses sky maps][all pixels / listed pixels / thinned by seenShares]
    // [BvhTables::passing()][GBuffer::glossKind()].
    gl::Program programs_[2][3][BvhTables::kPassings][3];
};

}  // namespace mv
