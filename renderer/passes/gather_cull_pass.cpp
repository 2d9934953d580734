#include "renderer/passes/gather_cull_pass.h"

#include <algorithm>
#include <cassert>

#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_sampling.glsl"

namespace mv {
namespace {

// Runs of all receivers together: 128 MiB, which is 194 to each of 1280 x 720 pixels' receivers.
constexpr std::uint32_t kMaxRunsOfAll = 1u << 23;

int tilesIn(int pixels, std::uint32_t shift) { return (pixels + (1 << shift) - 1) >> shift; }

}  // namespace

std::uint64_t GatherLists::bytes() const {
    return surfaces.bytes() + planes.bytes() + tiles.bytes() + lists.bytes() + runs.bytes() +
           searchTable.bytes();
}

GatherCullPass::GatherCullPass() {
    surfaces_ = gl::Program("gather surfaces", {"passes/gather_surfaces.comp"});
    tiles_ = gl::Program("gather tiles", {"passes/gather_tiles.comp"});
    cull_ = gl::Program("gather cull", {"passes/gather_cull.comp"});
    searchTable_ = gl::Program("run search table", {"passes/run_search_table.comp"});
}

void GatherCullPass::findTiles(const GBuffer& gbuffer, const GatherCullOptions& options,
                               GatherLists& out) {
    const int width = (gbuffer.width + options.scale - 1) / options.scale;
    const int height = (gbuffer.height + options.scale - 1) / options.scale;
    out.surfaces.ensure("gather surfaces", GL_TEXTURE_2D, GL_RGBA32UI, width, height);
    out.planes.ensure("gather planes", GL_TEXTURE_2D, GL_R32UI, width, height);
    gbuffer.position.bind(kUnitPosition);
    gbuffer.normal.bind(kUnitNormal);
    gbuffer.plane.bind(kUnitPlane);
    out.surfaces.bindImage(kImageSurfaces, GL_WRITE_ONLY, GL_RGBA32UI);
    out.planes.bindImage(kImagePlanes, GL_WRITE_ONLY, GL_R32UI);
    surfaces_.set("size", glm::ivec2(width, height));
    surfaces_.set("scale", options.scale);
    surfaces_.dispatch2D(width, height);

    out.tilesAcross = 0;
    out.receiverCount = 1;
    out.tiles.ensure("gather tiles", 1);
    if (options.level <= 0) return;
    out.tileShift = kTileShift;
    glm::ivec2 tiles;
    do {
        tiles = {tilesIn(width, out.tileShift), tilesIn(height, out.tileShift)};
    } while (tiles.x * tiles.y > static_cast<int>(kMaxTiles) && ++out.tileShift < 31);
    const auto count = static_cast<std::uint32_t>(tiles.x * tiles.y);
    out.tilesAcross = static_cast<std::uint32_t>(tiles.x);
    out.receiverCount = kTileParts * count + 1;
    out.tiles.ensure("gather tiles", kTileParts * count);
    out.surfaces.bind(kUnitSurfaces);
    out.tiles.bindStorage(kBlockTiles);
    out.planes.bindImage(kImagePlanes, GL_READ_WRITE, GL_R32UI);
    tiles_.set("tileCount", tiles);
    tiles_.set("tileEdge", 1 << out.tileShift);
    tiles_.dispatchInvocations(count);
}

void GatherCullPass::render(const GBuffer& gbuffer, const GpuViewHierarchy& cullTree,
                            const GatherViews& views, const GatherCullOptions& options,
                            GatherLists& out) {
    assert(!cullTree.flat && cullTree.nodeCount > 0 && options.maxRuns < 65536);
    findTiles(gbuffer, options, out);

    out.capacity = std::clamp(kMaxRunsOfAll / out.receiverCount, 1u, options.maxRuns);
    out.lists.ensure("gather lists", out.receiverCount);
    out.runs.ensure("gather runs", std::uint64_t{out.receiverCount} * out.capacity);
    cullTree.nodes.bindTexels(kUnitViewNodes);
    views.prefix.bindTexels(kUnitPowerPrefix);
    out.tiles.bindTexels(kUnitTiles);
    out.runs.bindStorage(kBlockRuns);
    out.lists.bindStorage(kBlockReceiverLists);
    cull_.set("receiverCount", out.receiverCount);
    cull_.set("capacity", out.capacity);
    cull_.set("cullLevel", static_cast<std::uint32_t>(std::max(options.level, 0)));
    cull_.set("cutoff", static_cast<float>(options.cutoff));
    cull_.dispatchInvocations(out.receiverCount);

    out.runWords = gl::TextureBuffer("gather: run words", GL_R32UI, out.runs);
    const std::uint64_t slots = std::uint64_t{out.receiverCount} * kRunSearchSlots;
    out.searchTable.ensure("run search table", slots);
    out.lists.bindTexels(kUnitReceiverLists);
    out.runWords.bind(kUnitRunWords);
    out.searchTable.bindStorage(kBlockRunSearch);
    searchTable_.set("receiverCount", out.receiverCount);
    searchTable_.set("capacity", out.capacity);
    searchTable_.dispatchInvocations(slots);
}

}  // namespace mv
