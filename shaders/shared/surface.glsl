// The plane of the surface inside a scene node, packed into SceneNode::surface: an octahedral
// normal of 15 bits a component (0.1 mrad; axis-aligned normals are exact), whether the surface is
// flat enough to stand for itself and whether it is a plane. The normal has no side: a thin wall
// has both.
#ifndef MV_SURFACE_GLSL
#define MV_SURFACE_GLSL
#include "shaders/shared/octahedral.glsl"

MV_BEGIN_NAMESPACE

MV_CONST uint kSurfaceUsable = 0x80000000u;  // else the surface fills its box
MV_CONST uint kSurfacePlanar = 0x40000000u;  // usable, and nowhere off its plane
MV_CONST float kSurfaceScale = 16383.0f;
MV_CONST float kSurfaceErrorRad = 1e-4f;  // that packing may turn a normal by

MV_FN uint packSurface(vec3 normal, bool usable) {
    bool exists = abs(normal.x) + abs(normal.y) + abs(normal.z) > 0.0f;
    if (!usable || !exists) return 0u;
    vec2 p = octahedralPoint(normal);
    uint iu = uint(p.x * kSurfaceScale + (kSurfaceScale + 0.5f));
    uint iv = uint(p.y * kSurfaceScale + (kSurfaceScale + 0.5f));
    return kSurfaceUsable | (iu << 15u) | iv;
}
MV_FN bool surfaceUsable(uint surface) { return (surface & kSurfaceUsable) != 0u; }
MV_FN bool surfacePlanar(uint surface) { return (surface & kSurfacePlanar) != 0u; }
// Unit normal of a usable surface; the same bits in C++ and GLSL.
MV_FN vec3 surfaceNormal(uint surface) {
    MV_PRECISE float u = (float((surface >> 15u) & 0x7FFFu) - kSurfaceScale) / kSurfaceScale;
    MV_PRECISE float v = (float(surface & 0x7FFFu) - kSurfaceScale) / kSurfaceScale;
    return normalizeOr(octahedralDirection(vec2(u, v), 1.0f), vec3(0.0f, 0.0f, 1.0f));
}

MV_END_NAMESPACE
#endif
