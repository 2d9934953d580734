// Sorted views, and those of them that have maps -> whose map each view takes.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/map_borrowing.glsl"
#include "shaders/shared/types.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint viewCount;
uniform uint maps;
layout(binding = kUnitSortedViews) uniform usamplerBuffer sortedViews;  // View, 3 texels each
layout(binding = kUnitViews) uniform usamplerBuffer mapViews;           // the same, with maps
layout(std430, binding = kBlockPlaces) writeonly buffer Places { uint places[]; };

void main() {
    uint view = globalIndex();
    if (view >= viewCount) return;
    vec3 position = uintBitsToFloat(texelFetch(sortedViews, int(3u * view)).xyz);
    vec3 normal = uintBitsToFloat(texelFetch(sortedViews, int(3u * view + 1u)).xyz);
    uint run = runOfView(view, runLength(viewCount, maps), maps);
    uint end = min(run + kMapRuns + 1u, maps);
    uint best = run;
    float least = 1e30;
    for (uint other = max(run, kMapRuns) - kMapRuns; other < end; ++other) {
        vec3 way = uintBitsToFloat(texelFetch(mapViews, int(3u * other)).xyz) - position;
        vec3 facing = uintBitsToFloat(texelFetch(mapViews, int(3u * other + 1u)).xyz);
        float far = mapDistance(way, normal, facing);
        if (far < least) {
            least = far;
            best = other;
        }
    }
    places[view] = best;
}
