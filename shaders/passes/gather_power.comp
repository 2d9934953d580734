// Sorted views -> power units before each view, and the records that the gather reads. One
// invocation sums a block of views in order; blocks are summed by one work group, in order too.
// STAGE 0: power of each block. 1: total power. 2: units of each block. 3: units before each block.
// 4: units before each view, records.
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_sampling.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = 0) uniform usamplerBuffer sortedViews;  // View, 3 texels
layout(binding = 1) uniform usamplerBuffer leafOfView;
layout(binding = 2) uniform usamplerBuffer mapOfNode;
layout(binding = 3) uniform usamplerBuffer mapNodes;  // ViewNode of the maps' hierarchy

layout(std430, binding = 0) buffer BlockPower { float blockPower[]; };  // last: the total
layout(std430, binding = 1) buffer BlockUnits { uint blockUnits[]; };
layout(std430, binding = 2) writeonly buffer Prefix { uint prefix[]; };
layout(std430, binding = 3) writeonly buffer Records { uvec4 records[]; };

uniform uint viewCount;
uniform uint blockCount;
uniform uint mapKind;  // 0: none, 1: one a leaf, 2: one a node

const uint kBlock = 64u;

float powerOf(uint view) {
    return gatherPower(uintBitsToFloat(texelFetch(sortedViews, int(view * 3u + 2u)).xyz));
}

#if STAGE == 1 || STAGE == 3
shared uint laneSums[MV_WORKGROUP_SIZE];

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint size = (blockCount + uint(MV_WORKGROUP_SIZE) - 1u) / uint(MV_WORKGROUP_SIZE);
    uint begin = min(lane * size, blockCount);
    uint end = min(begin + size, blockCount);
#if STAGE == 1
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

// Record of a view, 3 texels: position and map; kPowerUnits * flux / units and packed normal;
// centre of the map and units. A sample of w units then weighs w / kPowerUnits.
void writeRecord(uint view, uint units) {
    uvec4 a = texelFetch(sortedViews, int(view * 3u));
    vec3 normal = uintBitsToFloat(texelFetch(sortedViews, int(view * 3u + 1u)).xyz);
    vec3 flux = uintBitsToFloat(texelFetch(sortedViews, int(view * 3u + 2u)).xyz);
    uint map = kNone;
    uvec3 center = a.xyz;
    if (mapKind != 0u) {
        uint leaf = texelFetch(leafOfView, int(view)).x;
        map = mapKind == 1u ? texelFetch(mapOfNode, int(leaf)).x : leaf;
        center = texelFetch(mapNodes, int(leaf * 4u)).xyz;
    }
    vec3 perUnit = units > 0u ? flux * (kPowerUnits / float(units)) : vec3(0.0);
    bool omnidirectional = a.w == kViewOmnidirectional;
    records[view * 3u] = uvec4(a.xyz, map);
    records[view * 3u + 1u] =
        uvec4(floatBitsToUint(perUnit), omnidirectional ? kNoSurface : packNormal(normal));
    records[view * 3u + 2u] = uvec4(center, units);
}

void main() {
    uint block = globalIndex();
    if (block >= blockCount) return;
    uint view = block * kBlock;
    uint end = min(view + kBlock, viewCount);
#if STAGE == 0
    float sum = 0.0;
    do sum += powerOf(view);
    while (++view < end);
    blockPower[block] = sum;
#else
    float total = blockPower[blockCount];
#if STAGE == 2
    uint units = 0u;
    do units += powerUnits(powerOf(view), total);
    while (++view < end);
    blockUnits[block] = units;
#else
    uint before = blockUnits[block];
    do {
        uint units = powerUnits(powerOf(view), total);
        prefix[view] = before;
        before += units;
        writeRecord(view, units);
    } while (++view < end);
#endif
#endif
}
#endif
