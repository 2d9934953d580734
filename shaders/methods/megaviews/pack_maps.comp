// The maps that a pass has finished, packed to 16 bits a texel.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/map_store.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(std430, binding = kBlockMaps) restrict readonly buffer MapBlock { uvec2 texelPairs[]; };
layout(std430, binding = kBlockPackedMaps) restrict writeonly buffer PackedBlock {
    uint packed_[];
};

uniform uint wordCount;  // of the packed maps

void main() {
    uint word = globalIndex();
    if (word >= wordCount) return;
    uvec2 texels = texelPairs[word];
    packed_[word] = packTexel(texels.x) | packTexel(texels.y) << 16u;
}
