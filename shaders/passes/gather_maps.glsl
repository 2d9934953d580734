// The views' maps as the gather reads them.
// MAPS_IN_QUADS: four texels of a map are one of the buffer texture, which would be too small else.
uniform uint viewRes;
uniform float bias;

#define MV_MAP_RES viewRes
#ifdef MAPS_IN_QUADS
#define MV_MAPS_READ 2
#else
#define MV_MAPS_READ 1
#endif
#include "shaders/passes/map_texels.glsl"
