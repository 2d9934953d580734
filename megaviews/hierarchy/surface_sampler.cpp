#include "megaviews/hierarchy/surface_sampler.h"

namespace mv {

SurfaceSampler::SurfaceSampler(const TriangleBvh& bvh)
    : scene_(*bvh.scene), bvh_(bvh), data_(bvh.data()) {
    for (std::size_t i = 0; i < linear_.size(); ++i)
        linear_[i] = bvhLinearFromSrgb(static_cast<float>(i) / 255.0f);
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

SurfaceSample SurfaceSampler::sample(std::uint32_t triangle, const BoxTriangle& t,
                                     const ClippedTriangle& piece) const {
    const TraceMaterial& m = bvh_.materials[scene_.triangleMaterials[triangle]];
    const bool baseTextured = m.baseTexture != kNone && !scene_.uvs.empty();
    const bool emissiveTextured = m.emissiveTexture != kNone && !scene_.emissiveUvs.empty();
    const bool masked = m.alphaCutoff > 0;
    const bool varies = baseTextured || emissiveTextured || !scene_.colors.empty();
    const glm::uvec3 corner = scene_.triangles[triangle];
    const double n2 = glm::dot(t.areaNormal, t.areaNormal);

    // The centroid, and points half way to the corners: all of them under a mask, else three.
    const int around = !varies ? 0 : masked ? piece.count : std::min(piece.count, 3);
    SurfaceSample result;
    int kept = 0;
    for (int i = -1; i < around; ++i) {
        const int at = masked ? i : i * piece.count / 3;
        const glm::dvec3 p =
            i < 0 ? piece.centroid
                  : (piece.centroid + piece.corners[static_cast<std::size_t>(at)]) * 0.5;
        glm::vec3 w(0);
        if (varies) {
            const glm::dvec3 d = p - t.corners[0];
            const glm::dvec3 b = t.corners[1] - t.corners[0], c = t.corners[2] - t.corners[0];
            w.y = static_cast<float>(glm::dot(glm::cross(d, c), t.areaNormal) / n2);
            w.z = static_cast<float>(glm::dot(glm::cross(b, d), t.areaNormal) / n2);
            w.x = 1.0f - w.y - w.z;
        }
        const auto interpolate = [&](const auto& attribute) {
            return attribute[corner.x] * w.x + attribute[corner.y] * w.y +
                   attribute[corner.z] * w.z;
        };
        glm::vec4 base(m.baseR, m.baseG, m.baseB, m.baseAlpha);
        if (!scene_.colors.empty()) base *= interpolate(scene_.colors);
        if (baseTextured) base *= texel(m.baseTexture, interpolate(scene_.uvs));
        if (masked && base.w < m.alphaCutoff) continue;
        glm::vec3 emission(m.emissionR, m.emissionG, m.emissionB);
        if (emissiveTextured)
            emission *= glm::vec3(texel(m.emissiveTexture, interpolate(scene_.emissiveUvs)));
        const bool unlit = (m.flags & kMaterialUnlit) != 0;
        result.albedo += unlit ? glm::dvec3(0) : glm::dvec3(base);
        result.emission += glm::dvec3(emission) + (unlit ? glm::dvec3(base) : glm::dvec3(0));
        ++kept;
    }
    result.coverage = static_cast<double>(kept) / (around + 1);
    if (kept) {
        result.albedo /= kept;
        result.emission /= kept;
    }
    return result;
}

}  // namespace mv
