// Candidates -> views: which of them stay, by what they give the surfaces in sight
// (shaders/shared/importance.glsl). Sums run in a fixed order: blocks, lanes, one group.
// MV_STAGE 0: importance of each candidate. 1: sums of each block. 2: totals. 3: parts of each
// block by the scale so far. 4: the next scale. 5: candidates that are not kept become dead.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/importance.glsl"
#include "shaders/shared/morton.glsl"

#if MV_STAGE == 2 || MV_STAGE == 4
layout(local_size_x = kImportanceLanes) in;
#else
layout(local_size_x = MV_WORKGROUP_SIZE) in;
#endif

layout(binding = kUnitImportancePoints) uniform samplerBuffer points;  // ImportancePoint
layout(std430, binding = kBlockViews) buffer ViewBlock { View views[]; };
layout(std430, binding = kBlockImportance) buffer Importance { float importance[]; };
layout(std430, binding = kBlockImportanceSums) buffer Sums { vec4 sums[]; };
layout(std430, binding = kBlockImportancePlaces) readonly buffer Places {
    ImportancePlace places[];
};
layout(std430, binding = kBlockImportanceTotals) buffer Totals { ImportanceTotals totals; };

uniform uint count;
uniform uint blocks;
uniform uint pointCount;
uniform uint placeCount;
uniform float distance;
uniform float wanted;
uniform uint seed;

#if MV_STAGE == 0
float visibleShareAt(View view) {
    uint key = mortonKeyOf(viewPosition(view));
    uint low = 0u;
    uint high = placeCount;
    MV_FIND_FIRST(low, high, middle, places[middle].key >= key);
    ImportanceVisible around = ImportanceVisible(0.0, 0.0);
    uint end = min(low + kImportanceWindow, placeCount);
    for (uint i = max(low, kImportanceWindow) - kImportanceWindow; i < end; ++i)
        around = withPlace(around, view, places[i], distance);
    return visibleShare(around);
}

void main() {
    uint i = globalIndex();
    if (i >= count) return;
    View view = views[i];
    precise float sum = 0.0;
    if (view.flags != kViewDead) {
        for (uint p = 0u; p < pointCount; ++p) {
            vec4 a = texelFetch(points, int(2u * p));
            vec4 b = texelFetch(points, int(2u * p + 1u));
            ImportancePoint point = ImportancePoint(a.x, a.y, a.z, 0u, b.x, b.y, b.z, 0u);
            sum += importanceTerm(view, point, distance);
        }
    }
    precise float mean = pointCount > 0u ? sum / float(pointCount) : 0.0;
    precise float unoccluded = viewLuminance(view) * mean;
    precise float product = unoccluded * visibleShareAt(view);
    importance[i] = product;
}
#elif MV_STAGE == 1 || MV_STAGE == 3
void main() {
    uint block = globalIndex();
    if (block >= blocks) return;
    uint begin = block * kImportanceBlock;
    uint end = min(begin + kImportanceBlock, count);
    precise vec3 sum = vec3(0.0);
    for (uint i = begin; i < end; ++i) {
        float flux = viewLuminance(views[i]);
#if MV_STAGE == 1
        sum += vec3(importance[i], flux, views[i].flags != kViewDead ? 1.0 : 0.0);
#else
        float weight = candidateWeight(importance[i], flux, totals);
        bool certain = totals.scale * weight >= 1.0;
        sum += vec3(certain ? 1.0 : 0.0, certain ? 0.0 : weight, 0.0);
#endif
    }
    sums[block] = vec4(sum, 0.0);
}
#elif MV_STAGE == 2 || MV_STAGE == 4
shared vec3 ofLane[kImportanceLanes];

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint perLane = (blocks + kImportanceLanes - 1u) / kImportanceLanes;
    uint end = min((lane + 1u) * perLane, blocks);
    precise vec3 sum = vec3(0.0);
    for (uint block = lane * perLane; block < end; ++block) sum += sums[block].xyz;
    ofLane[lane] = sum;
    barrier();
    if (lane > 0u) return;
    precise vec3 all = vec3(0.0);
    for (uint i = 0u; i < kImportanceLanes; ++i) all += ofLane[i];
#if MV_STAGE == 2
    totals = ImportanceTotals(all.x, all.y, all.z, all.z <= wanted ? kInfinity : wanted);
#else
    totals.scale = nextScale(wanted, all.x, all.y, totals.scale);
#endif
}
#else
void main() {
    uint i = globalIndex();
    if (i >= count) return;
    View view = views[i];
    float p = keepProbability(candidateWeight(importance[i], viewLuminance(view), totals), totals);
    bool keep = view.flags != kViewDead && keepsCandidate(seed, i, view.bounce, p);
    view.fluxR /= p;
    view.fluxG /= p;
    view.fluxB /= p;
    View dead = View(0.0, 0.0, 0.0, kViewDead, 0.0, 0.0, 0.0, 0u, 0.0, 0.0, 0.0, 0u);
    if (keep)
        views[i] = view;
    else
        views[i] = dead;
}
#endif
