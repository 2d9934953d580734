// Lists the old nodes whose chain has to be tested since its clearance has run out, so that every
// lane of the test that follows has one.
#include "shaders/methods/manylods/cut_fetch.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/traversal_data.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(std430, binding = kBlockStatus) restrict buffer StatusBuffer { uint status[]; };
layout(std430, binding = kBlockCutChains) restrict writeonly buffer ChainBuffer { uint chains[]; };

uniform uint cutCapacity;

shared uint sharedExpired;
shared uint sharedFirst;

void main() {
    uint lane = gl_LocalInvocationID.x;
    if (lane == 0u) sharedExpired = 0u;
    groupBarrier();
    uint index = globalIndex();
    bool expired = false;
    if (index < min(status[kStatusOldCutNodes], cutCapacity)) {
        CutEntry e = fetchCutEntry(index);
        CutStep step = fetchStep(e.slot);
        expired = goesOn(step) && clearanceLeft(e.node.above, step.displacement) < 0.0f;
    }
    uint at = expired ? atomicAdd(sharedExpired, 1u) : 0u;
    groupBarrier();
    if (lane == 0u && sharedExpired != 0u) {
        sharedFirst = atomicAdd(status[kStatusCutChains], sharedExpired);
    }
    groupBarrier();
    if (expired) chains[sharedFirst + at] = index;
}
