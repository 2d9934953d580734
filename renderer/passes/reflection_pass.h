#pragma once
// Stage "reflections": what glossy surfaces show, and what is seen through clear ones. GBuffer -> a
// ray a pixel along the gloss, or on through the surface -> the surfaces that the rays meet, as a
// G-buffer that is lit like the other; then their light, filtered as far as a lobe of the gloss
// reaches -> reflected radiance. Approximate: gloss is followed once, what is met is matt and,
// where it is clear and not filled, there for rays or not (Material::rayCutoff()); what is rougher
// than kRoughestGloss is matt itself (microfacet.glsl).

#include <cstdint>
#include <map>
#include <memory>

#include "megaviews/views/frame_camera.h"
#include "megaviews/views/view_set.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/bvh_tables.h"
#include "renderer/passes/gbuffer_pass.h"
#include "renderer/passes/sky_pass.h"

namespace mv {

enum class Follow { gloss, clear };

// What rays meet.
struct ReflectedScene {
    const BvhTables& triangles;
    const GpuSky* sky = nullptr;  // null: none
    // What rough gloss asks beside its rays; null: none. And how bright they are beside the file's.
    std::shared_ptr<const EmissiveSurfaces> lamps;
    float lampScale = 1;
    double rootEdge = 1;  // m
};

class ReflectionPass {
  public:
    // One ray for each pixel with gloss (GBuffer::gloss) or behind which something is seen
    // (GBuffer::clear), another for each set of samples. met: the surfaces that they meet, the
    // sky's light where they meet none; its gloss says what of the light comes back.
    void trace(Follow what, const GBuffer& gbuffer, const ReflectedScene& scene, std::uint32_t seed,
               std::uint32_t set, gl::Profiler& profiler, GBuffer& met);
    // light: radiance of `met` towards the rays, RGBA32F -> out: the radiance that comes back,
    // RGB of RGBA32F; light of what is clear is added to it.
    void reflect(Follow what, const GBuffer& gbuffer, const GBuffer& met, const gl::Texture& light,
                 bool filter, gl::Profiler& profiler, gl::Texture& out);
    std::uint64_t bytes() const { return ping_.bytes() + pong_.bytes() + lamps_.bytes(); }

  private:
    std::map<gl::Defines, gl::Program> trace_;
    gl::TexelBuffer<EmissiveTriangle> lamps_;
    std::shared_ptr<const EmissiveSurfaces> lampsInBuffer_;
    gl::Program filter_[2];  // with coats: the second
    gl::Texture ping_, pong_;
};

}  // namespace mv
