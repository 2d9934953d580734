// What the host says of each light to the shader of direct lighting.
#ifndef MV_DIRECT_LIGHT_GLSL
#define MV_DIRECT_LIGHT_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

// 112 bytes.
struct DirectLight {
    vec4 position;   // root-cube units; w: first layer of its shadow maps
    vec4 right;      // sun: row of the matrix to its map's [-1,1]; spot: unit axis of its map
    vec4 up;         // likewise
    vec4 forward;    // likewise; spot: the unit axis; sun: depth
    vec4 intensity;  // W/sr, sun: W/m^2; w: size of a texel at depth 1, sun: at any depth
    vec4 toward;     // sun: unit vector towards it
    vec4 cone;       // cosInner, cosOuter, scale of the map, near plane
};

MV_END_NAMESPACE

#ifdef __cplusplus
static_assert(sizeof(mv::DirectLight) == 112);
#endif
#endif
