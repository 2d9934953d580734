#pragma once
// GBuffer x ViewHierarchy -> for every tile of the picture the views that can light what it shows
// [Kol19 §5.1], as runs of sorted views in bounded memory.

#include "megaviews/settings/settings.h"
#include "renderer/gl/program.h"
#include "renderer/passes/gather_views_pass.h"
#include "renderer/passes/gbuffer_pass.h"
#include "renderer/passes/gpu_data.h"
#include "shaders/shared/gather.glsl"

namespace mv {

struct GatherCullOptions : CullSettings {
    // One receiver has no more. Where a list needs more, its view tree is walked less deeply.
    std::uint32_t maxRuns = 512;
};

struct GatherLists {
    gl::Texture surfaces;  // RGBA32UI: position, packed normal (kNoSurface: none), gather size
    gl::Texture planes;    // R32UI: normal of the triangle and part of the tile (planeOfPart())
    // Receivers: number 0 holds everything, others are the kTileParts parts of tiles of
    // 2^tileShift pixels, row by row.
    gl::TexelBuffer<GatherTile> tiles;
    std::uint32_t tileShift = kTileShift;
    std::uint32_t tilesAcross = 0;               // 0: no tiles, number 0 serves every pixel
    gl::TexelBuffer<GatherList> lists;           // of a receiver
    gl::TexelBuffer<GatherRun> runs;             // receivers * capacity
    gl::TextureBuffer runWords;                  // the same, word by word
    gl::TexelBuffer<std::uint32_t> searchTable;  // receivers * kRunSearchSlots
    std::uint32_t receiverCount = 0;
    std::uint32_t capacity = 0;  // runs of each
    std::uint64_t bytes() const;
};

class GatherCullPass {
  public:
    GatherCullPass();
    // cullTree: a tree with at least one view.
    void render(const GBuffer& gbuffer, const GpuViewHierarchy& cullTree, const GatherViews& views,
                const GatherCullOptions& options, GatherLists& out);
    // Surfaces and tiles alone, which need no view.
    void findTiles(const GBuffer& gbuffer, const GatherCullOptions& options, GatherLists& out);

  private:
    gl::Program surfaces_, tiles_, cull_, searchTable_;
};

}  // namespace mv
