// Exclusive prefix sum over any number of counts, by segments: each invocation owns
// MV_SUM_SEGMENT of them. MV_SUM_REDUCE: writes the segments' totals. Otherwise: writes the sums,
// starting from the segment's own prefix (or 0 when there is a single segment).
#include "shaders/shared/dispatch.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint count;
layout(binding = 0) uniform usamplerBuffer counts;
layout(std430, binding = 0) writeonly buffer Out { uint result[]; };
#ifndef MV_SUM_REDUCE
uniform bool hasBase;
layout(binding = 1) uniform usamplerBuffer bases;
#endif

void main() {
    uint segment = globalIndex();
    uint i = segment * uint(MV_SUM_SEGMENT);
    if (i >= count) return;
    uint end = min(count, i + uint(MV_SUM_SEGMENT));
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
