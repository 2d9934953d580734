// Sorted views -> power units before each view. One invocation sums a block
// (kPowerBlock) of views in order; blocks are summed by one work group, in order too.
// MV_STAGE 0: power of each block. 1: total power. 2: units of each block. 3: units before each
// block. 4: units before each view.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/gather_sampling.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(std430, binding = kBlockBlockPower) buffer BlockPower {
    float blockPower[];
};  // last: the total
layout(std430, binding = kBlockBlockUnits) buffer BlockUnits { uint blockUnits[]; };
layout(std430, binding = kBlockPowerPrefix) writeonly buffer Prefix { uint prefix[]; };

uniform uint viewCount;
uniform uint blockCount;

float powerOf(uint view) { return gatherPower(viewFlux(view)); }

#if MV_STAGE == 1 || MV_STAGE == 3
shared uint laneSums[MV_WORKGROUP_SIZE];

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint size = (blockCount + uint(MV_WORKGROUP_SIZE) - 1u) / uint(MV_WORKGROUP_SIZE);
    uint begin = min(lane * size, blockCount);
    uint end = min(begin + size, blockCount);
#if MV_STAGE == 1
    float sum = 0.0;
    for (uint b = begin; b < end; ++b) sum += blockPower[b];
    laneSums[lane] = floatBitsToUint(sum);
    barrier();
    if (lane == 0u) {
        float total = 0.0;
        for (uint i = 0u; i < uint(MV_WORKGROUP_SIZE); ++i) total += uintBitsToFloat(laneSums[i]);
        blockPower[blockCount] = total;
    }
#else
    uint sum = 0u;
    for (uint b = begin; b < end; ++b) sum += blockUnits[b];
    laneSums[lane] = sum;
    barrier();
    uint before = 0u;
    for (uint i = 0u; i < lane; ++i) before += laneSums[i];
    for (uint b = begin; b < end; ++b) {
        uint units = blockUnits[b];
        blockUnits[b] = before;
        before += units;
    }
    if (lane == uint(MV_WORKGROUP_SIZE) - 1u) prefix[viewCount] = before;
#endif
}
#else
void main() {
    uint block = globalIndex();
    if (block >= blockCount) return;
    uint view = block * kPowerBlock;
    uint end = min(view + kPowerBlock, viewCount);
#if MV_STAGE == 0
    float sum = 0.0;
    do sum += powerOf(view);
    while (++view < end);
    blockPower[block] = sum;
#else
    float total = blockPower[blockCount];
#if MV_STAGE == 2
    uint units = 0u;
    do units += powerUnits(powerOf(view), total, viewCount);
    while (++view < end);
    blockUnits[block] = units;
#else
    uint before = blockUnits[block];
    do {
        uint units = powerUnits(powerOf(view), total, viewCount);
        prefix[view] = before;
        before += units;
    } while (++view < end);
#endif
#endif
}
#endif
