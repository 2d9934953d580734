// Pair counters of a dispatch: summed in shared memory, then added to 64-bit sums. OpenGL 4.5 has
// no 64-bit atomics: the low word's addition tells the carry. Groups spread over kCounterSlots
// sums, which the CPU adds up (renderer/passes/pair_counters.h).
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/pair.glsl"

const uint kCounterSlots = 64u;
const uint kCounterWords = 16u;  // culled, rendered, forced, subdivided, skipped, rendered views

layout(std430, binding = 0) restrict buffer CounterBuffer { uint counterWords[]; };

shared uint sharedCounts[5];

uint laneCulled = 0u;
uint laneRendered = 0u;
uint laneForced = 0u;
uint laneSubdivided = 0u;
uint laneSkipped = 0u;

void countPair(uint decision) {
    laneCulled += uint(decision == kPairCulled);
    laneRendered += uint(decision == kPairRendered || decision == kPairForced);
    laneForced += uint(decision == kPairForced);
    laneSubdivided += uint(decision == kPairSplitScene || decision == kPairSplitView);
    laneSkipped += uint(decision == kPairSkipped);
}

void add64(uint slot, uint counter, uint low, uint high) {
    uint word = slot * kCounterWords + counter * 2u;
    uint carry = high;
    if (low != 0u) {
        uint before = atomicAdd(counterWords[word], low);
        carry += uint(before > 0xFFFFFFFFu - low);
    }
    if (carry != 0u) atomicAdd(counterWords[word + 1u], carry);
}

// By every lane of the group before the first sumCounts, with a barrier between.
void clearCounts() {
    for (uint i = gl_LocalInvocationID.x; i < 5u; i += uint(MV_WORKGROUP_SIZE)) {
        sharedCounts[i] = 0u;
    }
}
// By every lane; then a barrier; then storeCounts.
void sumCounts() {
    if (laneCulled != 0u) atomicAdd(sharedCounts[0], laneCulled);
    if (laneRendered != 0u) atomicAdd(sharedCounts[1], laneRendered);
    if (laneForced != 0u) atomicAdd(sharedCounts[2], laneForced);
    if (laneSubdivided != 0u) atomicAdd(sharedCounts[3], laneSubdivided);
    if (laneSkipped != 0u) atomicAdd(sharedCounts[4], laneSkipped);
}
void storeCounts() {
    uint slot = groupIndex() % kCounterSlots;
    for (uint i = gl_LocalInvocationID.x; i < 5u; i += uint(MV_WORKGROUP_SIZE)) {
        add64(slot, i, sharedCounts[i], 0u);
    }
}
