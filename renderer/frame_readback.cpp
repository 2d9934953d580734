// Reads the last frame back.

#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <unordered_map>

#include "renderer/frame_state.h"
#include "shaders/shared/light.glsl"
#include "shaders/shared/pair.glsl"

namespace mv {

ViewSet FrameRenderer::readViews() const {
    ViewSet out;
    out.views = impl_->views.frame.views.views.read(0, impl_->views.frame.views.count);
    return out;
}

ViewSet FrameRenderer::readMapViews(int sideIndex) const {
    const auto& side = impl_->sides.at(static_cast<std::size_t>(sideIndex));
    const GpuMapViews* mapViews = side ? impl_->mapViewsOf(*side) : nullptr;
    if (!mapViews) return readViews();
    ViewSet out;
    out.views.resize(impl_->views.frame.views.count);
    for (std::uint32_t i = 0; i < out.views.size(); ++i) out.views[i].slot = i;
    for (const View& view : mapViews->tree.sortedViews.read(0, mapViews->tree.aliveCount)) {
        out.views[view.slot] = view;
    }
    return out;
}

namespace {

// Adds the gloss that is a factor in the sums of light, as shaders/passes/surface_gloss.glsl does.
void addBroadGloss(const GBuffer& gbuffer, const std::vector<float>& planes,
                   std::vector<Receiver>& receivers) {
    if (gbuffer.glossKind() == 0) return;
    const std::vector<float> glosses = gbuffer.gloss.readFloats(4);
    const std::vector<float> albedos = gbuffer.albedo.readFloats(4);
    std::vector<float> coats;
    if (gbuffer.coat) coats = gbuffer.coat.readFloats(4);
    const FrameCamera& camera = *gbuffer.seenFrom;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const auto texel = [i](const std::vector<float>& of) {
            return of.empty() ? glm::vec4(0) : glm::make_vec4(&of[4 * i]);
        };
        Receiver& r = receivers[i];
        const glm::vec3 ray =
            camera.orthoHalfHeight > 0 ? camera.forward : r.position - camera.position;
        r.gloss = broadGlossOf(texel(albedos), texel(glosses), texel(planes).w, texel(coats),
                               kRoughGloss, r.normal, -normalizeOr(ray, camera.forward));
    }
}

}  // namespace

std::vector<Receiver> FrameRenderer::readReceivers() const {
    const std::vector<float> positions = impl_->surfaces.gbuffer.position.readFloats(4);
    const std::vector<float> normals = impl_->surfaces.gbuffer.normal.readFloats(4);
    const std::vector<float> planes = impl_->surfaces.gbuffer.plane.readFloats(4);
    std::vector<Receiver> out(positions.size() / 4);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const float *p = &positions[4 * i], *n = &normals[4 * i], *q = &planes[4 * i];
        if (p[3] == 0) continue;
        out[i].position = {p[0], p[1], p[2]};
        out[i].normal = normalizeOr({n[0], n[1], n[2]}, glm::vec3(0));
        out[i].plane = normalizeOr({q[0], q[1], q[2]}, out[i].normal);
    }
    addBroadGloss(impl_->surfaces.gbuffer, planes, out);
    return out;
}

namespace {

// Everything about a side's maps but their texels.
ReadMaps layoutOfMaps(const GpuViewHierarchy& tree, const GpuViewMaps& maps,
                      std::uint64_t slotCount) {
    const auto nodes = tree.nodes.read(0, tree.nodeCount);
    const auto mapOfNode = tree.mapOfNode.read(0, tree.nodeCount);
    const auto leafOfView = tree.leafOfView.read(0, tree.aliveCount);
    const auto sorted = tree.sortedViews.read(0, tree.aliveCount);
    ReadMaps out;
    out.maps.mapRes = maps.mapRes;
    out.maps.centers.resize(maps.mapCount);
    if (!maps.fused) out.parents.resize(maps.mapCount);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const std::uint32_t map = maps.fused ? mapOfNode[n] : static_cast<std::uint32_t>(n);
        if (map == kNone) continue;
        out.maps.centers[map] = boxCenter(nodes[n]);
        if (!maps.fused) out.parents[map] = parentOf(nodes[n]);
    }
    out.mapOfSlot.assign(slotCount, kNone);
    for (std::size_t v = 0; v < sorted.size(); ++v) {
        out.mapOfSlot[sorted[v].slot] = maps.fused ? mapOfNode[leafOfView[v]] : leafOfView[v];
    }
    return out;
}

}  // namespace

ReadMaps FrameRenderer::readMaps(int sideIndex) const {
    const auto& side = impl_->sides.at(static_cast<std::size_t>(sideIndex));
    if (!side || !side->hasMaps()) return {};
    const GpuViewMaps& maps = side->visibility->maps();
    ReadMaps out = layoutOfMaps(impl_->mapHierarchy(*side), maps, impl_->views.frame.views.count);
    out.maps.texels = maps.readTexels(0, maps.mapCount);
    if (const GpuMapViews* mapViews = impl_->mapViewsOf(*side)) {
        const auto views = mapViews->all->sortedViews.read(0, mapViews->all->aliveCount);
        const auto places = mapViews->places.read(0, views.size());
        const auto owners = mapViews->tree.sortedViews.read(0, mapViews->tree.aliveCount);
        for (std::size_t v = 0; v < views.size(); ++v) {
            out.mapOfSlot[views[v].slot] = out.mapOfSlot[owners[places[v]].slot];
        }
    }
    return out;
}

ReadMaps FrameRenderer::readMapsOf(std::span<const std::uint32_t> slots, int sideIndex) const {
    const auto& side = impl_->sides.at(static_cast<std::size_t>(sideIndex));
    if (!side || !side->hasMaps()) return {};
    const GpuViewMaps& maps = side->visibility->maps();
    const ReadMaps all =
        layoutOfMaps(impl_->mapHierarchy(*side), maps, impl_->views.frame.views.count);
    ReadMaps out;
    out.maps.mapRes = all.maps.mapRes;
    out.mapOfSlot.assign(all.mapOfSlot.size(), kNone);
    std::unordered_map<std::uint32_t, std::uint32_t> taken;  // its number in `out`
    const auto take = [&](std::uint32_t map) {
        const auto [entry, isNew] =
            taken.try_emplace(map, static_cast<std::uint32_t>(out.maps.centers.size()));
        if (isNew) {
            out.maps.centers.push_back(all.maps.centers[map]);
            const auto texels = maps.readTexels(map, 1);
            out.maps.texels.insert(out.maps.texels.end(), texels.begin(), texels.end());
            if (!all.parents.empty()) out.parents.push_back(kNone);
        }
        return entry->second;
    };
    for (const std::uint32_t slot : slots) {
        std::uint32_t map = all.mapOfSlot.at(slot);
        if (map == kNone) continue;
        std::uint32_t mine = out.mapOfSlot[slot] = take(map);
        while (!all.parents.empty() && (map = all.parents[map]) != kNone) {
            const std::uint32_t above = take(map);
            mine = out.parents[mine] = above;
        }
    }
    return out;
}

PixelValues FrameRenderer::readPixel(int x, int y) const {
    const Impl& m = *impl_;
    PixelValues out;
    if (!m.picture.shown || !m.picture.readable || x < 0 || y < 0 ||
        x >= m.surfaces.gbuffer.width || y >= m.surfaces.gbuffer.height)
        return out;
    const auto texel = [&](const gl::Texture& texture) {
        const auto t = texture.readTexel(x, y);
        return glm::vec4(t[0], t[1], t[2], t[3]);
    };
    const glm::vec4 position = texel(m.surfaces.gbuffer.position),
                    normal = texel(m.surfaces.gbuffer.normal);
    out.surface = position.w != 0;
    if (out.surface) {
        out.position = glm::vec3(position);
        out.normal = glm::vec3(normal);
        out.depth = normal.w;
        out.albedo = glm::vec3(texel(m.surfaces.gbuffer.albedo));
    }
    // As in compose.frag.
    glm::vec3 direct(texel(m.surfaces.gbuffer.emission));
    if (out.surface) {
        direct = direct * static_cast<float>(m.lights.emitters.lightScale) +
                 glm::vec3(texel(m.surfaces.direct));
    }
    out.sideCount = m.sideCount;
    for (int i = 0; i < m.sideCount; ++i) {
        const Side& side = *m.sides[static_cast<std::size_t>(i)];
        PixelSide& values = out.sides[static_cast<std::size_t>(i)];
        values.direct = values.radiance = direct;
        if (!out.surface) continue;
        values.unfiltered = glm::vec3(texel(side.shownUnfiltered()));
        values.indirect =
            indirectRadiance(out.albedo, glm::vec3(texel(side.shownIrradiance())),
                             side.reflected ? glm::vec3(texel(side.reflected)) : glm::vec3(0));
        values.radiance += values.indirect;
    }
    const glm::vec4 display = texel(m.newestPicture());
    for (int c = 0; c < 3; ++c) {
        out.display[static_cast<std::size_t>(c)] =
            static_cast<std::uint8_t>(std::lround(255 * display[c]));
    }
    return out;
}

Side* FrameRenderer::Impl::gatheredSide(int index) {
    if (!picture.shown || !picture.readable || index < 0 || index >= sideCount) return nullptr;
    Side& side = *sides[static_cast<std::size_t>(index)];
    return side.sets == 0 || side.isReference() ? nullptr : &side;
}

std::vector<GatheredSample> FrameRenderer::readSamples(int x, int y, int sideIndex) const {
    Impl& m = *impl_;
    Side* side = m.gatheredSide(sideIndex);
    if (!side) return {};
    // The first set samples the pixel's centre, with the frame's own views.
    const int set = side->averagesPixels() || m.views.ofSet ? 1 : side->sets;
    const SetLight light = m.lightOfSet(*m.picture.shown, 1, m.surfaces.gbuffer, *side);
    const GatherOptions options = m.gatherOptionsOf(*m.picture.shown, *side, light.visibility, set);
    return m.gatherPass.readSamples(light.inputs(m.surfaces.gbuffer, m.scene->root, options),
                                    {x, y});
}

std::optional<GatherShares> FrameRenderer::readGatherShares(int sideIndex) const {
    Impl& m = *impl_;
    Side* side = m.gatheredSide(sideIndex);
    if (!side) return std::nullopt;
    const SetLight light = m.lightOfSet(*m.picture.shown, 1, m.surfaces.gbuffer, *side);
    const GatherOptions options = m.gatherOptionsOf(*m.picture.shown, *side, light.visibility, 1);
    return m.gatherPass.readShares(light.inputs(m.surfaces.gbuffer, m.scene->root, options));
}

}  // namespace mv
