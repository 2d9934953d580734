// Trace textures and materials: what rays see of a scene's images (triangle_bvh.h).

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "megaviews/scene/closed_surfaces.h"
#include "megaviews/scene/triangle_bvh.h"
#include "shaders/shared/light.glsl"
#include "shaders/shared/microfacet.glsl"
#include "shaders/shared/tone.glsl"

namespace mv {
namespace {

float linearFromByte(std::uint8_t byte) {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> t{};
        for (std::size_t i = 0; i < t.size(); ++i)
            t[i] = linearFromSrgbChannel(static_cast<float>(i) / 255.0f);
        return t;
    }();
    return table[byte];
}

std::uint32_t byteFromUnit(float x) {
    return static_cast<std::uint32_t>(std::clamp(x, 0.0f, 1.0f) * 255.0f + 0.5f);
}
std::uint32_t srgbByteFromLinear(float x) { return byteFromUnit(srgbChannel(x)); }

// The mean of the image's texels [x0, x1) x [y0, y1) in linear colour; `weighted` weights colour
// by alpha, so that what a mask cuts away does not tint what it leaves.
std::uint32_t boxTexel(const Image& image, int x0, int x1, int y0, int y1, bool weighted) {
    glm::vec3 sum(0), weightedSum(0);
    float alphaSum = 0;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const std::uint8_t* p = &image.rgba[4 * (static_cast<std::size_t>(y) *
                                                         static_cast<std::size_t>(image.width) +
                                                     static_cast<std::size_t>(x))];
            glm::vec3 c(linearFromByte(p[0]), linearFromByte(p[1]), linearFromByte(p[2]));
            float alpha = static_cast<float>(p[3]) / 255.0f;
            sum += c;
            weightedSum += c * alpha;
            alphaSum += alpha;
        }
    float count = static_cast<float>((x1 - x0) * (y1 - y0));
    glm::vec3 mean = weighted && alphaSum > 0 ? weightedSum / alphaSum : sum / count;
    return srgbByteFromLinear(mean.r) | srgbByteFromLinear(mean.g) << 8 |
           srgbByteFromLinear(mean.b) << 16 | byteFromUnit(alphaSum / count) << 24;
}

}  // namespace

TraceTextures makeTraceTextures(const Scene& scene) {
    TraceTextures out;
    if (scene.textures.empty()) return out;

    // Places: images in order, a single white texel first for textures without a usable image.
    struct Place {
        std::size_t offset = 0;
        int width = 1, height = 1;
        bool usable = false;
    };
    std::vector<Place> places(scene.images.size());
    // Rays ask for colours and masks, not for the numbers of metal, roughness, coats and normals.
    std::set<const Image*> spared, masked;
    for (const Material& m : scene.materials) {
        for (const int t :
             {m.metallicRoughnessTexture, m.normalTexture, m.coatTexture, m.coatNormalTexture})
            spared.insert(scene.imageOf(t));
        if (m.rayCutoff() > 0) masked.insert(scene.imageOf(m.baseTexture));
    }
    for (const Material& m : scene.materials) {
        for (const int t : {m.baseTexture, m.emissiveTexture}) spared.erase(scene.imageOf(t));
    }
    out.texels.push_back(0xFFFFFFFFu);
    std::size_t size = 1;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Image& image = scene.images[i];
        if (image.width <= 0 || image.height <= 0 || spared.contains(&image)) continue;
        places[i] = {.offset = size,
                     .width = std::min(image.width, kTraceTextureSize),
                     .height = std::min(image.height, kTraceTextureSize),
                     .usable = true};
        size +=
            static_cast<std::size_t>(places[i].width) * static_cast<std::size_t>(places[i].height);
    }

    out.texels.resize(size);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Place& place = places[i];
        if (!place.usable) continue;
        const Image& image = scene.images[i];
        const bool weighted = masked.contains(&image);
        tbb::parallel_for(0, place.height, [&](int y) {
            for (int x = 0; x < place.width; ++x) {
                auto edge = [](int k, int n, int of) {
                    return static_cast<int>(static_cast<std::int64_t>(k) * of / n);
                };
                out.texels[place.offset +
                           static_cast<std::size_t>(y) * static_cast<std::size_t>(place.width) +
                           static_cast<std::size_t>(x)] =
                    boxTexel(image, edge(x, place.width, image.width),
                             edge(x + 1, place.width, image.width),
                             edge(y, place.height, image.height),
                             edge(y + 1, place.height, image.height), weighted);
            }
        });
    }
    for (const Texture& t : scene.textures) {
        Place place;
        if (t.image >= 0) place = places[static_cast<std::size_t>(t.image)];
        out.textures.push_back({.offset = static_cast<std::uint32_t>(place.offset),
                                .width = static_cast<std::uint32_t>(place.width),
                                .height = static_cast<std::uint32_t>(place.height),
                                .wrap = static_cast<std::uint32_t>(t.wrapS) |
                                        static_cast<std::uint32_t>(t.wrapT) << 2 |
                                        (t.nearest ? kTraceTextureNearest : 0u)});
    }
    return out;
}

namespace {

// Mean of a channel of what a material looks up, 0 .. 1.
float meanOf(const Scene& scene, int texture, std::size_t channel) {
    const Image* image = scene.imageOf(texture);
    if (!image) return 1;
    const std::vector<std::uint8_t>& rgba = image->rgba;
    // At most that many texels, strewn by the golden ratio: a regular step meets few columns.
    constexpr std::size_t kMost = 4096;
    const std::size_t texels = rgba.size() / 4, count = std::min(texels, kMost);
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double share = std::fmod(static_cast<double>(i) * std::numbers::phi, 1.0);
        const std::size_t texel =
            texels <= kMost ? i : static_cast<std::size_t>(share * static_cast<double>(texels));
        sum += rgba[4 * texel + channel];
    }
    return count > 0 ? static_cast<float>(sum / static_cast<double>(count) / 255) : 1;
}

// Share of light from everywhere that gloss of that much at normal incidence reflects to
// everywhere.
float meanReflectance(float atNormal, float atGrazing, float roughness) {
    constexpr int kSteps = 32;
    float sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const float cosine = (static_cast<float>(i) + 0.5f) / kSteps;
        sum += 2 * cosine * glossReflectance(glm::vec3(atNormal), atGrazing, roughness, cosine).x /
               kSteps;
    }
    return std::min(sum, 1.0f);
}

float metalOf(const Scene& scene, const Material& m) {
    return m.metallic * meanOf(scene, m.metallicRoughnessTexture, 2);
}
float roughnessOf(const Scene& scene, const Material& m) {
    return m.roughness * meanOf(scene, m.metallicRoughnessTexture, 1);
}

// Sight that meets the surface in a mirror or through glass goes on as from a perfect mirror.
bool mirrors(const Scene& scene, const Material& m) {
    constexpr float kMirrorRoughness = 0.2f;  // a lobe 2 degrees wide
    return !m.unlit && !m.blends && metalOf(scene, m) > 0.5f &&
           roughnessOf(scene, m) < kMirrorRoughness;
}

// What gloss adds to the light that a surface reflects, as a share of what the base colour leaves:
// the layer reflects it before the matt surface can, a metal at grazing angles.
float layerOf(const Scene& scene, const Material& m) {
    if (!m.isGlossy()) return 0;
    const float metal = metalOf(scene, m);
    const float roughness = roughnessOf(scene, m);
    const float atNormal = luminance(m.layer());
    const float layer =
        (1 - metal) * (atNormal > 0 ? meanReflectance(atNormal, m.specularFactor, roughness) : 0) +
        metal * meanReflectance(0, 1, roughness);
    // Approximate: light passes a coat once, as it passes the layer.
    const float strength = m.coat * meanOf(scene, m.coatTexture, 0);
    if (!(strength > 0)) return layer;
    const float coat = strength * meanReflectance(kSpecularOfGlass, 1, m.coatRoughness);
    return 1 - (1 - layer) * (1 - coat);
}

// What rays that pass a surface leave of light, times its base colour: neither the layer nor metal
// lets it through, and what fills it absorbs.
glm::vec3 passOf(const Scene& scene, const Material& m, float layer) {
    if (!m.isGlass()) return glm::vec3(0);
    const float metal = metalOf(scene, m);
    return m.transmission * (1 - metal) * (1 - layer) * m.attenuation();
}

}  // namespace

std::vector<TraceMaterial> makeTraceMaterials(const Scene& scene) {
    std::vector<TraceMaterial> out;
    const std::vector<bool> closed = closedMaterials(scene);
    auto index = [](int i) { return i < 0 ? kNone : static_cast<std::uint32_t>(i); };
    for (const Material& m : scene.materials) {
        TraceMaterial t{};
        t.baseR = m.baseColor.r;
        t.baseG = m.baseColor.g;
        t.baseB = m.baseColor.b;
        t.baseAlpha = m.baseColor.a;
        t.alphaCutoff = m.rayCutoff();
        t.emissionR = m.emission.r;
        t.emissionG = m.emission.g;
        t.emissionB = m.emission.b;
        t.flags = (m.doubleSided ? kMaterialDoubleSided : 0u) | (m.unlit ? kMaterialUnlit : 0u) |
                  (m.blends && m.tints() ? kMaterialBlends : 0u) |
                  (closed[out.size()] ? kMaterialClosed : 0u) |
                  (mirrors(scene, m) ? kMaterialMirrors : 0u);
        t.layer = layerOf(scene, m);
        const glm::vec3 pass = passOf(scene, m, t.layer);
        t.passR = pass.r;
        t.passG = pass.g;
        t.passB = pass.b;
        t.filledIndex = m.filledIndex();
        t.baseTexture = index(m.baseTexture);
        t.emissiveTexture = index(m.emissiveTexture);
        out.push_back(t);
    }
    return out;
}

}  // namespace mv
