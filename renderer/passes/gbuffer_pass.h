#pragma once
// Camera -> GBuffer: rasterises the scene, and glowing particles over it.

#include <memory>
#include <optional>

#include "megaviews/scene/scene.h"
#include "megaviews/settings/settings.h"
#include "megaviews/views/frame_camera.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

// What the camera sees, written by GBufferPass. Texels without a surface have position.w == 0.
struct GBuffer {
    int width = 0, height = 0;
    // GBufferPass gives each drawing a number of its own, which says what others have made of it.
    // 0: nothing is drawn, or rays met the surfaces.
    std::uint64_t drawing = 0;
    glm::vec2 pixelSize{0};  // root-cube units that a pixel covers at a depth: x + y * depth
    // Unset: these are surfaces that other surfaces' rays met.
    std::optional<FrameCamera> seenFrom;
    bool reflects = false;  // some gloss may be narrow, or something clear: rays go on
    bool filled = false;    // something clear is, so that they bend
    gl::Texture position;   // RGBA32F: root-cube position; w: 0 without a surface, else at least 1,
                            // markOfStep() (shaders/shared/motion.glsl) of how far it has moved
    float largestStep = 0;  // of any surface since the frame before; 0: nothing moves
    gl::Texture normal;     // RGBA16F: unit shading normal on the camera's side of its triangle,
                            // w = linear depth (distance along forward, root-cube units)
    gl::Texture albedo;     // RGBA16F, linear; unlit materials: 0; w = 1 where there is a surface,
                            // of one that blends how much of it is seen: all but `clear` has that
                            // factor, gloss by this
    gl::Texture plane;      // RGBA16F: unit normal of the triangle, on the camera's side; w = the
                            // share that gloss reflects at grazing angles
    // RGBA16F: the share that gloss reflects at normal incidence (0: none), and roughness; `albedo`
    // is what narrow gloss leaves, and what broad gloss reflects (microfacet.glsl). Empty where no
    // material of the scene has gloss. Of surfaces that rays met, the share of their light that
    // comes back along the ray, and alpha: the ray's length.
    gl::Texture gloss;
    // RGBA16F: the share of the light behind the surface that passes it, and the roughness that
    // spreads it. Empty where the scene has nothing of the kind; `gloss` is there where this is.
    gl::Texture clear;
    // RGBA16F: of a clear coat, which is narrow gloss above that of `gloss`, its unit normal times
    // its strength, and its roughness. Empty where nothing has one.
    gl::Texture coat;
    // RGBA32F, W/(m^2 sr); particles are drawn into it. w: the index of refraction of what fills a
    // clear surface (Material::filledIndex()).
    gl::Texture emission;
    gl::Texture depth;  // 32-bit float, reversed: FrameCamera::clipFromView
    gl::Framebuffer framebuffer;
    // By Materials::full, of a scene that needs them; so are surfaces that rays met.
    bool isFull() const { return static_cast<bool>(gloss); }
    // What shaders/passes/surface_gloss.glsl reads: 0 where there is no gloss, or of surfaces that
    // rays met, 1 gloss, 2 gloss and clear coats; what says so to shaders; and their inputs.
    int glossKind() const { return !seenFrom || !gloss ? 0 : coat ? 2 : 1; }
    void addGlossDefines(gl::Defines& defines) const;
    void bindGloss(gl::Program& program) const;
    // Textures of this size, those of another are lost.
    struct Targets {
        bool depth = false, gloss = false, clear = false, coat = false;
    };
    void resize(int newWidth, int newHeight, Targets wanted);
    std::uint64_t bytes() const;
};

class GpuSky;
class SceneGeometry;

class GBufferPass {
  public:
    GBufferPass();
    ~GBufferPass();
    void setPose(const Scene& scene);   // what moves, after poseScene(): since the pose before
    void rest();                        // it has moved no further
    void setScene(const Scene& scene);  // uploads vertices, textures with mips
    // Back faces of single-sided materials are not seen, as glTF asks. Without a scene, or an
    // empty one, every texel is cleared.
    void render(const FrameCamera& camera, int width, int height, Materials materials,
                gl::Profiler& profiler, GBuffer& out);
    // Glowing particles as small discs with depth test, radiance from their flux: that of a
    // Lambertian ball of the disc's radius, flux / (4 pi^2 r^2). No surface: nothing is gathered.
    void drawParticles(const GpuViews& views, const RootCube& root, const FrameCamera& camera,
                       gl::Profiler& profiler, GBuffer& gbuffer);
    // The sky where there is neither surface nor particle, into `emission`.
    void drawSky(const GpuSky& sky, const FrameCamera& camera, gl::Profiler& profiler,
                 GBuffer& gbuffer);
    const SceneGeometry& geometry() const;
    std::uint64_t bytes() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv
