#include "renderer/passes/gbuffer_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "renderer/gl/context.h"
#include "renderer/gl/program.h"
#include "renderer/gl/workarounds.h"
#include "renderer/passes/scene_geometry.h"
#include "renderer/passes/sky_pass.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/microfacet.glsl"

namespace mv {
namespace {

// What a material needs of the shaders; each combination in use is compiled once.
enum Feature : std::uint32_t {
    kBaseTexture = 1,
    kEmissiveTexture = 2,
    kMask = 4,
    kUnlit = 8,
    kColors = 16,
    kNormalTexture = 32,
    kMetalTexture = 64,
    kGloss = 128,
    kClear = 256,
    kCoat = 512,
    kCoatTexture = 1024,
    kMoves = 2048,
    kCoatNormalTexture = 4096,
};
// Of Materials::full alone.
constexpr std::uint32_t kLooks =
    kNormalTexture | kMetalTexture | kGloss | kClear | kCoat | kCoatTexture | kCoatNormalTexture;

// The textures of a material.
struct TextureUse {
    Feature feature;
    GLuint unit;
    int Material::*texture;
    bool isColour;  // in sRGB; else numbers
};
constexpr TextureUse kTextures[] = {
    {kBaseTexture, kUnitBaseTexture, &Material::baseTexture, true},
    {kEmissiveTexture, kUnitEmissiveTexture, &Material::emissiveTexture, true},
    {kMetalTexture, kUnitMetalTexture, &Material::metallicRoughnessTexture, false},
    {kNormalTexture, kUnitNormalTexture, &Material::normalTexture, false},
    {kCoatTexture, kUnitCoatTexture, &Material::coatTexture, false},
    {kCoatNormalTexture, kUnitCoatNormalTexture, &Material::coatNormalTexture, false}};

constexpr std::pair<std::uint32_t, const char*> kDefines[] = {
    {kBaseTexture, "MV_BASE_TEXTURE"},
    {kEmissiveTexture, "MV_EMISSIVE_TEXTURE"},
    {kMask, "MV_MASK"},
    {kUnlit, "MV_UNLIT"},
    {kColors, "MV_COLORS"},
    {kBaseTexture | kMetalTexture | kNormalTexture | kCoatTexture | kCoatNormalTexture, "MV_UVS"},
    {kNormalTexture, "MV_NORMAL_TEXTURE"},
    {kMetalTexture, "MV_METAL_TEXTURE"},
    {kGloss, "MV_GLOSS"},
    {kClear, "MV_CLEAR"},
    {kCoat, "MV_COAT"},
    {kCoatTexture, "MV_COAT_TEXTURE"},
    {kCoatNormalTexture, "MV_COAT_NORMAL_TEXTURE"},
    {kMoves, "MV_MOVES"}};

gl::Defines definesOf(std::uint32_t features) {
    gl::Defines defines;
    for (const auto& [any, name] : kDefines) {
        if (features & any) defines.emplace_back(name, "1");
    }
    return defines;
}

int mipLevels(int width, int height) {
    int levels = 1;
    for (int size = std::max(width, height); size > 1; size /= 2) ++levels;
    return levels;
}

// format: GL_SRGB8_ALPHA8 of colours, GL_RGBA8 of numbers.
gl::Texture uploadImage(const Image& image, GLenum format) {
    gl::Texture texture("image " + image.name, GL_TEXTURE_2D, format, image.width, image.height, 1,
                        mipLevels(image.width, image.height));
    texture.writeBytes(4, image.rgba);
    glGenerateTextureMipmap(texture.id());
    return texture;
}

// Wrap modes and filter: one sampler for each combination.
class Samplers {
  public:
    Samplers() {
        float anisotropy = 1;
        if (!gl::isOn(gl::Workaround::plainTextures) &&
            epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic")) {
            glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &anisotropy);
        }
        constexpr std::array<GLint, 3> kWrap = {GL_REPEAT, GL_CLAMP_TO_EDGE, GL_MIRRORED_REPEAT};
        glCreateSamplers(static_cast<GLsizei>(ids_.size()), ids_.data());
        for (std::size_t i = 0; i < ids_.size(); ++i) {
            const bool nearest = i >= 9;
            glSamplerParameteri(ids_[i], GL_TEXTURE_WRAP_S, kWrap[i % 3]);
            glSamplerParameteri(ids_[i], GL_TEXTURE_WRAP_T, kWrap[i / 3 % 3]);
            glSamplerParameteri(ids_[i], GL_TEXTURE_MAG_FILTER, nearest ? GL_NEAREST : GL_LINEAR);
            glSamplerParameteri(ids_[i], GL_TEXTURE_MIN_FILTER,
                                nearest ? GL_NEAREST_MIPMAP_NEAREST : GL_LINEAR_MIPMAP_LINEAR);
            if (anisotropy > 1 && !nearest) {
                glSamplerParameterf(ids_[i], GL_TEXTURE_MAX_ANISOTROPY_EXT,
                                    std::min(anisotropy, 8.0f));
            }
        }
    }
    ~Samplers() { glDeleteSamplers(static_cast<GLsizei>(ids_.size()), ids_.data()); }
    Samplers(const Samplers&) = delete;
    Samplers& operator=(const Samplers&) = delete;
    GLuint of(const Texture& texture) const {
        return ids_[static_cast<std::size_t>(texture.wrapS) +
                    3 * static_cast<std::size_t>(texture.wrapT) + (texture.nearest ? 9 : 0)];
    }

  private:
    std::array<GLuint, 18> ids_{};
};

struct GpuMaterial {
    Material material;  // without gloss and coat where it has none to show
    std::uint32_t features = 0;
};

// Whether rays may have to follow its gloss.
bool mayReflect(const Scene& scene, const Material& material) {
    if (!material.isGlossy()) return false;
    if (material.coat > 0) return true;
    int least = 255;
    if (const Image* image = scene.imageOf(material.metallicRoughnessTexture)) {
        for (std::size_t i = 1; i < image->rgba.size(); i += 4) {
            least = std::min<int>(least, image->rgba[i]);
        }
    }
    return glossShare(material.roughness * static_cast<float>(least) / 255) > 0;
}

// Whether anything can be seen through it. Much that is said to blend is whole.
bool mayPass(const Scene& scene, const Material& material) {
    if (!material.isClear()) return false;
    if (material.transmission > 0 || material.baseColor.a < 1) return true;
    if (std::any_of(scene.colors.begin(), scene.colors.end(),
                    [](glm::vec4 color) { return color.a < 1; })) {
        return true;
    }
    const Image* image = scene.imageOf(material.baseTexture);
    for (std::size_t i = 3; image && i < image->rgba.size(); i += 4) {
        if (image->rgba[i] < 255) return true;
    }
    return false;
}

}  // namespace

std::uint64_t GBuffer::bytes() const {
    return position.bytes() + normal.bytes() + albedo.bytes() + plane.bytes() + gloss.bytes() +
           clear.bytes() + coat.bytes() + emission.bytes() + depth.bytes();
}

void GBuffer::addGlossDefines(gl::Defines& defines) const {
    if (glossKind() > 0) defines.emplace_back("MV_GLOSS", "1");
    if (glossKind() > 1) defines.emplace_back("MV_COAT", "1");
}

void GBuffer::bindGloss(gl::Program& program) const {
    gloss.bind(kUnitGloss);
    albedo.bind(kUnitAlbedo);
    plane.bind(kUnitPlane);
    if (coat) coat.bind(kUnitCoat);
    program.set("seenFrom", seenFrom->position);
    program.set("forward", seenFrom->forward);
    program.set("eyeShare", seenFrom->orthoHalfHeight > 0 ? 0.0f : 1.0f);
}

void GBuffer::resize(int newWidth, int newHeight, Targets wanted) {
    if (framebuffer && width == newWidth && height == newHeight &&
        static_cast<bool>(gloss) == wanted.gloss && static_cast<bool>(clear) == wanted.clear &&
        static_cast<bool>(coat) == wanted.coat) {
        return;
    }
    *this = {};
    width = newWidth;
    height = newHeight;
    std::vector<const gl::Texture*> targets;
    const auto make = [&](gl::Texture& texture, const char* label, GLenum format) {
        texture = gl::Texture(label, GL_TEXTURE_2D, format, width, height);
        if (&texture != &depth) targets.push_back(&texture);
    };
    make(position, "G-buffer position", GL_RGBA32F);
    make(normal, "G-buffer normal", GL_RGBA16F);
    make(albedo, "G-buffer albedo", GL_RGBA16F);
    make(emission, "G-buffer emission", GL_RGBA32F);
    make(plane, "G-buffer plane", GL_RGBA16F);
    if (wanted.gloss) make(gloss, "G-buffer gloss", GL_RGBA16F);
    if (wanted.clear) make(clear, "G-buffer clear", GL_RGBA16F);
    if (wanted.coat) make(coat, "G-buffer coat", GL_RGBA16F);
    if (wanted.depth) make(depth, "G-buffer depth", GL_DEPTH_COMPONENT32F);
    framebuffer = gl::Framebuffer("G-buffer", targets, wanted.depth ? &depth : nullptr);
}

struct GBufferPass::Impl {
    std::uint64_t drawings = 0;
    SceneGeometry geometry;
    std::vector<GpuMaterial> materials;
    std::vector<Texture> textures;  // wrap modes
    // By image; empty where no material uses it as a colour, or as numbers.
    std::vector<gl::Texture> colours, numbers;
    // Of materials in use.
    bool glossy = false, reflects = false, clear = false, coated = false, filled = false;
    Samplers samplers;
    std::map<std::uint32_t, gl::Program> programs;  // by features
    gl::Program particleProgram;
    gl::VertexArray particleVertices;
    gl::Program skyProgram;

    gl::Program& program(std::uint32_t features) {
        gl::Program& p = programs[features];
        if (!p) {
            p = gl::Program("G-buffer", {"passes/gbuffer.vert", "passes/gbuffer.frag"},
                            definesOf(features));
        }
        return p;
    }
    gl::Texture& imageOf(const TextureUse& use, const Texture& texture) {
        return (use.isColour ? colours : numbers)[static_cast<std::size_t>(texture.image)];
    }
    GpuMaterial gpuMaterialOf(const Scene& scene, const Material& material) const;
    void setMaterial(gl::Program& program, const Material& material, std::uint32_t features);
};

GBufferPass::GBufferPass() : impl_(std::make_unique<Impl>()) {}
GBufferPass::~GBufferPass() = default;

const SceneGeometry& GBufferPass::geometry() const { return impl_->geometry; }

std::uint64_t GBufferPass::bytes() const {
    std::uint64_t sum = impl_->geometry.bytes();
    for (const gl::Texture& image : impl_->colours) sum += image.bytes();
    for (const gl::Texture& image : impl_->numbers) sum += image.bytes();
    return sum;
}

void GBufferPass::setPose(const Scene& scene) { impl_->geometry.setPose(scene); }
void GBufferPass::rest() { impl_->geometry.rest(); }

// What the shaders are told of a material of the scene, after Impl knows which looks are in use.
GpuMaterial GBufferPass::Impl::gpuMaterialOf(const Scene& scene, const Material& material) const {
    GpuMaterial g{material};
    if (material.unlit) g.material.transmission = 0;
    std::uint32_t mayUse = kBaseTexture | kNormalTexture;
    if (material.emission != glm::vec3(0)) mayUse |= kEmissiveTexture;
    if (material.isGlossy() || material.isClear()) {
        mayUse |= kMetalTexture;
    } else {
        g.material.specular = g.material.metallic = 0;
        g.material.roughness = 1;
    }
    if (material.isGlossy() && material.coat > 0) {
        mayUse |= kCoatTexture | kCoatNormalTexture;
        // A coat is always followed by rays.
        g.material.coatRoughness = std::min(material.coatRoughness, kRoughGloss);
    } else {
        g.material.coat = g.material.coatRoughness = 0;
    }
    for (const TextureUse& use : kTextures) {
        const auto& uvs = use.feature == kEmissiveTexture ? scene.emissiveUvs : scene.uvs;
        const bool usable = scene.imageOf(material.*use.texture) && !uvs.empty();
        if ((mayUse & use.feature) && usable) g.features |= use.feature;
    }
    if (!scene.colors.empty()) g.features |= kColors;
    if (scene.moving) g.features |= kMoves;
    if (material.rayCutoff() > 0) g.features |= kMask;
    if (material.unlit) g.features |= kUnlit;
    if (glossy) g.features |= kGloss;
    if (clear) g.features |= kClear;
    if (coated) g.features |= kCoat;
    return g;
}

void GBufferPass::Impl::setMaterial(gl::Program& program, const Material& material,
                                    std::uint32_t features) {
    program.set("baseColor", material.baseColor);
    program.set("emission", material.emission);
    if (features & kClear) {  // the eye sees through what blends
        program.set("alphaCutoff", material.blends ? 0 : material.alphaCutoff);
        program.set("blends", material.blends ? 1 : 0);
        program.set("transmission", material.transmission);
        program.set("attenuation", material.attenuation());
        program.set("passingSpread", material.passingSpread());
        program.set("filledIndex", material.filledIndex());
    } else {
        program.set("alphaCutoff", material.rayCutoff());
    }
    if (features & kGloss) {
        program.set("specular", material.layer());
        program.set("specularFactor", material.specularFactor);
        program.set("metallic", material.metallic);
        program.set("roughness", material.roughness);
    }
    if (features & kNormalTexture) program.set("normalScale", material.normalScale);
    if (features & kCoat) {
        program.set("coat", material.coat);
        program.set("coatRoughness", material.coatRoughness);
    }
    if (features & kCoatNormalTexture) program.set("coatNormalScale", material.coatNormalScale);
    for (const TextureUse& use : kTextures) {
        if (!(features & use.feature)) continue;
        const Texture& texture = textures[static_cast<std::size_t>(material.*use.texture)];
        imageOf(use, texture).bind(use.unit);
        glBindSampler(use.unit, samplers.of(texture));
    }
}

void GBufferPass::setScene(const Scene& scene) {
    Impl& m = *impl_;
    m.geometry = {};
    m.colours.clear();
    m.numbers.clear();
    m.geometry = SceneGeometry(scene);
    m.textures = scene.textures;
    m.colours.resize(scene.images.size());
    m.numbers.resize(scene.images.size());
    m.materials.clear();
    const std::set<std::uint32_t> used(scene.triangleMaterials.begin(),
                                       scene.triangleMaterials.end());
    m.reflects = std::any_of(used.begin(), used.end(), [&](std::uint32_t material) {
        return mayReflect(scene, scene.materials[material]);
    });
    m.clear = std::any_of(used.begin(), used.end(), [&](std::uint32_t material) {
        return mayPass(scene, scene.materials[material]);
    });
    m.filled = std::any_of(used.begin(), used.end(), [&](std::uint32_t material) {
        return scene.materials[material].filledIndex() > 0;
    });
    // The target of glass stands after that of gloss, and what a target is made for all materials
    // write.
    m.reflects = m.reflects || m.clear;
    m.coated = std::any_of(used.begin(), used.end(), [&](std::uint32_t material) {
        return scene.materials[material].isGlossy() && scene.materials[material].coat > 0;
    });
    m.glossy = scene.needsFull() || m.clear;
    for (const Material& material : scene.materials) {
        m.materials.push_back(m.gpuMaterialOf(scene, material));
        for (const TextureUse& use : kTextures) {
            if (!(m.materials.back().features & use.feature)) continue;
            const int texture = material.*use.texture;
            gl::Texture& to = m.imageOf(use, scene.textures[static_cast<std::size_t>(texture)]);
            if (to) continue;
            to = uploadImage(*scene.imageOf(texture), use.isColour ? GL_SRGB8_ALPHA8 : GL_RGBA8);
        }
    }
}

void GBufferPass::render(const FrameCamera& camera, int width, int height, Materials materials,
                         gl::Profiler& profiler, GBuffer& out) {
    Impl& m = *impl_;
    const gl::PassScope scope(profiler, Stage::gBuffer);
    const bool full = materials == Materials::full;
    out.resize(width, height, {true, full && m.glossy, full && m.clear, full && m.coated});
    out.drawing = ++m.drawings;  // resize() may have begun anew
    out.seenFrom = camera;
    out.reflects = full && m.reflects;
    out.filled = full && m.filled;
    const bool flat = camera.orthoHalfHeight > 0;
    const float pixel = 2 * camera.halfHeight() / static_cast<float>(height);
    out.largestStep = m.geometry.largestStep();
    out.pixelSize = flat ? glm::vec2(pixel, 0) : glm::vec2(0, pixel);
    out.framebuffer.bind();
    constexpr float kZero[4] = {0, 0, 0, 0};
    const int looks = (out.gloss ? 1 : 0) + (out.clear ? 1 : 0) + (out.coat ? 1 : 0);
    for (GLint i = 0; i < 5 + looks; ++i) {
        glClearNamedFramebufferfv(out.framebuffer.id(), GL_COLOR, i, kZero);
    }
    glDepthMask(GL_TRUE);
    glClearNamedFramebufferfv(out.framebuffer.id(), GL_DEPTH, 0, kZero);

    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    const glm::mat4 clipFromWorld = camera.clipFromWorld(aspect);
    const auto draws = m.geometry.visible(Frustum(clipFromWorld), camera.position);
    if (draws.empty()) return;
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    m.geometry.vertices().bind();
    std::set<std::uint32_t> prepared;
    std::optional<std::uint32_t> current;
    for (const MaterialDraw& draw : draws) {
        const auto& [material, allFeatures] = m.materials[draw.material];
        const std::uint32_t features = allFeatures & ~(full ? 0u : kLooks);
        gl::Program& program = m.program(features);
        if (prepared.insert(features).second) {
            program.set("clipFromWorld", clipFromWorld);
            program.set("eye", camera.position);
            program.set("forward", camera.forward);
            program.set("eyeShare", camera.orthoHalfHeight > 0 ? 0.0f : 1.0f);
            if (features & kMoves) program.set("largestStep", out.largestStep);
        }
        if (current != features) program.use();
        current = features;
        m.setMaterial(program, material, features);
        (material.doubleSided ? glDisable : glEnable)(GL_CULL_FACE);
        m.geometry.draw(draw);
    }
    for (const TextureUse& use : kTextures) glBindSampler(use.unit, 0);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
}

void GBufferPass::drawParticles(const GpuViews& views, const RootCube& root,
                                const FrameCamera& camera, gl::Profiler& profiler,
                                GBuffer& gbuffer) {
    Impl& m = *impl_;
    if (views.count == 0) return;
    const gl::PassScope scope(profiler, Stage::drawParticles);
    if (!m.particleProgram) {
        m.particleProgram =
            gl::Program("particles", {"passes/particle.vert", "passes/particle.frag"});
        m.particleVertices = gl::VertexArray("particles");
    }
    m.particleVertices.floats(0, views.views, 3, sizeof(View), offsetof(View, positionX));
    m.particleVertices.uints(1, views.views, 1, sizeof(View), offsetof(View, flags));
    m.particleVertices.floats(2, views.views, 3, sizeof(View), offsetof(View, fluxR));
    const bool ortho = camera.orthoHalfHeight > 0;
    const float halfHeight = camera.halfHeight();
    gl::Program& p = m.particleProgram;
    const float aspect = static_cast<float>(gbuffer.width) / static_cast<float>(gbuffer.height);
    p.set("clipFromWorld", camera.clipFromWorld(aspect));
    p.set("eye", camera.position);
    p.set("forward", camera.forward);
    p.set("eyeShare", ortho ? 0.0f : 1.0f);
    p.set("pixelsPerUnit", static_cast<float>(gbuffer.height) / (2 * halfHeight));
    // Fewer particles are larger: together they fill about the same share of the room.
    p.set("radius", 0.003f * std::cbrt(4096.0f / static_cast<float>(std::max(views.count, 4096u))));
    p.set("edgeM", static_cast<float>(root.edge));
    p.set("radiusPixels", glm::vec2(0.75f, 12.0f));

    gbuffer.framebuffer.bind();
    m.particleVertices.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_GREATER);
    glEnable(GL_PROGRAM_POINT_SIZE);
    p.use();
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(views.count));
    glDisable(GL_PROGRAM_POINT_SIZE);
    glDisable(GL_DEPTH_TEST);
}

void GBufferPass::drawSky(const GpuSky& sky, const FrameCamera& camera, gl::Profiler& profiler,
                          GBuffer& gbuffer) {
    Impl& m = *impl_;
    const gl::PassScope scope(profiler, Stage::drawSky);
    gl::Program& p = m.skyProgram;
    if (!p) p = gl::Program("sky", {"passes/full_screen.vert", "passes/sky.frag"});
    sky.bind(p);
    const float aspect = static_cast<float>(gbuffer.width) / static_cast<float>(gbuffer.height);
    const bool ortho = camera.orthoHalfHeight > 0;
    const float halfHeight = ortho ? 0 : camera.halfHeight();
    const glm::mat3 worldFromView = glm::transpose(glm::mat3(camera.viewFromWorld()));
    p.set("size", glm::vec2(gbuffer.width, gbuffer.height));
    const glm::vec3 right = worldFromView[0] * (halfHeight * aspect);
    const glm::vec3 up = worldFromView[1] * halfHeight;
    p.set("right", right);
    p.set("up", up);
    p.set("forward", right * camera.offset.x + up * camera.offset.y - worldFromView[2]);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_GEQUAL);  // the triangle lies at infinity, depth 0
    p.drawFullScreen(gbuffer.framebuffer);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
}

}  // namespace mv
