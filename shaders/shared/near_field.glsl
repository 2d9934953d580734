// What the clamp takes away, given back: the light of surfaces nearer than the views on them are to
// each other. A ray of the cosine distribution meets such a surface at distance r; the nearest view
// there that faces alike says how brightly it shines, its flux over the patch pi c^2 that it stands
// for (view_spacing.glsl), and 1 - r^2 / c^2 of that light is what the clamp at c has taken. So
// corners keep their light without the blobs of views that stand too near [KK04, bias
// compensation]. Approximate: the brightness is that of the nearest view's patch, and only rays up
// to a reach count.
#ifndef MV_NEAR_FIELD_GLSL
#define MV_NEAR_FIELD_GLSL
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/language.glsl"
#include "shaders/shared/sampling.glsl"
#include "shaders/shared/types.glsl"
#include "shaders/shared/view_spacing.glsl"

MV_BEGIN_NAMESPACE

MV_CONST float kNearFieldReach = 0.08f;  // root-cube units
MV_CONST uint kNearFieldWindow = 12u;    // views looked at before and after a place
MV_CONST uint kNearFieldDraw = 19u;      // `dimension` of random4

// The direction of a pixel's n-th ray. The 16 pixels of a block share out the heights.
MV_FN vec3 nearFieldDirection(vec3 normal, uint seed, uint x, uint y, uint n) {
    vec4 r = random4(seed, y << 16u | x, n, kNearFieldDraw);
    float height = (float(blockRank(x & 3u, y & 3u)) + r.x) / 16.0f;
    return cosineDirection(normal, min(height, 0.99999994f), r.y);
}

// Nearest so far of the views around a place that face as its surface does.
struct NearView {
    uint view;  // kNone: none
    float distance2;
};
MV_FN NearView nearerView(NearView nearest, uint i, vec3 viewPosition, vec3 viewNormal, vec3 place,
                          vec3 normal) {
    vec3 way = viewPosition - place;
    float distance2 = dot3(way, way);
    if (dot3(viewNormal, normal) > 0.5f && distance2 < nearest.distance2) {
        nearest.view = i;
        nearest.distance2 = distance2;
    }
    return nearest;
}

// The part of a patch's brightness that the clamp has taken from a receiver `r` away, per W of its
// view's flux, 1/root-cube unit^2. distance2: from the place to that view; far outside its patch
// nobody knows.
MV_FN float nearFieldShare(float clampDistance, float r, float distance2) {
    float c2 = clampDistance * clampDistance;
    if (distance2 > c2) return 0.0f;
    return max(0.0f, 1.0f - r * r / c2) / (kPi * c2);
}

MV_END_NAMESPACE
#endif
