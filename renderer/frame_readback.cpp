// The last frame, read back.

#include <cmath>

#include "renderer/frame_state.h"

namespace mv {

ViewSet FrameRenderer::readViews() const {
    ViewSet out;
    out.views = impl_->views.views.read<View>(0, impl_->views.count);
    return out;
}

ReadMaps FrameRenderer::readMaps(int sideIndex) const {
    ReadMaps out;
    const auto& side = impl_->sides.at(static_cast<std::size_t>(sideIndex));
    if (!side || !side->maps.present) return out;
    const GpuViewHierarchy& tree = impl_->mapHierarchy(*side);
    const auto nodes = tree.nodes.read<ViewNode>(0, tree.nodeCount);
    const auto mapOfNode = tree.mapOfNode.read<std::uint32_t>(0, tree.nodeCount);
    const auto leafOfView = tree.leafOfView.read<std::uint32_t>(0, tree.aliveCount);
    const auto sorted = tree.sortedViews.read<View>(0, tree.aliveCount);

    const std::uint64_t texelsPerMap = 2ull * static_cast<std::uint64_t>(side->maps.viewRes) *
                                       static_cast<std::uint64_t>(side->maps.viewRes);
    out.maps.viewRes = side->maps.viewRes;
    out.maps.texels = side->maps.texels.read<std::uint32_t>(0, side->maps.mapCount * texelsPerMap);
    out.maps.centers.resize(side->maps.mapCount);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const std::uint32_t map = side->maps.fused ? mapOfNode[n] : static_cast<std::uint32_t>(n);
        if (map != kNone) {
            out.maps.centers[map] = {nodes[n].centerX, nodes[n].centerY, nodes[n].centerZ};
        }
    }
    out.mapOfSlot.assign(impl_->views.count, kNone);
    for (std::size_t v = 0; v < sorted.size(); ++v) {
        out.mapOfSlot[sorted[v].slot] = side->maps.fused ? mapOfNode[leafOfView[v]] : leafOfView[v];
    }
    return out;
}

PixelValues FrameRenderer::readPixel(int x, int y) const {
    const Impl& m = *impl_;
    PixelValues out;
    if (!m.shown || x < 0 || y < 0 || x >= m.gbuffer.width || y >= m.gbuffer.height) return out;
    const auto texel = [&](const gl::Texture& texture) {
        const auto t = texture.readTexel(x, y);
        return glm::vec4(t[0], t[1], t[2], t[3]);
    };
    const glm::vec4 position = texel(m.gbuffer.position), normal = texel(m.gbuffer.normal);
    out.surface = position.w != 0;
    if (out.surface) {
        out.position = glm::vec3(position);
        out.normal = glm::vec3(normal);
        out.depth = normal.w;
        out.albedo = glm::vec3(texel(m.gbuffer.albedo));
    }
    glm::vec3 direct(texel(m.gbuffer.emission));
    if (out.surface) direct += glm::vec3(texel(m.direct));
    out.sideCount = m.sideCount;
    for (int i = 0; i < m.sideCount; ++i) {
        const Side& side = *m.sides[static_cast<std::size_t>(i)];
        PixelSide& values = out.sides[static_cast<std::size_t>(i)];
        values.direct = values.radiance = direct;
        if (!out.surface) continue;
        const bool mean = side.hasMean();
        const glm::vec3 irradiance(texel(mean ? side.irradiance : side.gathered.irradiance));
        values.unfiltered = glm::vec3(texel(mean ? side.unfiltered : side.gathered.unfiltered));
        values.indirect = out.albedo * (1 / kPi) * irradiance;
        values.radiance += values.indirect;
    }
    const glm::vec4 display = texel(m.picture());
    for (int c = 0; c < 3; ++c) {
        out.display[static_cast<std::size_t>(c)] =
            static_cast<std::uint8_t>(std::lround(255 * display[c]));
    }
    return out;
}

std::vector<GatheredSample> FrameRenderer::readSamples(int x, int y, int sideIndex) const {
    const Impl& m = *impl_;
    if (!m.shown || sideIndex < 0 || sideIndex >= m.sideCount) return {};
    const Side& side = *m.sides[static_cast<std::size_t>(sideIndex)];
    if (side.sets == 0 || isReference(side.key.method)) return {};
    return impl_->gatherPass.readSamples(m.gbuffer, m.scene->root, m.mapHierarchy(side), side.maps,
                                         side.records, m.gatherOptionsOf(*m.shown, side, side.sets),
                                         {x, y});
}

}  // namespace mv
