// A triangle in a map: which texels it may cover, and whether the ray through a texel's centre
// meets it. Corners are as seen from the view, corner - view.
//
// From a view, a triangle smaller than a half space lies within the cone around the mean direction
// of its corners that holds the corners.
#ifndef MV_RASTERISE_GLSL
#define MV_RASTERISE_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/parametrisation.glsl"

MV_BEGIN_NAMESPACE

// The texels of both faces whose centres the triangle may cover; never too few.
MV_FN void triangleTexels(vec3 a, vec3 b, vec3 c, uint mapRes, MV_OUT(uvec4) front,
                          MV_OUT(uvec4) back) {
    front = uvec4(0u, 0u, mapRes, mapRes);
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
    front = coneTexels(0u, axis, cosCone, sinCone, 1.0f, mapRes);
    back = coneTexels(1u, axis, cosCone, sinCone, 1.0f, mapRes);
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
