// Sorted views -> the distance below which each of them lights no brighter, behind them the least
// of any. SPREAD: that alone, before.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/view_spacing.glsl"

#ifdef SPREAD
layout(local_size_x = int(kSpreadPairs)) in;
#else
layout(local_size_x = MV_WORKGROUP_SIZE) in;
#endif

layout(std430, binding = kBlockClampDistances) buffer Clamps { float distances[]; };

uniform uint viewCount;
uniform float fixedDistance;  // of all views; below 0: of each by its neighbours

#ifdef SPREAD
shared float distances2[kSpreadPairs];

void main() {
    uint lane = gl_LocalInvocationID.x;
    float own = spreadDistance2(viewPosition(spreadView(lane, viewCount)),
                                viewPosition(spreadView(lane + kSpreadPairs, viewCount)));
    distances2[lane] = own;
    barrier();
    uint below = 0u;
    for (uint i = 0u; i < kSpreadPairs; ++i) {
        float other = distances2[i];
        if (other < own || (other == own && i < lane)) ++below;
    }
    if (below == kSpreadPairs / 2u) distances[viewCount] = leastClampDistance(own, viewCount);
}
#else
View fetchView(uint i) {
    vec3 p = viewPosition(i);
    vec3 n = viewNormal(i);
    vec3 f = viewFlux(i);
    return View(p.x, p.y, p.z, viewFlags(i), n.x, n.y, n.z, 0u, f.x, f.y, f.z, 0u);
}

void main() {
    uint view = globalIndex();
    if (view >= viewCount) return;
    if (fixedDistance >= 0.0) {
        distances[view] = fixedDistance;
        return;
    }
    View own = fetchView(view);
    NearestViews nearest = noNearestViews();
    uint end = min(view + kSpacingWindow + 1u, viewCount);
    for (uint i = max(view, kSpacingWindow) - kSpacingWindow; i < end; ++i) {
        if (i != view) nearest = withNeighbour(nearest, own, fetchView(i));
    }
    distances[view] = clampDistanceOf(own, nearest, distances[viewCount]);
}
#endif
