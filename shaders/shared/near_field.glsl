// What the clamp takes away, given back: the light of surfaces nearer than the views on them are to
// each other. A ray of the cosine distribution meets such a surface at distance r; each view that
// faces alike has spread its flux over a disc there, and 1 - r^2 / c^2 of the light of a view that
// is clamped at c has been taken. So corners keep their light without the blobs of views that stand
// too near [KK04, bias compensation]. Discs reach through walls into darker rooms: a view counts
// only if nothing stands between the middle of the ray and the place as high above the view; what
// of a disc lies behind a wall is lost. A surface that glows gives what it emits, and nothing for
// what it reflects. Approximate: the brightness of a place is that of a few
// views around it, so a crack beside a patch of sun would shine: nothing is given beyond a multiple
// of what was gathered; and only rays up to a reach count.
#ifndef MV_NEAR_FIELD_GLSL
#define MV_NEAR_FIELD_GLSL
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/language.glsl"
#include "shaders/shared/sampling.glsl"
#include "shaders/shared/types.glsl"
#include "shaders/shared/view_spacing.glsl"

MV_BEGIN_NAMESPACE

MV_CONST float kNearFieldReach = kMaxClampDistance;
MV_CONST uint kNearFieldWindow = 48u;  // views looked at before and after a place
// Radius of a view's disc in clamp distances: it overlaps those of about nine others.
MV_CONST float kNearFieldSpread = 2.0f;
MV_CONST float kNearFieldMost = 8.0f;  // times what was gathered
MV_CONST uint kNearFieldDraw = 19u;    // `dimension` of random4

// The direction of a pixel's n-th ray. The 16 pixels of a block share out the heights, and so do 16
// rays of a pixel, those of any power of two evenly.
MV_FN vec3 nearFieldDirection(vec3 normal, uint seed, uint x, uint y, uint n) {
    vec4 r = random4(seed, y << 16u | x, n, kNearFieldDraw);
    uint turn = (n & 1u) << 3u | (n & 2u) << 1u | (n & 4u) >> 1u | (n & 8u) >> 3u;
    float height = (float((blockRank(x & 3u, y & 3u) + turn) & 15u) + r.x) / 16.0f;
    return cosineDirection(normal, min(height, 0.99999994f), r.y);
}

// The number in [0, 1) by which that ray chooses among the views at the place that it meets.
MV_FN float nearFieldNumber(uint seed, uint x, uint y, uint n) {
    return random4(seed, y << 16u | x, n, kNearFieldDraw).z;
}

// What the clamp at `clampDistance` has taken of a view's light from a receiver, by a place at
// distance r from the receiver and sqrt(distance2) from the view: per W of its flux,
// 1/root-cube unit^2. The views of all places together give what they have.
MV_FN float nearFieldShare(float clampDistance, float r, float distance2, vec3 viewNormal,
                           vec3 placeNormal) {
    float c2 = clampDistance * clampDistance;
    float spread2 = kNearFieldSpread * kNearFieldSpread * c2;
    if (distance2 >= spread2 || dot3(viewNormal, placeNormal) <= 0.5f) return 0.0f;
    return max(0.0f, 1.0f - r * r / c2) / (kPi * spread2);
}

// The same where the place glows itself: all of its radiance, W/(m^2 sr), is known, so that no view
// is asked but for its clamp distance. W/m^2.
MV_FN vec3 nearFieldEmitted(vec3 emission, float clampDistance, float r) {
    return emission * (kPi * max(0.0f, 1.0f - r * r / (clampDistance * clampDistance)));
}

// How much of what near places give is added to a receiver that has gathered so much.
MV_FN vec3 nearFieldAdded(vec3 given, vec3 gathered) {
    float power = gatherPower(given);
    float most = kNearFieldMost * gatherPower(gathered);
    return power > most ? given * (most / power) : given;
}

MV_END_NAMESPACE
#endif
