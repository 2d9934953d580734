// Keeps those of a sort's views that have maps, in its order. What is left over is dead.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/map_borrowing.glsl"
#include "shaders/shared/types.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint most;
layout(binding = kUnitSortPairs) uniform usamplerBuffer pairs;  // RG32UI: key, slot; sorted
layout(binding = kUnitSortAlive) uniform usamplerBuffer alive;
layout(binding = kUnitViews) uniform usamplerBuffer viewTexels;  // View, 3 texels each
layout(std430, binding = kBlockViews) writeonly buffer Views { uvec4 views[]; };

void main() {
    uint run = globalIndex();
    if (run >= most) return;
    uint all = texelFetch(alive, 0).x;
    uint maps = mapsOfViews(all, most);
    if (run >= maps) {
        views[3u * run] = uvec4(0u, 0u, 0u, kViewDead);
        return;
    }
    uint slot = texelFetch(pairs, int(viewWithMap(run, runLength(all, maps)))).y;
    for (uint k = 0u; k < 3u; ++k) views[3u * run + k] = texelFetch(viewTexels, int(3u * slot + k));
}
