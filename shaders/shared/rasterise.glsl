// A triangle in a dual paraboloid map: which texels it may cover, and whether the ray through a
// texel's centre meets it. Corners are as seen from the view, corner - view.
//
// From a view, a triangle smaller than a half space lies within the cone around the mean direction
// of its corners that holds the corners. The map is the stereographic projection, so that the cone
// is a disc on either face.
#ifndef MV_RASTERISE_GLSL
#define MV_RASTERISE_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/paraboloid.glsl"

MV_BEGIN_NAMESPACE

// Texels of a face whose centres lie within a cone around (x, y, z), x positive towards the face:
// first column, first row, end column, end row; none if all zero. The direction and (cosCone,
// sinCone) have the same length l.
MV_FN uvec4 discTexels(float x, float y, float z, float cosCone, float sinCone, float l,
                       uint viewRes) {
    float res = float(viewRes);
    // The corners of the face are sqrt(2) from its middle: acos(-1/3) away.
    MV_PRECISE float nearest = x * cosCone + sqrt(y * y + z * z) * sinCone;
    if (nearest < -0.34f * l * l) return uvec4(0u);
    MV_PRECISE float w = cosCone + x;
    // About the pole at infinity the disc is too large for its digits, or inside out.
    if (!(w > 0.01f * l)) return uvec4(0u, 0u, viewRes, viewRes);
    float perTexel = 0.5f * res;
    MV_PRECISE float reach = sinCone / w * perTexel + 2e-3f;
    MV_PRECISE float column = (y / w + 1.0f) * perTexel - 0.5f;
    MV_PRECISE float row = (z / w + 1.0f) * perTexel - 0.5f;
    float c0 = clamp(-floor(reach - column), 0.0f, res);
    float c1 = clamp(floor(column + reach) + 1.0f, 0.0f, res);
    float r0 = clamp(-floor(reach - row), 0.0f, res);
    float r1 = clamp(floor(row + reach) + 1.0f, 0.0f, res);
    if (!(c1 > c0) || !(r1 > r0)) return uvec4(0u);
    return uvec4(uint(c0), uint(r0), uint(c1), uint(r1));
}

// The same of a ball, seen from outside: what most triangles are soon rejected by. l2: of offset.
MV_FN uvec4 ballDiscTexels(vec3 offset, float l2, float radius, uint viewRes) {
    float tangent2 = l2 - radius * radius;
    if (!(tangent2 > 1e-4f * l2)) return uvec4(0u, 0u, viewRes, viewRes);
    float l = sqrt(l2);
    return discTexels(offset.x, offset.y, offset.z, sqrt(tangent2), radius, l, viewRes);
}

// The texels of both faces whose centres the triangle may cover; never too few.
MV_FN void triangleTexels(vec3 a, vec3 b, vec3 c, uint viewRes, MV_OUT(uvec4) front,
                          MV_OUT(uvec4) back) {
    front = uvec4(0u, 0u, viewRes, viewRes);
    back = front;
    vec3 da = normalizeOr(a, vec3(0.0f));
    vec3 db = normalizeOr(b, vec3(0.0f));
    vec3 dc = normalizeOr(c, vec3(0.0f));
    MV_PRECISE vec3 sum = da + db + dc;
    vec3 axis = normalizeOr(sum, vec3(0.0f));
    // By chords: exact for small triangles, where a cosine is not.
    vec3 ea = da - axis;
    vec3 eb = db - axis;
    vec3 ec = dc - axis;
    MV_PRECISE float chord2 = max(dot3(ea, ea), max(dot3(eb, eb), dot3(ec, ec)));
    chord2 = chord2 * 1.00001f + 1e-12f;
    MV_PRECISE float cosCone = 1.0f - 0.5f * chord2;
    // Half a space or more: no cone; a corner where the view is has no direction, and chord 1.
    bool anywhere =
        !(cosCone > 1e-3f) || dot3(da, da) == 0.0f || dot3(db, db) == 0.0f || dot3(dc, dc) == 0.0f;
    if (anywhere) return;
    MV_PRECISE float sinCone = sqrt(chord2 * (1.0f - 0.25f * chord2));
    front = discTexels(axis.x, axis.y, axis.z, cosCone, sinCone, 1.0f, viewRes);
    back = discTexels(-axis.x, axis.y, axis.z, cosCone, sinCone, 1.0f, viewRes);
}

// The planes through the view and each edge: the same bits with the other sign for the neighbour
// across it, so that no ray slips between two triangles that share corners.
struct TriangleEdges {
    vec3 ab, bc, ca;
};
MV_FN TriangleEdges triangleEdges(vec3 a, vec3 b, vec3 c) {
    TriangleEdges e;
    e.ab = cross3(a, b);
    e.bc = cross3(b, c);
    e.ca = cross3(c, a);
    return e;
}

// Does the line along `ray` through the view meet the triangle? u, v: weights of the second and
// third corner where it does.
MV_FN bool meetsTriangle(TriangleEdges e, vec3 ray, MV_OUT(float) u, MV_OUT(float) v) {
    MV_PRECISE float wa = dot3(e.bc, ray);
    MV_PRECISE float wb = dot3(e.ca, ray);
    MV_PRECISE float wc = dot3(e.ab, ray);
    bool inside =
        (wa >= 0.0f && wb >= 0.0f && wc >= 0.0f) || (wa <= 0.0f && wb <= 0.0f && wc <= 0.0f);
    MV_PRECISE float det = wa + wb + wc;
    float safe = det != 0.0f ? det : 1.0f;
    u = wb / safe;
    v = wc / safe;
    return inside && det != 0.0f;
}

MV_END_NAMESPACE
#endif
