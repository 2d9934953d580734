#pragma once
// Camera -> GBuffer -> direct light, and radiance -> picture: the raster half of the frame, shared
// by every many-view method. All positions are root-cube units.

#include <memory>
#include <optional>

#include "megaviews/scene/scene.h"
#include "megaviews/settings/settings.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

// The camera of a frame in root-cube units.
struct FrameCamera {
    glm::vec3 position{0}, forward{0, 0, -1}, up{0, 1, 0};
    float yfovRad = 0.9f;
    float orthoHalfHeight = 0;  // > 0: orthographic
    glm::mat4 viewFromWorld() const;
    glm::mat4 clipFromView(float aspect) const;  // near and far chosen for the root cube
};

// Written by GBufferPass. Texels without a surface have positionAndMask.w == 0.
struct GBuffer {
    int width = 0, height = 0;
    gl::Texture position;   // RGBA32F: root-cube position, w = 1 where there is a surface
    gl::Texture normal;     // RGBA16F: shading normal turned towards the camera, w = linear depth
                            // (distance along forward, root-cube units)
    gl::Texture albedo;     // RGBA8 or 16F, linear; unlit materials: 0
    gl::Texture emission;   // RGBA16F or 32F, W/(m^2 sr); particles are drawn into it
    gl::Texture depth;
    gl::Framebuffer framebuffer;
    std::uint64_t bytes() const;
};

class GBufferPass {
  public:
    GBufferPass();
    ~GBufferPass();
    void setScene(const Scene& scene);  // uploads vertices, textures with mips
    void render(const FrameCamera& camera, int width, int height, gl::Profiler& profiler,
                GBuffer& out);
    // Glowing particles as small discs with depth test, radiance from their flux.
    void drawParticles(const GpuViews& views, const RootCube& root, const FrameCamera& camera,
                       gl::Profiler& profiler, GBuffer& gbuffer);
    // Depth of the scene from a light; used by DirectLightPass.
    void drawDepth(const glm::mat4& clipFromWorld);
    std::uint64_t bytes() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// Punctual lights with shadow maps: 2-D for spot and sun, cube for point; the eight strongest.
class DirectLightPass {
  public:
    DirectLightPass();
    ~DirectLightPass();
    // lights: LightRecords in root-cube units (mv::makeEmitters). Shadow maps are kept while the
    // lights are unchanged. out: RGBA32F radiance = albedo/pi * E_direct (no emission).
    void render(const std::vector<LightRecord>& lights, const RootCube& root, GBufferPass& scene,
                const GBuffer& gbuffer, gl::Profiler& profiler, gl::Texture& out);
    int ignoredLights() const;  // beyond the eight strongest

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// direct + albedo/pi * irradiance + emission -> exposure, tone map, sRGB; debug views; NaN count.
class TonemapPass {
  public:
    TonemapPass();
    ~TonemapPass();
    struct Input {
        const GBuffer* gbuffer = nullptr;
        const gl::Texture* direct = nullptr;
        const gl::Texture* irradiance = nullptr;            // filtered; nullptr: none
        const gl::Texture* unfilteredIrradiance = nullptr;
        const gl::Texture* candidates = nullptr;            // share kept by gather culling, R32F
    };
    // The linear radiance of the chosen view, RGBA32F, before exposure: what EXR stores.
    void compose(const Input& input, DebugView view, gl::Profiler& profiler, gl::Texture& radiance);
    // EV so that the log-mean luminance of the radiance becomes 0.18; 0 for a black picture.
    // Texels without a surface and emitters do not count.
    double fitExposure(const gl::Texture& radiance, const GBuffer& gbuffer);
    // Counts texels that are NaN or infinite.
    std::uint64_t countBadPixels(const gl::Texture& radiance);
    // radiance * 2^ev, tone mapped (data views like normals are not), sRGB encoded into RGBA8,
    // alpha 1.
    void tonemap(const gl::Texture& radiance, double exposureEv, ToneMap toneMap, DebugView view,
                 gl::Profiler& profiler, gl::Texture& display);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv
