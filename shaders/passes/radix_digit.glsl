// One pass of the stable radix sort (radix_sort.h): each invocation owns a run of `chunkSize` pairs
// (key, index), at most 255, so its 32 digit counters are bytes in eight registers. The first pass
// also has a bin for dead elements, behind all others; later passes see only what is alive.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/morton.glsl"
#include "shaders/shared/sort.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint chunkSize;
uniform uint chunks;
uniform uint shift;
uniform uint capacity;  // elements of the first pass
uniform bool firstPass;
layout(binding = kUnitSortPairs) uniform usamplerBuffer pairs;  // RG32UI: key, index
layout(binding = kUnitSortAlive) uniform usamplerBuffer
    aliveTexels;  // R32UI, from the second pass on

uint elementCount() { return firstPass ? capacity : texelFetch(aliveTexels, 0).x; }
uint binOf(uint key) { return key == kMortonDead ? kDigits : (key >> shift) & (kDigits - 1u); }

// Byte counters of the 32 digits, and one of the dead.
struct Counters {
    uvec4 low, high;
    uint dead;
};
uvec4 wordMask(uint word) {  // 1 in the component that holds the word
    return uvec4(equal(uvec4(word), uvec4(0u, 1u, 2u, 3u)));
}
void countBin(inout Counters c, uint bin) {
    uint one = 1u << (8u * (bin & 3u));
    c.low += wordMask(bin >> 2u) * one;
    c.high += wordMask((bin >> 2u) - 4u) * one;
    c.dead += bin == kDigits ? 1u : 0u;
}
uint countOf(Counters c, uint bin) {
    uvec4 words = c.low * wordMask(bin >> 2u) + c.high * wordMask((bin >> 2u) - 4u);
    uint word = words.x + words.y + words.z + words.w;
    return bin == kDigits ? c.dead : (word >> (8u * (bin & 3u))) & 255u;
}
