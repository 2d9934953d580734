// Receivers in use -> their numbers, by node and cone: counted, summed up before each node by a
// prefix sum, then placed. Number 0 holds everything.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/gather.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitConesInUse) uniform usamplerBuffer used;  // cones in use, 2 words a node
layout(binding = kUnitReceiverBegins) uniform usamplerBuffer begins;
layout(std430, binding = kBlockReceiverCounts) writeonly buffer Counts {
    uint counts[];
};  // or first receivers
layout(std430, binding = kBlockReceiverKeys) writeonly buffer Keys {
    uint keys[];
};  // kNone where nothing is

uniform uint nodeCount;
uniform uint keyCapacity;

#if PLACE
void place(uint node, uint word, uint bits, inout uint number) {
    for (; bits != 0u; bits &= bits - 1u) {
        if (number < keyCapacity)
            keys[number] = node * kReceiverCones + word * 32u + uint(findLSB(bits));
        ++number;
    }
}
#endif

void main() {
    uint node = globalIndex();
#if PLACE
    if (node >= nodeCount) return;
    uvec2 bits = texelFetch(used, int(node)).xy;
    uint number = 1u + texelFetch(begins, int(node)).x;
    counts[node] = number;
    place(node, 0u, bits.x, number);
    place(node, 1u, bits.y, number);
#else
    if (node > nodeCount) return;  // one more, for the total
    uvec2 bits = uvec2(0u);
    if (node < nodeCount) bits = texelFetch(used, int(node)).xy;
    counts[node] = uint(bitCount(bits.x) + bitCount(bits.y));
#endif
}
