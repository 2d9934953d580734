// Receivers' lists -> the views that the pixels of each tile's parts weigh: drawsOfStratum()
// for each sample, of which an invocation draws every kDrawLanes-th.
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
uniform uint candidates;
uniform uint seed;
uniform uint accumulationIndex;

void main() {
    uint index = globalIndex();
    if (index >= drawTiles * kTileParts * sampleCount * kDrawLanes) return;
    uint lane = index % kDrawLanes;
    index /= kDrawLanes;
    uint first = index * drawsOfStratum(candidates);
    uint part = index / sampleCount % kTileParts;
    uint stratum = firstSample + index % sampleCount;
    uint number = firstDrawTile + index / sampleCount / kTileParts;
    uvec2 tile = uvec2(number % drawTilesAcross, number / drawTilesAcross);
    uint receiver = receiverOf(tile * kTileEdge, part);
    uvec4 list = texelFetch(lists, int(receiver));
    // Nobody asks for those of a part without pixels, or of one that sums all its views. A loop
    // ends for all lanes where a software renderer would not branch.
    uint end = list.x > 0u && samples < list.z ? drawsOfStratum(candidates) : 0u;
    Stratum ofUnits = stratumOf(list.y, samples, stratum);
    uint offset = drawOffsetOfTile(seed, tile.x, tile.y, accumulationIndex);
    for (uint i = lane; i < end; i += kDrawLanes) {
        uint rank = i << drawShift(candidates);
        uint at = offset + drawOffsetOfRank(seed, tile.x, tile.y, stratum, rank, accumulationIndex);
        float weight;
        uint view = viewOfStratum(receiver, list.y, ofUnits, at, weight);
        draws[first + i] = GatherDraw(view, weight);
    }
}
