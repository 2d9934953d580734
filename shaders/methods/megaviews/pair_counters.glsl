// Pair counters of a dispatch: summed in shared memory, then added to 64-bit sums (see
// traversal_data.glsl). OpenGL 4.5 has no 64-bit atomics: the low word's addition tells the carry.
// MV_COUNT 1: all pairs together, in registers until the group ends. 2: by the scene node's level.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/pair.glsl"
#include "shaders/shared/traversal_data.glsl"
#include "shaders/shared/types.glsl"

#if MV_COUNT == 2
const uint kCounterLevels = kSceneLevels;
#else
const uint kCounterLevels = 1u;
#endif

layout(std430, binding = kBlockPairCounters) restrict buffer CounterBuffer { uint counterWords[]; };

const uint kSharedCounts = kPairCounters * kCounterLevels;
shared uint sharedCounts[kSharedCounts];

uint laneCulled = 0u;
uint laneRendered = 0u;
uint laneForced = 0u;
uint laneSubdivided = 0u;
uint laneSkipped = 0u;

// Pairs of kPairInside count once it is known what they are.
void countPair(uint decision, uint level) {
#if MV_COUNT == 2
    uint counter = decision == kPairCulled                                     ? kCountCulled
                   : pairRendered(decision)                                    ? kCountRendered
                   : decision == kPairSplitScene || decision == kPairSplitView ? kCountSubdivided
                                                                               : kCountSkipped;
    uint first = level * kPairCounters;
    bool known = decision != kPairNone && decision != kPairInside;
    if (known) atomicAdd(sharedCounts[first + counter], 1u);
    if (decision == kPairForced) atomicAdd(sharedCounts[first + kCountForced], 1u);
#else
    laneCulled += uint(decision == kPairCulled);
    laneRendered += uint(pairRendered(decision));
    laneForced += uint(decision == kPairForced);
    laneSubdivided += uint(decision == kPairSplitScene || decision == kPairSplitView);
    laneSkipped += uint(decision == kPairSkipped);
#endif
}

void add64(uint slot, uint level, uint counter, uint low, uint high) {
    uint word = (slot * kCounterLevels + level) * kCounterWords + counter * 2u;
    uint carry = high;
    if (low != 0u) {
        uint before = atomicAdd(counterWords[word], low);
        carry += uint(before > 0xFFFFFFFFu - low);
    }
    if (carry != 0u) atomicAdd(counterWords[word + 1u], carry);
}

// Every lane of the group calls this before the first countPair, with a barrier between.
void clearCounts() {
    for (uint i = gl_LocalInvocationID.x; i < kSharedCounts; i += uint(MV_WORKGROUP_SIZE)) {
        sharedCounts[i] = 0u;
    }
}
// Every lane calls this; a barrier follows, then storeCounts.
void sumCounts() {
#if MV_COUNT != 2
    if (laneCulled != 0u) atomicAdd(sharedCounts[kCountCulled], laneCulled);
    if (laneRendered != 0u) atomicAdd(sharedCounts[kCountRendered], laneRendered);
    if (laneForced != 0u) atomicAdd(sharedCounts[kCountForced], laneForced);
    if (laneSubdivided != 0u) atomicAdd(sharedCounts[kCountSubdivided], laneSubdivided);
    if (laneSkipped != 0u) atomicAdd(sharedCounts[kCountSkipped], laneSkipped);
#endif
}
void storeCounts() {
    uint slot = groupIndex() % kCounterSlots;
    for (uint i = gl_LocalInvocationID.x; i < kSharedCounts; i += uint(MV_WORKGROUP_SIZE)) {
        add64(slot, i / kPairCounters, i % kPairCounters, sharedCounts[i], 0u);
    }
}
