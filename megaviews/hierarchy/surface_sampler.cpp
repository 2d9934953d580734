#include "megaviews/hierarchy/surface_sampler.h"

namespace mv {

SurfaceSampler::SurfaceSampler(const TriangleBvh& bvh)
    : scene_(*bvh.scene), bvh_(bvh), data_(bvh.data()) {}

float SurfaceSampler::texelAlpha(std::uint32_t texture, glm::vec2 uv) const {
    const glm::uvec4 header = bvhTextureTexel(data_, texture);
    const glm::vec2 p = bvhTexelSpace(header, uv);
    const int i =
        bvhWrap(static_cast<int>(std::floor(p.x)), static_cast<int>(header.y), header.w & 3u);
    const int j = bvhWrap(static_cast<int>(std::floor(p.y)), static_cast<int>(header.z),
                          (header.w >> 2u) & 3u);
    const std::uint32_t c = bvhColourTexel(
        data_, header.x + static_cast<std::uint32_t>(j) * header.y + static_cast<std::uint32_t>(i));
    return static_cast<float>(c >> 24u) / 255.0f;
}

double SurfaceSampler::coverage(const SurfacePiece& piece, glm::dvec3 centroid) const {
    const TraceMaterial& m = bvh_.materials[scene_.triangleMaterials[piece.triangle]];
    if (!(m.alphaCutoff > 0)) return 1;
    const bool textured = m.baseTexture != kNone && !scene_.uvs.empty();
    if (!textured && scene_.colors.empty()) return m.baseAlpha < m.alphaCutoff ? 0 : 1;

    const glm::uvec3 corner = scene_.triangles[piece.triangle];
    const CornerWeights weights(scene_, piece.triangle);
    // The centroid, and points half way to the corners.
    int kept = 0;
    for (std::size_t i = 0; i <= piece.count; ++i) {
        glm::dvec3 p = centroid;
        if (i > 0) p = 0.5 * (p + piece.corners[i - 1]);
        const glm::dvec2 at = weights.at(p);
        const auto v = static_cast<float>(at.x), w = static_cast<float>(at.y);
        const auto interpolate = [&](const auto& attribute) {
            return attribute[corner.x] * (1.0f - v - w) + attribute[corner.y] * v +
                   attribute[corner.z] * w;
        };
        float alpha = m.baseAlpha;
        if (!scene_.colors.empty()) alpha *= interpolate(scene_.colors).w;
        if (textured) alpha *= texelAlpha(m.baseTexture, interpolate(scene_.uvs));
        if (alpha >= m.alphaCutoff) ++kept;
    }
    return static_cast<double>(kept) / static_cast<double>(piece.count + 1);
}

}  // namespace mv
