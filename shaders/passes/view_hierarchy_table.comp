// Writes what the CPU reads back: the first node of each level, the number of nodes, of leaves, of
// views.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint chunks;
uniform uint levelCount;
layout(binding = kUnitNodeBegins) uniform usamplerBuffer begins;
layout(binding = kUnitSortAlive) uniform usamplerBuffer aliveTexels;
layout(std430, binding = kBlockLevelTable) writeonly buffer Table { uint table[]; };

void main() {
    uint l = globalIndex();
    if (l > levelCount + 2u) return;
    uint nodes = texelFetch(begins, int(levelCount * chunks)).x;
    uint value = l <= levelCount ? texelFetch(begins, int(l * chunks)).x
                 : l == levelCount + 1u
                     ? texelFetch(begins, int((levelCount + 1u) * chunks)).x - nodes
                     : texelFetch(aliveTexels, 0).x;
    table[l] = value;
}
