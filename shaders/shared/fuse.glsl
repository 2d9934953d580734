// Fusion [Kol19 §3.2]: what a parent's map saw, as its child sees it. The texel stays the same (the
// equivalence rule promised that), the depth is measured from the child's centre instead.
#ifndef MV_FUSE_GLSL
#define MV_FUSE_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/parametrisation.glsl"

MV_BEGIN_NAMESPACE

// offset = parent's centre - child's centre. kNone stays kNone.
MV_FN uint recenterDepth(uint bits, uint texel, uint mapRes, vec3 offset) {
    if (bits == kNone) return kNone;
    vec3 d = texelDirection(texel, mapRes);
    MV_PRECISE float z = uintBitsToFloat(bits);
    MV_PRECISE float x = d.x * z + offset.x;
    MV_PRECISE float y = d.y * z + offset.y;
    MV_PRECISE float w = d.z * z + offset.z;
    return floatBitsToUint(length3(vec3(x, y, w)));
}

MV_END_NAMESPACE
#endif
