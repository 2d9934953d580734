// Directions as points of a square: the octahedron |x| + |y| + |z| = scale seen along z, its lower
// half folded outwards. Every packed normal is such a point, in as many bits as it can have.
#ifndef MV_OCTAHEDRAL_GLSL
#define MV_OCTAHEDRAL_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

// What the lower half of the octahedron is folded to, and back: across the square's edges.
MV_FN vec2 octahedralFold(vec2 p, float scale) {
    MV_PRECISE float u = (scale - abs(p.y)) * (p.x < 0.0f ? -1.0f : 1.0f);
    MV_PRECISE float v = (scale - abs(p.x)) * (p.y < 0.0f ? -1.0f : 1.0f);
    return vec2(u, v);
}

// The point of [-1, 1]^2 of a direction of any length; the middle for none.
MV_FN vec2 octahedralPoint(vec3 direction) {
    float l = abs(direction.x) + abs(direction.y) + abs(direction.z);
    if (!(l > 0.0f)) return vec2(0.0f, 0.0f);
    vec2 p = vec2(direction.x / l, direction.y / l);
    return direction.z < 0.0f ? octahedralFold(p, 1.0f) : p;
}

// The direction of a point of [-scale, scale]^2, of length scale / sqrt(3) to scale. The same bits
// in C++ and GLSL; axes are exact.
MV_FN vec3 octahedralDirection(vec2 p, float scale) {
    MV_PRECISE float z = scale - abs(p.x) - abs(p.y);
    vec2 q = z < 0.0f ? octahedralFold(p, scale) : p;
    return vec3(q.x, q.y, z);
}

MV_END_NAMESPACE
#endif
