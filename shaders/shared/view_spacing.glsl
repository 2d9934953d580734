// How far a view's light is spread: a virtual point light stands for the patch of surface between
// it and its neighbours, so nearer than about that patch's radius it must not grow brighter. The
// distance below which the gather clamps it follows from the nearest views that face alike, and
// from their flux: where all shine alike, pi r^2 is the view's share of their patch. With one
// distance for all views the dense ones lose light in corners and the sparse ones leave blobs.
#ifndef MV_VIEW_SPACING_GLSL
#define MV_VIEW_SPACING_GLSL
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/language.glsl"
#include "shaders/shared/types.glsl"

MV_BEGIN_NAMESPACE

// Neighbours are looked for among so many views before and after, in the order of the Morton curve:
// approximate, a neighbour across a cell's border may be missed, and the patch be taken too large.
MV_CONST uint kSpacingWindow = 16u;
// Times the patch's radius: nearer to one, views beside an edge leave blobs on the other wall.
MV_CONST float kClampSpread = 2.0f;
MV_CONST float kMaxClampDistance = 0.1f;  // root-cube units
// Lights without surface, such as particles, and views without neighbours take this.
MV_CONST float kPointClampDistance = 0.01f;

// The four nearest so far: squared distances, rising, and their power.
struct NearestViews {
    float d0, d1, d2, d3;
    float p0, p1, p2, p3;
};

MV_FN NearestViews noNearestViews() {
    NearestViews n;
    n.d0 = kInfinity;
    n.d1 = kInfinity;
    n.d2 = kInfinity;
    n.d3 = kInfinity;
    n.p0 = 0.0f;
    n.p1 = 0.0f;
    n.p2 = 0.0f;
    n.p3 = 0.0f;
    return n;
}

MV_FN NearestViews withView(NearestViews n, float distance2, float power) {
    if (distance2 >= n.d3) return n;
    n.d3 = distance2;
    n.p3 = power;
    if (n.d3 < n.d2) {
        float d = n.d2;
        float p = n.p2;
        n.d2 = n.d3;
        n.p2 = n.p3;
        n.d3 = d;
        n.p3 = p;
    }
    if (n.d2 < n.d1) {
        float d = n.d1;
        float p = n.p1;
        n.d1 = n.d2;
        n.p1 = n.p2;
        n.d2 = d;
        n.p2 = p;
    }
    if (n.d1 < n.d0) {
        float d = n.d0;
        float p = n.p0;
        n.d0 = n.d1;
        n.p0 = n.p1;
        n.d1 = d;
        n.p1 = p;
    }
    return n;
}

MV_FN float viewPower(View view) { return gatherPower(vec3(view.fluxR, view.fluxG, view.fluxB)); }

MV_FN NearestViews withNeighbour(NearestViews n, View view, View other) {
    vec3 a = vec3(view.normalX, view.normalY, view.normalZ);
    vec3 b = vec3(other.normalX, other.normalY, other.normalZ);
    MV_PRECISE float x = view.positionX - other.positionX;
    MV_PRECISE float y = view.positionY - other.positionY;
    MV_PRECISE float z = view.positionZ - other.positionZ;
    float distance2 = dot3(vec3(x, y, z), vec3(x, y, z));
    return dot3(a, b) > 0.5f ? withView(n, distance2, viewPower(other)) : n;
}

// Four neighbours say too little of a density where a few views happen to lie together: the patch
// of such a view would shine a thousand times too bright. No distance is less than a tenth of what
// it would be if all views shared the six faces of the root cube.
MV_FN float leastClampDistance(uint viewCount) {
    return min(0.1f * sqrt(6.0f / (kPi * float(max(viewCount, 1u)))), kMaxClampDistance);
}

// Root-cube units, below which a view of such power lights no brighter, by at least one neighbour.
// viewCount: of all of them.
MV_FN float clampDistanceAmong(NearestViews n, float own, uint viewCount) {
    // The circle through the farthest of them holds the others whole and that one by half.
    float reach2 = n.d0;
    float others = 0.5f * n.p0;
    if (n.d1 < kInfinity) {
        reach2 = n.d1;
        others = n.p0 + 0.5f * n.p1;
    }
    if (n.d2 < kInfinity) {
        reach2 = n.d2;
        others = n.p0 + n.p1 + 0.5f * n.p2;
    }
    if (n.d3 < kInfinity) {
        reach2 = n.d3;
        others = n.p0 + n.p1 + n.p2 + 0.5f * n.p3;
    }
    MV_PRECISE float c2 = reach2 * (own / max(own + others, 1e-30f));
    MV_PRECISE float c = sqrt(c2);
    return clamp(kClampSpread * c, leastClampDistance(viewCount), kMaxClampDistance);
}

MV_FN float clampDistanceOf(View view, NearestViews n, uint viewCount) {
    if (n.d0 < kInfinity) return clampDistanceAmong(n, viewPower(view), viewCount);
    return view.flags == kViewOmnidirectional ? kPointClampDistance : kMaxClampDistance;
}

MV_END_NAMESPACE
#endif
