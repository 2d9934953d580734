// Writes (Morton key, slot) of every view; dead ones get a key that sorts last.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/morton.glsl"
#include "shaders/shared/types.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint count;
layout(binding = kUnitViews) uniform usamplerBuffer viewTexels;  // View, 3 texels each
layout(std430, binding = kBlockSortPairs) writeonly buffer Pairs { uvec2 pairs[]; };

void main() {
    uint i = globalIndex();
    if (i >= count) return;
    uvec4 head = texelFetch(viewTexels, int(3u * i));
    uint key = head.w == kViewDead ? kMortonDead : mortonKeyOf(uintBitsToFloat(head.xyz));
    pairs[i] = uvec2(key, i);
}
