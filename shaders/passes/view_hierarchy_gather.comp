// Writes views and keys in sorted order.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/types.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint count;
layout(binding = kUnitSortPairs) uniform usamplerBuffer pairs;   // RG32UI: key, slot; sorted
layout(binding = kUnitViews) uniform usamplerBuffer viewTexels;  // View, 3 texels each
layout(std430, binding = kBlockSortedViews) writeonly buffer SortedViews { uvec4 sortedViews[]; };
layout(std430, binding = kBlockViewKeys) writeonly buffer Keys { uint keys[]; };

void main() {
    uint i = globalIndex();
    if (i >= count) return;
    uvec2 pair = texelFetch(pairs, int(i)).xy;
    keys[i] = pair.x;
    for (uint k = 0u; k < 3u; ++k)
        sortedViews[3u * i + k] = texelFetch(viewTexels, int(3u * pair.y + k));
}
