// Imperfect shadow maps [RGK08]: each view draws its own few of the scene's points, splats them
// into its map, and fills the holes by pull-push. One texel at a time, for both processors.
#ifndef MV_ISM_GLSL
#define MV_ISM_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/parametrisation.glsl"
#include "shaders/shared/random.glsl"
#include "shaders/shared/types.glsl"

MV_BEGIN_NAMESPACE

// A point of the scene's surface, 16 bytes.
struct SurfacePoint {
    float x, y, z;  // root-cube units
    uint present;   // 0: the alpha mask cuts it out
};

// Texels from the middle of a splat to its edge, at most. Points next to a view would cover it.
MV_CONST float kIsmReach = 2.0f;
// Depths of one surface differ by less than this share of the root edge from one texel to the
// next, twice as much on each coarser level.
MV_CONST float kIsmSameSurface = 0.05f;

// The k-th point of a view: one at random of the k-th `stratum` points of the surface.
MV_FN uint ismPoint(uint slot, uint k, uint stratum, uint seed) {
    return k * stratum + pcg4d(uvec4(seed, slot, k, 0x15A0u)).x % stratum;
}

// Is the point splatted at all? l: length of offset. What stands where the view stands has no
// direction; a view that lights half a space sees nothing behind it.
MV_FN bool ismSees(uint present, uint viewFlags, vec3 viewNormal, vec3 offset, float l) {
    return present != 0u && l > 1e-6f &&
           (viewFlags == kViewOmnidirectional || dot3(viewNormal, offset) > 0.0f);
}

// ---------------------------------------------------------------- pull and push
// Depths as ordered bits, kNone = empty.

// The mean of those of four finer texels that belong to the nearest one's surface. level: of the
// coarser texel, 1 = half the resolution.
MV_FN uint ismPull(uvec4 finer, uint level) {
    uint nearest = min(min(finer.x, finer.y), min(finer.z, finer.w));
    if (nearest == kNone) return kNone;
    MV_PRECISE float limit = uintBitsToFloat(nearest) + kIsmSameSurface * float(1u << (level - 1u));
    MV_PRECISE float sum = 0.0f;
    MV_PRECISE float count = 0.0f;
    for (int i = 0; i < 4; ++i) {
        float z = uintBitsToFloat(finer[i]);
        if (finer[i] != kNone && z <= limit) {
            sum += z;
            count += 1.0f;
        }
    }
    MV_PRECISE float mean = sum / count;
    return floatBitsToUint(mean);
}

// What a hole becomes under its four nearest coarser texels: x the one that covers it, y and z
// those beside it, w the one across. Interpolates between those of one surface; what was splatted
// stays. level: of the finer one.
MV_FN uint ismPush(uint finer, uvec4 coarser, uint level) {
    if (finer != kNone) return finer;
    uint base = coarser.x;
    if (base == kNone) base = min(min(coarser.y, coarser.z), coarser.w);
    if (base == kNone) return finer;
    MV_PRECISE float same = kIsmSameSurface * float(1u << level);
    float z = uintBitsToFloat(base);
    MV_PRECISE float sum = 0.0f;
    MV_PRECISE float weight = 0.0f;
    for (int i = 0; i < 4; ++i) {
        float near = uintBitsToFloat(coarser[i]);
        float share = i == 0 ? 9.0f : (i == 3 ? 1.0f : 3.0f);
        if (coarser[i] != kNone && (i == 0 || abs(near - z) <= same)) {
            sum += share * near;
            weight += share;
        }
    }
    MV_PRECISE float filled = sum / weight;
    return floatBitsToUint(filled);
}

// The neighbours that ismPush takes, as columns (or rows) of the coarser level: the own one, and
// the one on the nearer side, clamped to the face.
MV_FN uvec2 ismNeighbours(uint fine, uint coarseRes) {
    uint own = fine / 2u;
    uint beside = own;
    if ((fine & 1u) == 0u) {
        if (own > 0u) beside = own - 1u;
    } else if (own + 1u < coarseRes) {
        beside = own + 1u;
    }
    return uvec2(own, beside);
}

MV_END_NAMESPACE

#ifdef __cplusplus
static_assert(sizeof(mv::SurfacePoint) == 16);
#endif
#endif
