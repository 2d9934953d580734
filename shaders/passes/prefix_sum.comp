// Exclusive prefix sum over any number of counts, by segments: each invocation owns
// kSumSegment of them. MV_SUM_REDUCE: writes the segments' totals. Otherwise: writes the sums,
// starting from the segment's own prefix (or 0 when there is a single segment).
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/sort.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint count;
layout(binding = kUnitCounts) uniform usamplerBuffer counts;
layout(std430, binding = kBlockSums) writeonly buffer Out { uint result[]; };
#ifndef MV_SUM_REDUCE
uniform bool hasBase;
layout(binding = kUnitSumBases) uniform usamplerBuffer bases;
#endif

void main() {
    uint segment = globalIndex();
    uint i = segment * kSumSegment;
    if (i >= count) return;
    uint end = min(count, i + kSumSegment);
#ifdef MV_SUM_REDUCE
    uint total = 0u;
    do total += texelFetch(counts, int(i)).x;
    while (++i < end);
    result[segment] = total;
#else
    uint running = hasBase ? texelFetch(bases, int(segment)).x : 0u;
    do {
        result[i] = running;
        running += texelFetch(counts, int(i)).x;
    } while (++i < end);
#endif
}
