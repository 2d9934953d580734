// Receivers' lists -> the views that the pixels of each tile's parts weigh: kDrawRanks for each
// sample, one invocation each.
#include "shaders/passes/gather_lists.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/gather.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(std430, binding = kBlockDraws) writeonly buffer Draws { GatherDraw draws[]; };

uniform uint drawTilesAcross;
uniform uint firstDrawTile;
uniform uint drawTiles;  // from there on
uniform uint samples;
uniform uint firstSample;  // of them, these are drawn
uniform uint sampleCount;
uniform uint seed;
uniform uint accumulationIndex;

void main() {
    uint index = globalIndex();
    uint each = sampleCount * kDrawRanks;
    if (index >= drawTiles * kTileParts * each) return;
    uint number = firstDrawTile + index / each / kTileParts;
    uvec2 tile = uvec2(number % drawTilesAcross, number / drawTilesAcross);
    uint stratum = firstSample + index % each / kDrawRanks;
    uint receiver = receiverOf(tile * kTileEdge, index / each % kTileParts);
    uvec4 list = texelFetch(lists, int(receiver));
    GatherDraw draw = GatherDraw(kNone, 0.0);
    if (list.y > 0u && samples < list.z) {
        uint offset =
            drawOffset(seed, tile.x, tile.y, stratum, index % kDrawRanks, accumulationIndex);
        draw.view = viewOfStratum(receiver, list.y, samples, stratum, offset, draw.weight);
    }
    draws[index] = draw;
}
