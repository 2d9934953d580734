#include "megaviews/hierarchy/surface_sampler.h"

#include "shaders/shared/tone.glsl"

namespace mv {

SurfaceSampler::SurfaceSampler(const TriangleBvh& bvh)
    : scene_(*bvh.scene), bvh_(bvh), data_(bvh.data()) {
    for (std::size_t i = 0; i < linear_.size(); ++i)
        linear_[i] = linearFromSrgbChannel(static_cast<float>(i) / 255.0f);
}

bool SurfaceSampler::doubleSided(std::uint32_t triangle) const {
    return scene_.materials[scene_.triangleMaterials[triangle]].doubleSided;
}

glm::vec4 SurfaceSampler::texel(std::uint32_t texture, glm::vec2 uv) const {
    const glm::uvec4 header = bvhTextureTexel(data_, texture);
    const glm::vec2 p = bvhTexelSpace(header, uv);
    const int i =
        bvhWrap(static_cast<int>(std::floor(p.x)), static_cast<int>(header.y), header.w & 3u);
    const int j = bvhWrap(static_cast<int>(std::floor(p.y)), static_cast<int>(header.z),
                          (header.w >> 2u) & 3u);
    const std::uint32_t c = bvhColourTexel(
        data_, header.x + static_cast<std::uint32_t>(j) * header.y + static_cast<std::uint32_t>(i));
    return {linear_[c & 255u], linear_[(c >> 8u) & 255u], linear_[(c >> 16u) & 255u],
            static_cast<float>(c >> 24u) / 255.0f};
}

SurfaceSample SurfaceSampler::sample(const SurfacePiece& piece, glm::dvec3 centroid) const {
    const TraceMaterial& m = bvh_.materials[scene_.triangleMaterials[piece.triangle]];
    const bool baseTextured = m.baseTexture != kNone && !scene_.uvs.empty();
    const bool emissiveTextured = m.emissiveTexture != kNone && !scene_.emissiveUvs.empty();
    const bool masked = m.alphaCutoff > 0;
    const bool varies = baseTextured || emissiveTextured || !scene_.colors.empty();
    const bool unlit = (m.flags & kMaterialUnlit) != 0;

    // Barycentric coordinates are linear: two dot products a point.
    const glm::uvec3 corner = scene_.triangles[piece.triangle];
    glm::dvec3 origin(0), toSecond(0), toThird(0);
    if (varies) {
        origin = glm::dvec3(scene_.positions[corner.x]);
        const glm::dvec3 b = glm::dvec3(scene_.positions[corner.y]) - origin;
        const glm::dvec3 c = glm::dvec3(scene_.positions[corner.z]) - origin;
        const glm::dvec3 n = glm::cross(b, c);
        toSecond = glm::cross(c, n) / glm::dot(n, n);
        toThird = glm::cross(n, b) / glm::dot(n, n);
    }

    // The centroid, and points half way to the corners: all of them under a mask, else three.
    const std::size_t around = !varies ? 0 : masked ? piece.count : std::min(piece.count, 3u);
    SurfaceSample result;
    int kept = 0;
    for (std::size_t i = 0; i <= around; ++i) {
        glm::dvec3 p = centroid;
        if (i > 0) p = 0.5 * (p + piece.corners[(i - 1) * piece.count / around]);
        const auto v = static_cast<float>(glm::dot(p - origin, toSecond));
        const auto w = static_cast<float>(glm::dot(p - origin, toThird));
        const auto interpolate = [&](const auto& attribute) {
            return attribute[corner.x] * (1.0f - v - w) + attribute[corner.y] * v +
                   attribute[corner.z] * w;
        };
        glm::vec4 base(m.baseR, m.baseG, m.baseB, m.baseAlpha);
        if (!scene_.colors.empty()) base *= interpolate(scene_.colors);
        if (baseTextured) base *= texel(m.baseTexture, interpolate(scene_.uvs));
        if (masked && base.w < m.alphaCutoff) continue;
        glm::vec3 emission(m.emissionR, m.emissionG, m.emissionB);
        if (emissiveTextured)
            emission *= glm::vec3(texel(m.emissiveTexture, interpolate(scene_.emissiveUvs)));
        result.albedo += unlit ? glm::dvec3(0) : glm::dvec3(base);
        result.emission += glm::dvec3(emission) + (unlit ? glm::dvec3(base) : glm::dvec3(0));
        ++kept;
    }
    result.coverage = static_cast<double>(kept) / static_cast<double>(around + 1);
    if (kept) {
        result.albedo /= kept;
        result.emission /= kept;
    }
    return result;
}

}  // namespace mv
