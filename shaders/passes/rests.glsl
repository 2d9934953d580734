// Where light stays, pixels that remember enough of it gather in turns, tile by tile: the others'
// is what they remember.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/history.glsl"

layout(binding = kUnitRememberedSamples) uniform sampler2D beforeSamples;  // reproject.frag
uniform float restsFrom;  // samples that are enough; where nothing rests, more than there are
uniform uint turn;        // of kRestTurns

bool rests(ivec2 pixel) {
    uvec2 tile = uvec2(pixel) / kTileEdge;
    return restTurn(tile.x, tile.y) != turn && texelFetch(beforeSamples, pixel, 0).x >= restsFrom;
}
