#include "renderer/passes/direct_light_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <string>

#include <spdlog/spdlog.h>

#include "renderer/gl/context.h"
#include "renderer/gl/program.h"
#include "renderer/gl/vertex_array.h"
#include "renderer/gl/workarounds.h"
#include "renderer/passes/scene_geometry.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/direct_light.glsl"
#include "shaders/shared/light.glsl"

namespace mv {
namespace {

constexpr std::size_t kMostLights = 8;
constexpr float kShadowNear = 1e-4f;   // root-cube units; nearer geometry casts no shadow
constexpr float kWidestMapCos = 0.5f;  // spots wider than 60 degrees get a cube

// What a shadow map depends on.
struct ShadowKey {
    glm::vec3 position{0}, direction{0};
    float cosOuter = 0;
    std::uint32_t type = 0;
    bool operator==(const ShadowKey&) const = default;
};

glm::vec3 positionOf(const LightRecord& l) { return {l.positionX, l.positionY, l.positionZ}; }
glm::vec3 directionOf(const LightRecord& l) { return {l.directionX, l.directionY, l.directionZ}; }

bool needsCube(const LightRecord& l) {
    return l.type == kLightPoint || (l.type == kLightSpot && l.cosOuter < kWidestMapCos);
}

glm::mat4 fromRows(glm::vec4 x, glm::vec4 y, glm::vec4 z, glm::vec4 w) {
    return glm::transpose(glm::mat4(x, y, z, w));
}

glm::vec4 planeThrough(glm::vec3 axis, glm::vec3 origin, float scale = 1) {
    return scale * glm::vec4(axis, -glm::dot(axis, origin));
}

// The spot's map covers its outer cone and two texels around it.
void fitSpot(const LightRecord& l, int resolution, DirectLight& g, std::vector<glm::mat4>& faces) {
    const glm::mat4 view = glm::transpose(viewMatrix(glm::vec3(0), directionOf(l), {0, 1, 0}));
    const glm::vec3 right(view[0]), up(view[1]), forward(-glm::vec3(view[2]));
    const float cosOuter = std::max(l.cosOuter, kWidestMapCos);
    const float tangent = std::max(std::sqrt(1 - cosOuter * cosOuter) / cosOuter, 1e-3f) *
                          (1 + 4.0f / static_cast<float>(resolution));
    g.right = glm::vec4(right, 0);
    g.up = glm::vec4(up, 0);
    g.forward = glm::vec4(forward, 0);
    g.intensity.w = 2 * tangent / static_cast<float>(resolution);
    g.cone = {l.cosInner, l.cosOuter, 1 / tangent, kShadowNear};
    const glm::vec3 p = positionOf(l);
    faces.push_back(fromRows(planeThrough(right, p, 1 / tangent), planeThrough(up, p, 1 / tangent),
                             {0, 0, 0, kShadowNear}, planeThrough(forward, p)));
}

// Faces +x, -x, +y, ... two texels wider than the cube's, so that the filter meets no edge.
void fitCube(const LightRecord& l, int resolution, DirectLight& g, std::vector<glm::mat4>& faces) {
    const float tangent = 1 + 4.0f / static_cast<float>(resolution);
    const glm::vec3 p = positionOf(l);
    g.forward = glm::vec4(directionOf(l), 0);
    g.intensity.w = 2 * tangent / static_cast<float>(resolution);
    g.cone = {l.cosInner, l.cosOuter, 1 / tangent, kShadowNear};
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        glm::vec3 forward(0), u(0), v(0);
        forward[axis] = face % 2 == 0 ? 1.0f : -1.0f;
        u[(axis + 1) % 3] = 1;
        v[(axis + 2) % 3] = 1;
        faces.push_back(fromRows(planeThrough(u, p, 1 / tangent), planeThrough(v, p, 1 / tangent),
                                 {0, 0, 0, kShadowNear}, planeThrough(forward, p)));
    }
}

// The sun's map covers the whole scene in the tightest of some rotations about its direction.
void fitSun(const LightRecord& l, int resolution, const SceneGeometry& scene, DirectLight& g,
            std::vector<glm::mat4>& faces) {
    const glm::vec3 forward = directionOf(l);
    const glm::mat4 view = glm::transpose(viewMatrix(glm::vec3(0), forward, {0, 1, 0}));
    const glm::vec3 right0(view[0]), up0(view[1]);
    glm::vec2 low(0), high(0);
    glm::vec3 right(right0), up(up0);
    float best = std::numeric_limits<float>::max();
    constexpr int kRotations = 32;
    for (int i = 0; i < kRotations; ++i) {
        const float angle = static_cast<float>(i) * (kPi / 2 / kRotations);
        const glm::vec3 r = right0 * std::cos(angle) + up0 * std::sin(angle);
        const glm::vec3 u = up0 * std::cos(angle) - right0 * std::sin(angle);
        glm::vec2 a(std::numeric_limits<float>::max()), b(-std::numeric_limits<float>::max());
        for (const GeometryChunk& chunk : scene.chunks()) {
            const glm::vec3 center = 0.5f * (chunk.min + chunk.max);
            const glm::vec3 half = 0.5f * (chunk.max - chunk.min);
            const glm::vec2 c(glm::dot(center, r), glm::dot(center, u));
            const glm::vec2 h(glm::dot(half, glm::abs(r)), glm::dot(half, glm::abs(u)));
            a = glm::min(a, c - h);
            b = glm::max(b, c + h);
        }
        const float area = (b.x - a.x) * (b.y - a.y);
        if (area < best) {
            best = area;
            low = a;
            high = b;
            right = r;
            up = u;
        }
    }
    float nearest = 0, farthest = 1;
    if (!scene.chunks().empty()) {
        nearest = std::numeric_limits<float>::max();
        farthest = -nearest;
        for (const GeometryChunk& chunk : scene.chunks()) {
            const float c = glm::dot(0.5f * (chunk.min + chunk.max), forward);
            const float h = glm::dot(0.5f * (chunk.max - chunk.min), glm::abs(forward));
            nearest = std::min(nearest, c - h);
            farthest = std::max(farthest, c + h);
        }
    }
    // A margin for the filter and for receivers lifted towards the sun.
    const glm::vec2 extent =
        glm::max(high - low, 1e-3f) * (1 + 8.0f / static_cast<float>(resolution));
    const float texel = std::max(extent.x, extent.y) / static_cast<float>(resolution);
    const float margin = 8 * texel + 1e-3f;
    nearest -= margin;
    farthest += margin;
    const glm::vec2 center = 0.5f * (low + high);
    g.right = glm::vec4(right * (2 / extent.x), -center.x * 2 / extent.x);
    g.up = glm::vec4(up * (2 / extent.y), -center.y * 2 / extent.y);
    g.forward = glm::vec4(-forward, farthest) / (farthest - nearest);
    g.intensity.w = texel;
    g.toward = glm::vec4(-forward, 0);
    faces.push_back(fromRows(g.right, g.up, g.forward, {0, 0, 0, 1}));
}

}  // namespace

struct DirectLightPass::Impl {
    gl::VertexArray noVertices{"full screen"};
    std::map<std::string, gl::Program> programs;  // by the kinds of the lights
    gl::Texture maps;                             // all faces of all lights
    gl::Framebuffer mapTarget, target;
    gl::Buffer lightBuffer;
    std::vector<ShadowKey> drawn;  // what the maps show
    std::uint64_t drawnScene = 0;
    int ignored = 0, loggedIgnored = 0, rendered = 0;

    // As large as the budget for all maps allows.
    static int resolutionFor(int layers) {
        const bool small = gl::isOn(gl::Workaround::smallShadowMaps);
        const std::int64_t texels = std::int64_t{small ? 8 : 96} << 20;
        int resolution = small ? 1024 : 2048;
        while (resolution > 128 && std::int64_t{layers} * resolution * resolution > texels) {
            resolution /= 2;
        }
        return resolution;
    }

    gl::Program& program(const std::vector<LightRecord>& lights) {
        std::string calls;
        for (std::size_t i = 0; i < lights.size(); ++i) {
            const std::string index = std::to_string(i);
            switch (lights[i].type) {
                case kLightDirectional:
                    calls += "sum += sunLight(" + index + "); ";
                    break;
                case kLightSpot:
                    calls +=
                        (needsCube(lights[i]) ? "sum += wideSpotLight(" : "sum += spotLight(") +
                        index + "); ";
                    break;
                default:
                    calls += "sum += pointLight(" + index + ", 1.0); ";
                    break;
            }
        }
        gl::Program& p = programs[calls];
        if (!p) {
            p = gl::Program("direct light", {"passes/full_screen.vert", "passes/direct.frag"},
                            {{"MV_LIGHTS", std::to_string(lights.size())}, {"MV_SHADE", calls}});
        }
        return p;
    }

    // The strongest by luminance of their flux; equals in the order of the scene.
    std::vector<LightRecord> strongest(const std::vector<LightRecord>& lights) {
        const auto power = [](const LightRecord& l) {
            const float p = luminance({l.intensityR, l.intensityG, l.intensityB}) > 0
                                ? luminance({l.fluxR, l.fluxG, l.fluxB})
                                : 0.0f;
            return std::isfinite(p) ? p : 0.0f;
        };
        std::vector<LightRecord> out;
        std::copy_if(lights.begin(), lights.end(), std::back_inserter(out),
                     [&](const LightRecord& l) { return power(l) > 0; });
        std::stable_sort(out.begin(), out.end(), [&](const LightRecord& a, const LightRecord& b) {
            return power(a) > power(b);
        });
        ignored = static_cast<int>(std::max(out.size(), kMostLights) - kMostLights);
        out.resize(std::min(out.size(), kMostLights));
        if (ignored > 0 && ignored != loggedIgnored) {
            spdlog::warn("{} of {} punctual lights give no direct light: only the {} strongest do",
                         ignored, lights.size(), kMostLights);
        }
        loggedIgnored = ignored;
        return out;
    }
};

DirectLightPass::DirectLightPass() : impl_(std::make_unique<Impl>()) {}
DirectLightPass::~DirectLightPass() = default;

int DirectLightPass::ignoredLights() const { return impl_->ignored; }
int DirectLightPass::renderedShadows() const { return impl_->rendered; }
std::uint64_t DirectLightPass::bytes() const { return impl_->maps.bytes(); }

void DirectLightPass::render(const std::vector<LightRecord>& all, const RootCube& root,
                             GBufferPass& scene, const GBuffer& gbuffer, gl::Profiler& profiler,
                             gl::Texture& out) {
    Impl& m = *impl_;
    out.ensure("direct light", GL_TEXTURE_2D, GL_RGBA32F, gbuffer.width, gbuffer.height);
    const std::vector<LightRecord> lights = m.strongest(all);
    m.rendered = 0;

    // Fit the maps.
    int layers = 0;
    for (const LightRecord& l : lights) layers += needsCube(l) ? 6 : 1;
    std::vector<DirectLight> gpuLights;
    if (layers > 0) {
        const int resolution = Impl::resolutionFor(layers);
        if (!m.maps || m.maps.width() != resolution || m.maps.depth() != layers) {
            m.maps.ensure("shadow maps", GL_TEXTURE_2D_ARRAY, GL_DEPTH_COMPONENT32F, resolution,
                          resolution, layers);
            m.maps.parameter(GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
            m.maps.parameter(GL_TEXTURE_COMPARE_FUNC, GL_GEQUAL);
            m.maps.parameter(GL_TEXTURE_MIN_FILTER, GL_LINEAR);
            m.maps.parameter(GL_TEXTURE_MAG_FILTER, GL_LINEAR);
            m.mapTarget = gl::Framebuffer("shadow map", {}, &m.maps);
            m.drawn.clear();
        }
        if (m.drawnScene != scene.sceneVersion()) m.drawn.clear();
        m.drawnScene = scene.sceneVersion();
        m.drawn.resize(lights.size(), ShadowKey{.type = kNone});

        const gl::PassScope scope(profiler, Stage::shadowMaps);
        int layer = 0;
        for (std::size_t i = 0; i < lights.size(); ++i) {
            const LightRecord& l = lights[i];
            DirectLight g{};
            std::vector<glm::mat4> faces;
            if (needsCube(l)) {
                fitCube(l, resolution, g, faces);
            } else if (l.type == kLightSpot) {
                fitSpot(l, resolution, g, faces);
            } else {
                fitSun(l, resolution, scene.geometry(), g, faces);
            }
            g.position = glm::vec4(positionOf(l), static_cast<float>(layer));
            g.intensity = glm::vec4(l.intensityR, l.intensityG, l.intensityB, g.intensity.w);
            gpuLights.push_back(g);

            // Draw those whose light moved.
            const ShadowKey key{positionOf(l), directionOf(l), l.cosOuter, l.type};
            for (const glm::mat4& clipFromWorld : faces) {
                if (m.drawn[i] != key) {
                    constexpr float kFarthest = 0;
                    m.mapTarget.attachDepthLayer(m.maps, layer);
                    m.mapTarget.bind();
                    glDepthMask(GL_TRUE);
                    glClearNamedFramebufferfv(m.mapTarget.id(), GL_DEPTH, 0, &kFarthest);
                    scene.drawDepth(clipFromWorld);
                    ++m.rendered;
                }
                ++layer;
            }
            m.drawn[i] = key;
        }
    }

    // Shade.
    const gl::PassScope scope(profiler, Stage::directLight);
    m.target = gl::Framebuffer("direct light", {&out});
    m.target.bind();
    if (gpuLights.empty()) {
        constexpr float kZero[4] = {0, 0, 0, 0};
        glClearNamedFramebufferfv(m.target.id(), GL_COLOR, 0, kZero);
        return;
    }
    m.lightBuffer.ensure("lights", kMostLights * sizeof(DirectLight));
    m.lightBuffer.write<DirectLight>(0, gpuLights);
    m.lightBuffer.bindUniform(kUniformLights);
    gbuffer.position.bind(kUnitPosition);
    gbuffer.normal.bind(kUnitNormal);
    gbuffer.albedo.bind(kUnitAlbedo);
    m.maps.bind(kUnitShadowMaps);
    gl::Program& program = m.program(lights);
    program.set("edgeM", static_cast<float>(root.edge));
    program.set("texelUv", 1.0f / static_cast<float>(m.maps.width()));
    program.use();
    gl::drawFullScreen(m.noVertices);
}

}  // namespace mv
