// Sorted views -> the distance below which each of them lights no brighter, and behind these the
// least of any. MV_SPREAD: the least alone, which has to be there before.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/view_spacing.glsl"

#ifdef MV_SPREAD
layout(local_size_x = int(kSpreadPairs)) in;
#else
layout(local_size_x = MV_WORKGROUP_SIZE) in;
#endif

layout(std430, binding = kBlockClampDistances) buffer Clamps { float distances[]; };

layout(binding = kUnitViewKeys) uniform usamplerBuffer viewKeys;

uniform uint viewCount;
uniform float fixedDistance;  // of all views; below 0: of each by its neighbours

#ifdef MV_SPREAD
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

uint keyOf(uint view) { return texelFetch(viewKeys, int(view)).x; }

// Views begin .. end are all that a view looks at.
Crowd crowdAt(uint view, uint begin, uint end) {
    uint key = keyOf(view);
    bool crowded = keyOf(begin) == key && keyOf(end - 1u) == key;
    uint first = 0u;
    uint last = crowded ? begin : 0u;
    MV_FIND_FIRST(first, last, middle, keyOf(middle) >= key);
    uint low = end;
    uint high = crowded ? viewCount : end;
    MV_FIND_FIRST(low, high, middle, keyOf(middle) > key);
    return crowdOf(end - begin, crowded ? low - first : 0u, distances[viewCount]);
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
    uint begin = max(view, kSpacingWindow) - kSpacingWindow;
    uint end = min(view + kSpacingWindow + 1u, viewCount);
    for (uint i = begin; i < end; ++i) {
        if (i != view) nearest = withNeighbour(nearest, own, fetchView(i));
    }
    distances[view] = clampDistanceOf(own, nearest, crowdAt(view, begin, end));
}
#endif
