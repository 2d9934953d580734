// Where a search of a receiver's runs may begin and end: one invocation for each of kRunSearchSlots
// equal ranges of its units finds the runs at both ends.
#include "shaders/passes/last_at_most.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/gather_sampling.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitReceiverLists) uniform usamplerBuffer lists;  // GatherList
layout(binding = kUnitRunWords) uniform usamplerBuffer runUnits;    // runs, word by word
layout(std430, binding = kBlockRunSearch) writeonly buffer RunSearch { uint table[]; };

uniform uint receiverCount;
uniform uint capacity;

uint lastRun(uint firstRun, uint runCount, uint unit) {
    return lastAtMost(runUnits, firstRun, firstRun + runCount, 4u, unit) - firstRun;
}

void main() {
    uint index = globalIndex();
    if (index >= receiverCount * kRunSearchSlots) return;
    uint receiver = index / kRunSearchSlots;
    uint slot = index % kRunSearchSlots;
    uvec4 list = texelFetch(lists, int(receiver));
    uint shift = runSearchShift(list.y);
    uint lo = lastRun(receiver * capacity, list.x, slot << shift);
    uint hi = lastRun(receiver * capacity, list.x, ((slot + 1u) << shift) - 1u);
    table[index] = lo | (hi + 1u) << 16u;
}
