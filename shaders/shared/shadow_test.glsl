// Is a receiver lit, according to one texel of a view's omnidirectional depth map? The error of
// a map is the footprint of its texels, so that is what the bias follows.
#ifndef MV_SHADOW_TEST_GLSL
#define MV_SHADOW_TEST_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/map_verdict.glsl"
#include "shaders/shared/parametrisation.glsl"

MV_BEGIN_NAMESPACE

// Rules "published": a constant bias, root-cube units. The paper names none; 1 % of the root edge
// is also the clamp distance of the paper's presets.
MV_CONST float kConstantBias = 0.01f;

// Rules "corrected": the share of footprintBias that is used. With all of it no surface hides
// itself; with half, what leaks less outweighs what is hidden: up to 1.6 dB nearer to exact
// visibility in the scenes measured, at a lower relMSE in all (docs/results-earlier.md).
MV_CONST float kFootprintShare = 0.5f;

// Rules "corrected": the share of the distance that an occluder may be nearer without shadowing,
// times `bias`; with 1 a plane never hides itself.
// tanTheta: tangent of the angle between the receiver's normal and the way to the map's centre;
// a texel covers that much more depth on a slanted receiver.
MV_FN float footprintBias(float angle, float tanTheta, float bias) {
    return min(0.9f, bias * angle * (1.5f + 0.5f * min(tanTheta, 4.0f)));
}

// texel: of the map, in the direction of `offset`; kNone = empty, which hides nothing.
// offset: receiver - the map's centre. normal: of the receiver, unit. footprint: the corrected
// rules' bias, else the constant one; either times `bias`.
MV_FN bool isLit(uint texel, vec3 offset, vec3 normal, uint mapRes, bool footprint, float bias) {
    float d = length3(offset);
    if (texel == kNone || !(d > 1e-20f)) return true;
    float nearest = d - bias * kConstantBias;
    if (footprint) {
        float cosTheta = -dot3(offset, normal);
        float sinTheta = length3(cross3(offset, normal));
        float tanTheta = sinTheta < 4.0f * cosTheta ? sinTheta / cosTheta : 4.0f;
        float share = bias * kFootprintShare;
        nearest = d * (1.0f - footprintBias(texelAngle(offset, mapRes), tanTheta, share));
    }
    return uintBitsToFloat(texel) >= nearest;
}

// ---------------------------------------------------------------- what a map knows for certain

// Depths nearer than the plane by less than this part of a texel's angle are the plane's own:
// fusion and curvature. By a few times as much, and something stands before it.
MV_CONST float kPlaneSlack = 0.3f;
MV_CONST float kPlaneDoubt = 1.0f;
MV_CONST float kPlaneFlat = 0.1f;  // cosine

// What one texel says of a receiver, compared with the receiver's own plane along the ray through
// the texel's centre, at which its depth was stored: a plane then cannot hide itself, however
// coarse the map. Where the plane is seen too flat, or the ray meets it far from the receiver, only
// depths that are much nearer or farther say anything.
// ray: through the texel's centre, of that length. offset: receiver - the map's centre, of length
// d. plane: unit normal of the receiver's triangle. angle: that the texel covers.
MV_FN uint texelVerdict(uint texel, vec3 ray, float rayLength, vec3 offset, float d, vec3 plane,
                        float angle, float bias) {
    if (texel == kNone) return kVerdictLit;
    float z = uintBitsToFloat(texel);
    float facing = dot3(plane, ray);
    float along = dot3(plane, offset);
    float t = facing != 0.0f ? along * rayLength / facing : 0.0f;
    if (!(t > 0.0f)) t = 2.0f * d;
    bool met = abs(facing) > kPlaneFlat * rayLength && t >= 0.5f * d && t <= 2.0f * d;
    float lit = met ? t * (1.0f - bias * kPlaneSlack * angle) : 2.0f * d;
    float blocked = t * (1.0f - (kPlaneSlack + kPlaneDoubt) * angle);
    if (!met) blocked = min(blocked, 0.5f * d);
    if (z >= lit) return kVerdictLit;
    return z < blocked ? kVerdictBlocked : kVerdictUndecided;
}

MV_END_NAMESPACE
#endif
