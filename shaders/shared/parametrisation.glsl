// How directions fall into the texels of maps, and what balls, cones and points cover of them:
// dual paraboloid maps, which nothing outside this header and paraboloid.glsl knows, but for the
// projected sizes that pair.glsl compares.
#ifndef MV_PARAMETRISATION_GLSL
#define MV_PARAMETRISATION_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/paraboloid.glsl"

MV_BEGIN_NAMESPACE

MV_CONST uint kMapFaces = 2u;
MV_FN uint texelAt(uint face, uint column, uint row, uint mapRes) {
    return (face * mapRes + row) * mapRes + column;
}
MV_FN uint faceOfTexel(uint texel, uint mapRes) { return texel >= mapRes * mapRes ? 1u : 0u; }

// An offset in the frame of a face: x grows into it, y along its columns, z along its rows.
MV_FN vec3 fromFace(uint face, vec3 offset) {
    return vec3(face == 0u ? offset.x : -offset.x, offset.y, offset.z);
}

// The angle that the texel in a direction (of any length) covers: 4 / (R (1 + rho^2)) at radius rho
// of the face, where rho^2 = (1 - c) / (1 + c) and c = |x| of the unit direction.
MV_FN float texelAngle(vec3 direction, uint mapRes) {
    float l = length3(direction);
    float c = l > 0.0f ? abs(direction.x) / l : 1.0f;
    return 2.0f * (1.0f + c) / float(mapRes);
}

// Texels of one face whose centres a ball can cover: first column, first row, columns, rows.
// tangent = sqrt(l^2 - rs^2). The ball's disc on the face has centre (y, z) / (x + tangent) and
// radius rs / (x + tangent). Where the ball covers the pole that projects to infinity the disc
// turns inside out; then the whole face is taken.
MV_FN uvec4 ballTexels(uint face, vec3 offset, float rs, float tangent, uint mapRes) {
    vec3 d = fromFace(face, offset);
    float res = float(mapRes);
    // On the other side a ball begins at rho = tan((angle - delta) / 2) = (tangent - x) / across,
    // and the face's corners end at sqrt(2).
    MV_PRECISE float across = sqrt(d.y * d.y + d.z * d.z) + rs;
    if (d.x < 0.0f && tangent - d.x > 1.415f * across) return uvec4(0u);
    MV_PRECISE float w = d.x + tangent;
    if (!(w > 1e-4f * tangent)) return uvec4(0u, 0u, mapRes, mapRes);
    MV_PRECISE float perTexel = 0.5f * res;
    MV_PRECISE float scale = perTexel / w;
    MV_PRECISE float middle = perTexel - 0.5f;
    MV_PRECISE float reach = rs * scale + 1e-3f;
    MV_PRECISE float column = d.y * scale + middle;  // of the disc's centre
    MV_PRECISE float row = d.z * scale + middle;
    float c0 = clamp(-floor(reach - column), 0.0f, res);
    float c1 = clamp(floor(column + reach), -1.0f, res - 1.0f);
    float r0 = clamp(-floor(reach - row), 0.0f, res);
    float r1 = clamp(floor(row + reach), -1.0f, res - 1.0f);
    if (!(c1 >= c0) || !(r1 >= r0)) return uvec4(0u);
    return uvec4(uint(c0), uint(r0), uint(c1 - c0) + 1u, uint(r1 - r0) + 1u);
}

// Texels of one face that a point covers which stands for a disc of a radius, but for no more than
// `mostReach` texels from its middle: first column, first row, end column, end row; none if all
// zero. l: length of offset. A point on the face's own side covers the texel it falls into whatever
// its size; one on the other side only what its disc covers of the rim.
MV_FN uvec4 pointTexels(uint face, vec3 offset, float l, float radius, float mostReach,
                        uint mapRes) {
    vec3 d = fromFace(face, offset);
    float res = float(mapRes);
    MV_PRECISE float w = l + d.x;
    if (!(w > 0.01f * l)) return uvec4(0u);
    float perTexel = 0.5f * res;
    MV_PRECISE float reach = min(radius * perTexel / w, mostReach);
    MV_PRECISE float column = (d.y / w + 1.0f) * perTexel;
    MV_PRECISE float row = (d.z / w + 1.0f) * perTexel;
    float c0 = -floor(reach + 0.5f - column);
    float c1 = floor(column + reach + 0.5f);
    float r0 = -floor(reach + 0.5f - row);
    float r1 = floor(row + reach + 0.5f);
    if (d.x >= 0.0f) {
        c0 = min(c0, clamp(floor(column), 0.0f, res - 1.0f));
        c1 = max(c1, clamp(floor(column), 0.0f, res - 1.0f) + 1.0f);
        r0 = min(r0, clamp(floor(row), 0.0f, res - 1.0f));
        r1 = max(r1, clamp(floor(row), 0.0f, res - 1.0f) + 1.0f);
    }
    c0 = clamp(c0, 0.0f, res);
    c1 = clamp(c1, 0.0f, res);
    r0 = clamp(r0, 0.0f, res);
    r1 = clamp(r1, 0.0f, res);
    if (!(c1 > c0) || !(r1 > r0)) return uvec4(0u);
    return uvec4(uint(c0), uint(r0), uint(c1), uint(r1));
}

// Texels of a face whose centres lie within a cone around an axis: first column, first row, end
// column, end row; none if all zero. The axis and (cosCone, sinCone) have the same length l.
MV_FN uvec4 coneTexels(uint face, vec3 axis, float cosCone, float sinCone, float l, uint mapRes) {
    vec3 d = fromFace(face, axis);
    float res = float(mapRes);
    // The corners of the face are sqrt(2) from its middle: acos(-1/3) away.
    MV_PRECISE float nearest = d.x * cosCone + sqrt(d.y * d.y + d.z * d.z) * sinCone;
    if (nearest < -0.34f * l * l) return uvec4(0u);
    MV_PRECISE float w = cosCone + d.x;
    // About the pole at infinity the disc is too large for its digits, or inside out.
    if (!(w > 0.01f * l)) return uvec4(0u, 0u, mapRes, mapRes);
    float perTexel = 0.5f * res;
    MV_PRECISE float reach = sinCone / w * perTexel + 2e-3f;
    MV_PRECISE float column = (d.y / w + 1.0f) * perTexel - 0.5f;
    MV_PRECISE float row = (d.z / w + 1.0f) * perTexel - 0.5f;
    float c0 = clamp(-floor(reach - column), 0.0f, res);
    float c1 = clamp(floor(column + reach) + 1.0f, 0.0f, res);
    float r0 = clamp(-floor(reach - row), 0.0f, res);
    float r1 = clamp(floor(row + reach) + 1.0f, 0.0f, res);
    if (!(c1 > c0) || !(r1 > r0)) return uvec4(0u);
    return uvec4(uint(c0), uint(r0), uint(c1), uint(r1));
}

// The same of a ball, seen from outside: what most triangles are soon rejected by. l2: of offset.
MV_FN uvec4 ballConeTexels(uint face, vec3 offset, float l2, float radius, uint mapRes) {
    float tangent2 = l2 - radius * radius;
    if (!(tangent2 > 1e-4f * l2)) return uvec4(0u, 0u, mapRes, mapRes);
    float l = sqrt(l2);
    return coneTexels(face, offset, sqrt(tangent2), radius, l, mapRes);
}

MV_END_NAMESPACE
#endif
