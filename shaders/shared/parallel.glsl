// Parallel views: depth maps of R x R texels of everything in a ball, seen along one direction, as
// light from far away meets it. A map is a square of the ball's diameter across the direction;
// texel (j, i) is number j * R + i, i along the view's right, j along its up. Depths are root-cube
// units from the plane that touches the ball where the light comes in.
#ifndef MV_PARALLEL_GLSL
#define MV_PARALLEL_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/map_verdict.glsl"
#include "shaders/shared/sampling.glsl"
#include "shaders/shared/vir.glsl"

MV_BEGIN_NAMESPACE

struct ParallelView {
    vec3 right, up, toLight;  // orthonormal
};
MV_FN ParallelView parallelView(vec3 toLight) {
    ParallelView v;
    v.right = aroundAxis(toLight, 1.0f, 0.0f, 0.0f);
    v.up = aroundAxis(toLight, 0.0f, 1.0f, 0.0f);
    v.toLight = toLight;
    return v;
}

MV_FN float parallelTexel(float radius, uint mapRes) { return 2.0f * radius / float(mapRes); }

// Column and row, in texels from the map's corner, and depth of a point at an offset from the
// ball's centre.
MV_FN vec3 parallelPlace(ParallelView v, vec3 offset, float radius, uint mapRes) {
    MV_PRECISE float perTexel = float(mapRes) / (2.0f * radius);
    MV_PRECISE float column = (dot3(offset, v.right) + radius) * perTexel;
    MV_PRECISE float row = (dot3(offset, v.up) + radius) * perTexel;
    MV_PRECISE float depth = radius - dot3(offset, v.toLight);
    return vec3(column, row, max(depth, 1e-20f));
}

// How a plane's depth grows from one texel to the next, along columns and rows. facing: the cosine
// between its normal and the light, not 0.
MV_FN vec2 parallelSlope(ParallelView v, vec3 normal, float facing, float texel) {
    MV_PRECISE float along = dot3(normal, v.right) / facing * texel;
    MV_PRECISE float across = dot3(normal, v.up) / facing * texel;
    return vec2(along, across);
}

// ---------------------------------------------------------------- points to texels

// Planes seen flatter than this hide no texel's centre.
MV_CONST float kParallelFlat = 1e-4f;

// A point as a parallel view sees it: a disc in the plane of its triangle, cut by its edges where
// the triangle has a lattice of points (vir.glsl).
struct ParallelSplat {
    vec3 a, b, c;   // corners: column, row, depth
    vec3 place;     // of the point
    vec2 slope;     // of the plane
    vec2 reach;     // of the disc, texels along columns and rows
    float radius2;  // of the disc, squared
    float texel;    // edge of one
    bool seen, alone;
};

// a, b, c, position: offsets from the ball's centre.
MV_FN ParallelSplat parallelSplat(ParallelView v, vec3 a, vec3 b, vec3 c, vec3 position,
                                  float spacing, float ballRadius, uint mapRes) {
    ParallelSplat s;
    s.texel = parallelTexel(ballRadius, mapRes);
    vec3 normal = virNormal(a, b, c);
    float facing = dot3(normal, v.toLight);
    s.seen = abs(facing) > kParallelFlat;
    s.slope = parallelSlope(v, normal, s.seen ? facing : 1.0f, s.texel);
    s.a = parallelPlace(v, a, ballRadius, mapRes);
    s.b = parallelPlace(v, b, ballRadius, mapRes);
    s.c = parallelPlace(v, c, ballRadius, mapRes);
    s.place = parallelPlace(v, position, ballRadius, mapRes);
    s.alone = !virIsLattice(a, b, c, spacing);
    float radius = spacing * (s.alone ? kVirAloneRadius : kVirLatticeRadius);
    MV_PRECISE float right = dot3(normal, v.right);
    MV_PRECISE float up = dot3(normal, v.up);
    MV_PRECISE float along = radius * sqrt(max(1.0f - right * right, 0.0f)) / s.texel;
    MV_PRECISE float across = radius * sqrt(max(1.0f - up * up, 0.0f)) / s.texel;
    s.reach = vec2(along, across);
    s.radius2 = radius * radius;
    return s;
}

// Texels whose centres the disc may cover: first column, first row, end column, end row; none if
// all zero.
MV_FN uvec4 parallelTexels(ParallelSplat s, uint mapRes) {
    float res = float(mapRes);
    float c0 = clamp(-floor(s.reach.x + 0.5f - s.place.x), 0.0f, res);
    float r0 = clamp(-floor(s.reach.y + 0.5f - s.place.y), 0.0f, res);
    float c1 = clamp(floor(s.place.x + s.reach.x + 0.5f), 0.0f, res);
    float r1 = clamp(floor(s.place.y + s.reach.y + 0.5f), 0.0f, res);
    if (!s.seen || !(c1 > c0) || !(r1 > r0)) return uvec4(0u);
    return uvec4(uint(c0), uint(r0), uint(c1), uint(r1));
}

// On which side of an edge lies p? The same bits with the other sign from the neighbour across it.
MV_FN float parallelSide(vec3 from, vec3 to, vec2 p) {
    MV_PRECISE float ax = from.x - p.x;
    MV_PRECISE float ay = from.y - p.y;
    MV_PRECISE float bx = to.x - p.x;
    MV_PRECISE float by = to.y - p.y;
    MV_PRECISE float side = ax * by - ay * bx;
    return side;
}

// What a point writes into a texel, as bits of a depth: that of the disc at the texel's centre;
// kNone if it does not reach there.
MV_FN uint parallelDepth(ParallelSplat s, uint column, uint row) {
    vec2 centre = vec2(float(column) + 0.5f, float(row) + 0.5f);
    MV_PRECISE float x = centre.x - s.place.x;
    MV_PRECISE float y = centre.y - s.place.y;
    MV_PRECISE float deeper = s.slope.x * x + s.slope.y * y;
    MV_PRECISE float depth = s.place.z + deeper;
    MV_PRECISE float distance2 = (x * x + y * y) * (s.texel * s.texel) + deeper * deeper;
    float ab = parallelSide(s.a, s.b, centre);
    float bc = parallelSide(s.b, s.c, centre);
    float ca = parallelSide(s.c, s.a, centre);
    bool inside =
        (ab >= 0.0f && bc >= 0.0f && ca >= 0.0f) || (ab <= 0.0f && bc <= 0.0f && ca <= 0.0f);
    bool meets = depth > 0.0f && distance2 <= s.radius2 && (s.alone || inside);
    return meets ? floatBitsToUint(depth) : kNone;
}

// ---------------------------------------------------------------- shadow test

// Shares of a texel's edge. What is nearer than the plane by less than the first is rounding; by
// more than both, and something stands before it. With 0.3 of rounding light comes into closed
// rooms, along their ceilings.
MV_CONST float kParallelSlack = 0.002f;
MV_CONST float kParallelDoubt = 1.0f;
// Receivers that the light meets flatter than this are undecided: a cosine.
MV_CONST float kParallelGrazing = 0.1f;

// What a map's texel says of a receiver (map_verdict.glsl), compared with the receiver's own plane
// at the texel's centre, as texelVerdict() does for maps of views. depth: of that plane there.
MV_FN uint parallelVerdict(uint bits, float depth, float texel) {
    if (bits == kNone) return kVerdictLit;
    float z = uintBitsToFloat(bits);
    if (z >= depth - kParallelSlack * texel) return kVerdictLit;
    return z < depth - (kParallelSlack + kParallelDoubt) * texel ? kVerdictBlocked
                                                                 : kVerdictUndecided;
}

MV_END_NAMESPACE
#endif
