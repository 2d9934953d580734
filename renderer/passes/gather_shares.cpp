#include "renderer/passes/gather_shares.h"

#include <algorithm>
#include <cstring>

#include "shaders/shared/gather.glsl"

namespace mv {
namespace {

constexpr int kMeasureStride = 16;  // pixels of the gather, each way

// Share of the luminance that reaches the grid's pixels.
double clampedShare(GatherSum& sum, const GatherCall& in) {
    gl::Program& p = sum.bindMeasure(in);
    p.set("stride", kMeasureStride);
    const auto of = [](int pixels) { return (pixels + kMeasureStride - 1) / kMeasureStride; };
    gl::Texture measured;
    measured.ensure("clamped energy", GL_TEXTURE_2D, GL_RGBA32F, of(sum.lists.surfaces.width()),
                    of(sum.lists.surfaces.height()));
    const gl::Framebuffer target("clamped energy", {&measured});
    sum.inParts(p, GatherShader::measure, in, 1, [&] { p.drawFullScreen(target); });
    double clamped = 0, unclamped = 0;
    const std::vector<float> energy = measured.readFloats(4);
    for (std::size_t i = 0; i < energy.size(); i += 4) {
        clamped += double{energy[i]};
        unclamped += double{energy[i + 1]};
    }
    return unclamped > 0 ? std::max(0.0, 1 - clamped / unclamped) : 0;
}

bool faceEachOther(glm::vec3 position, glm::vec3 normal, const View& view) {
    const glm::vec3 way = viewPosition(view) - position;
    const glm::vec3 facing = viewNormal(view);
    const bool everywhere = facing == glm::vec3(0);
    return dot3(way, normal) > 0 && (everywhere || dot3(way, facing) < 0);
}

constexpr std::size_t kMostAsked = 65536;  // views a pixel, evenly along their curve

// Mean over the grid's pixels of the share of the views.
double facingShare(const GatherSum& sum, const GatherCall& in) {
    const gl::Texture& surfaces = sum.lists.surfaces;
    const std::vector<std::uint32_t> all = surfaces.readUints(4);
    std::vector<View> views = in.mapHierarchy.sortedViews.read(0, in.mapHierarchy.aliveCount);
    const std::size_t step = (views.size() + kMostAsked - 1) / kMostAsked;
    for (std::size_t i = 0; i * step < views.size(); ++i) views[i] = views[i * step];
    views.resize((views.size() + step - 1) / step);
    double facing = 0, pixels = 0;
    for (int y = 0; y < surfaces.height(); y += kMeasureStride) {
        for (int x = 0; x < surfaces.width(); x += kMeasureStride) {
            const std::uint32_t* surface =
                &all[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(surfaces.width()) +
                          static_cast<std::size_t>(x))];
            if (surface[3] == kNoSurface) continue;
            glm::vec3 position;
            std::memcpy(&position, surface, sizeof position);
            const glm::vec3 normal = unpackNormal(surface[3]);
            pixels += 1;
            facing += static_cast<double>(std::count_if(
                views.begin(), views.end(),
                [&](const View& view) { return faceEachOther(position, normal, view); }));
        }
    }
    return pixels > 0 ? facing / (pixels * static_cast<double>(views.size())) : 0;
}

}  // namespace

GatherShares readGatherShares(GatherSum& sum, const GatherCall& in) {
    GatherShares out;
    out.clampedEnergy = clampedShare(sum, in);
    out.facing = facingShare(sum, in);
    const GatherLists& lists = sum.lists;
    out.receivers = 1;
    if (lists.tilesAcross == 0) return out;
    const std::uint32_t tiles = lists.receiverCount - 1;
    const std::vector<GatherList> all = lists.lists.read(1, tiles);
    const std::vector<GatherTile> shown = lists.tiles.read(0, tiles);
    double kept = 0, runs = 0, pixels = 0;
    out.receivers = 0;
    for (std::uint32_t t = 0; t < tiles; ++t) {
        kept += 1.0 * all[t].views * shown[t].pixels;
        runs += 1.0 * all[t].runs * shown[t].pixels;
        pixels += shown[t].pixels;
        out.receivers += shown[t].pixels > 0;
    }
    out.kept = pixels > 0 ? kept / (sum.views.count * pixels) : 0;
    out.runs = pixels > 0 ? runs / pixels : 0;
    return out;
}

}  // namespace mv
