// The views' maps as the gather reads them.
// MAPS_IN_STORAGE: texels in a storage block, where a buffer texture would be too small.
uniform uint viewRes;
uniform float bias;

#define MV_MAP_RES viewRes
#ifdef MAPS_IN_STORAGE
#define MV_MAPS_READ 2
#else
#define MV_MAPS_READ 1
#endif
#include "shaders/passes/map_texels.glsl"
