// The views' maps as the gather reads them.
// MV_MAPS_IN_QUADS: four words of a map are one texel of the buffer texture, which would be too
// small else. MV_MAPS_PACKED 1: maps have 16 bits a texel.
// MV_VERDICTS 1: maps from firstMap to endMap are there.
uniform uint mapRes;
uniform float bias;

#if MV_VERDICTS == 1
uniform uint firstMap;
uniform uint endMap;
#else
const uint firstMap = 0u;
#endif

#define MV_MAP_RES mapRes
#ifdef MV_MAPS_IN_QUADS
#define MV_MAPS_READ 2
#else
#define MV_MAPS_READ 1
#endif
#include "shaders/passes/map_texels.glsl"
