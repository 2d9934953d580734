// Dual paraboloid maps of R x R texels a face [BAS02]: face 0 looks along +x, face 1 along -x,
// (u, v) = (y, z) / (1 + |x|) of a unit direction, in [-1, 1]. All maps share one orientation
// [Kol19 §3.1]. Texel (face, j, i) is number face * R^2 + j * R + i; i runs along u, j along v.
// A face's disc has radius 1. Texels at its rim whose centre lies outside are ordinary texels:
// directions of the face fall into them, while their centre's direction is the other face's.
#ifndef MV_PARABOLOID_GLSL
#define MV_PARABOLOID_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/rules.glsl"

MV_BEGIN_NAMESPACE

MV_FN uint mapTexels(uint mapRes) { return 2u * mapRes * mapRes; }

// The texel that the direction (of any length) falls into; a zero direction counts as +x.
MV_FN uint texelOfDirection(vec3 d, uint mapRes) {
    MV_PRECISE float w = length3(d) + abs(d.x);
    if (!(w > 0.0f)) w = 1.0f;
    float res = float(mapRes);
    MV_PRECISE float column = (d.y / w + 1.0f) * (0.5f * res);
    MV_PRECISE float row = (d.z / w + 1.0f) * (0.5f * res);
    uint i = uint(clamp(column, 0.0f, res - 1.0f));
    uint j = uint(clamp(row, 0.0f, res - 1.0f));
    uint face = d.x < 0.0f ? 1u : 0u;
    return (face * mapRes + j) * mapRes + i;
}

// (u, v) of a texel's centre.
MV_FN vec2 texelCenter(uint column, uint row, uint mapRes) {
    MV_PRECISE float scale = 2.0f / float(mapRes);
    MV_PRECISE float u = (float(column) + 0.5f) * scale - 1.0f;
    MV_PRECISE float v = (float(row) + 0.5f) * scale - 1.0f;
    return vec2(u, v);
}
MV_FN vec2 texelCenter(uint texel, uint mapRes) {
    // Exact, since mapRes is a power of two; integers are divided lane by lane on a software
    // renderer.
    uint row = uint(float(texel) / float(mapRes));
    return texelCenter(texel & (mapRes - 1u), row & (mapRes - 1u), mapRes);
}

// Direction of a texel's centre, not normalised: its length is 1 + rho^2, rho the centre's radius.
MV_FN vec3 centerRay(uint face, vec2 c) {
    MV_PRECISE float rho2 = c.x * c.x + c.y * c.y;
    MV_PRECISE float x = 1.0f - rho2;
    float y = 2.0f * c.x;
    float z = 2.0f * c.y;
    return vec3(face != 0u ? -x : x, y, z);
}
MV_FN float centerRayLength(vec2 c) {
    MV_PRECISE float r = 1.0f + (c.x * c.x + c.y * c.y);
    return r;
}
MV_FN vec3 texelRay(uint texel, uint mapRes) {
    return centerRay(texel >= mapRes * mapRes ? 1u : 0u, texelCenter(texel, mapRes));
}
MV_FN float texelRayLength(uint texel, uint mapRes) {
    return centerRayLength(texelCenter(texel, mapRes));
}
MV_FN vec3 texelDirection(uint texel, uint mapRes) {
    vec3 d = texelRay(texel, mapRes);
    MV_PRECISE float l = texelRayLength(texel, mapRes);
    MV_PRECISE float x = d.x / l;
    MV_PRECISE float y = d.y / l;
    MV_PRECISE float z = d.z / l;
    return vec3(x, y, z);
}

// The four texels whose centres lie around a direction, of its own face; at the face's border some
// are the same.
struct NearestTexels {
    uint face;
    uvec4 texels;
    vec4 u, v;  // of their centres
};
MV_FN NearestTexels nearestTexels(vec3 d, uint mapRes) {
    MV_PRECISE float w = length3(d) + abs(d.x);
    if (!(w > 0.0f)) w = 1.0f;
    float res = float(mapRes);
    float last = res - 1.0f;
    MV_PRECISE float column = floor((d.y / w + 1.0f) * (0.5f * res) - 0.5f);
    MV_PRECISE float row = floor((d.z / w + 1.0f) * (0.5f * res) - 0.5f);
    uint i0 = uint(clamp(column, 0.0f, last));
    uint i1 = uint(clamp(column + 1.0f, 0.0f, last));
    uint j0 = uint(clamp(row, 0.0f, last));
    uint j1 = uint(clamp(row + 1.0f, 0.0f, last));
    NearestTexels n;
    n.face = d.x < 0.0f ? 1u : 0u;
    uint row0 = (n.face * mapRes + j0) * mapRes;
    uint row1 = (n.face * mapRes + j1) * mapRes;
    n.texels = uvec4(row0 + i0, row0 + i1, row1 + i0, row1 + i1);
    vec2 c0 = texelCenter(i0, j0, mapRes);
    vec2 c1 = texelCenter(i1, j1, mapRes);
    n.u = vec4(c0.x, c1.x, c0.x, c1.x);
    n.v = vec4(c0.y, c0.y, c1.y, c1.y);
    return n;
}

// Can any direction fall into this texel? False only for the corners outside the disc.
MV_FN bool texelReachable(uint texel, uint mapRes) {
    vec2 c = texelCenter(texel, mapRes);
    float halfTexel = 1.0f / float(mapRes);
    float u = max(abs(c.x) - halfTexel, 0.0f);
    float v = max(abs(c.y) - halfTexel, 0.0f);
    return u * u + v * v < 1.0f;
}

// Coarser levels of a map, for multi-pixel filling without surface elements [Kol19 §3.2]: level
// m = 1 .. log2(R) has R >> m texels across a face, laid out as the map itself, one level after
// the other. At 16 texels the paper fills nothing; neither does this.
MV_FN bool mipFilled(uint rules, bool holeFill, uint mapRes) {
    return !hasRule(rules, kRuleSurfaces) && holeFill && mapRes > 16u;
}
MV_FN uint mipOffset(uint level, uint mapRes) {
    // 2 (R/2)^2 + 2 (R/4)^2 + ... up to the level before: 2 (R^2 - (2 R/2^level)^2) / 3
    uint r = (mapRes >> level) << 1u;
    return 2u * (mapRes * mapRes - r * r) / 3u;
}
MV_FN uint mipTexels(uint mapRes) { return 2u * (mapRes * mapRes - 1u) / 3u; }
// The texel of a level that covers a texel of the map.
MV_FN uint mipTexelOf(uint texel, uint level, uint mapRes) {
    uint i = (texel & (mapRes - 1u)) >> level;
    uint j = ((texel / mapRes) & (mapRes - 1u)) >> level;
    uint face = texel / (mapRes * mapRes);
    uint r = mapRes >> level;
    return mipOffset(level, mapRes) + (face * r + j) * r + i;
}

MV_END_NAMESPACE
#endif
