// Directions from uniform random numbers, by + - * / and sqrt alone: C++ and any GPU whose
// arithmetic is that of IEEE 754 draw the same bits.
#ifndef MV_SAMPLING_GLSL
#define MV_SAMPLING_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

// (cos, sin) of 2 pi u for u in [0, 1], absolute error below 2e-7, by octants and the Taylor
// series of sine and cosine on [-pi/4, pi/4].
MV_FN vec2 cosSin2Pi(float u) {
    float quadrant = floor(4.0f * u + 0.5f);
    MV_PRECISE float x = (4.0f * u - quadrant) * (0.5f * kPi);
    MV_PRECISE float x2 = x * x;
    MV_PRECISE float s =
        x * (1.0f + x2 * (-1.0f / 6.0f + x2 * (1.0f / 120.0f + x2 * (-1.0f / 5040.0f))));
    MV_PRECISE float c =
        1.0f + x2 * (-0.5f + x2 * (1.0f / 24.0f + x2 * (-1.0f / 720.0f + x2 * (1.0f / 40320.0f))));
    int q = int(quadrant) & 3;
    if (q == 1) return vec2(-s, c);
    if (q == 2) return vec2(-c, -s);
    if (q == 3) return vec2(s, -c);
    return vec2(c, s);
}

// x * tangent + y * bitangent + z * n for unit n, continuous but at n.z = 0 [Duff et al. 2017,
// Building an Orthonormal Basis, Revisited, JCGT 6(1)].
MV_FN vec3 aroundAxis(vec3 n, float x, float y, float z) {
    float side = n.z >= 0.0f ? 1.0f : -1.0f;
    MV_PRECISE float a = -1.0f / (side + n.z);
    MV_PRECISE float b = n.x * n.y * a;
    MV_PRECISE vec3 tangent = vec3(1.0f + side * n.x * n.x * a, side * b, -side * n.x);
    MV_PRECISE vec3 bitangent = vec3(b, side + n.y * n.y * a, -n.y);
    MV_PRECISE vec3 v = tangent * x + bitangent * y + n * z;
    return v;
}

// Density cos / pi over the half space of unit n.
MV_FN vec3 cosineDirection(vec3 n, float u, float v) {
    vec2 cs = cosSin2Pi(v);
    MV_PRECISE float r = sqrt(u);
    MV_PRECISE float z = sqrt(1.0f - u);
    MV_PRECISE float x = r * cs.x;
    MV_PRECISE float y = r * cs.y;
    return aroundAxis(n, x, y, z);
}

MV_FN vec3 sphereDirection(float u, float v) {
    vec2 cs = cosSin2Pi(v);
    MV_PRECISE float z = 1.0f - 2.0f * u;
    MV_PRECISE float r = sqrt(max(1.0f - z * z, 0.0f));
    MV_PRECISE vec3 d = vec3(r * cs.x, r * cs.y, z);
    return d;
}

// Cosine of the angle from a spot's axis, distributed as its falloff over solid angle: constant in
// the inner cone; in the ramp the square of a linear function, whose distribution is that of the
// largest of three uniform numbers.
MV_FN float spotCosine(float cosInner, float cosOuter, float u, float a, float b, float c) {
    MV_PRECISE float width = max(cosInner - cosOuter, 0.0f);
    MV_PRECISE float inner = 1.0f - cosInner;
    MV_PRECISE float share = u * (inner + width / 3.0f);
    MV_PRECISE float inside = 1.0f - share;
    MV_PRECISE float ramp = cosOuter + width * max(a, max(b, c));
    return share < inner ? inside : ramp;
}

MV_END_NAMESPACE
#endif
