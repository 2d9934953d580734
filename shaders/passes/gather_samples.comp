// The samples of one pixel, written down by the very code that gathers them: of a pixel of the
// gather, or (UPSAMPLE) the gather's pixels that a full pixel is brought up from.
#include "shaders/shared/types.glsl"

layout(local_size_x = 1) in;

const uint kMaxTaps = 16u;
layout(std430, binding = 1) buffer Recorded {
    uint sampleCount;  // all of them, also those beyond the capacity
    uint tapCount;
    float weight;  // of all taps
    uint pad;
    uvec4 taps[kMaxTaps];  // pixel, float bits of its weight
    GatheredRecord recorded[];
};
layout(std430, binding = 2) readonly buffer SortedViews { View sortedViews[]; };

uniform ivec2 chosen;
uniform uint recordCapacity;
uniform float share;  // of the pixel, in what is recorded

uint samplesSoFar = 0u;
uint tapsSoFar = 0u;
float weightSoFar = 0.0;

void recordSample(uint view, vec3 contribution, bool visible) {
    if (samplesSoFar < recordCapacity) {
        View v = sortedViews[view];
        vec3 given = contribution * share;
        recorded[samplesSoFar] = GatheredRecord(v.slot, visible ? 1u : 0u, v.positionX, v.positionY,
                                                v.positionZ, given.x, given.y, given.z);
    }
    samplesSoFar += 1u;
}

void recordTap(ivec2 pixel, float tapWeight) {
    taps[min(tapsSoFar, kMaxTaps - 1u)] = uvec4(uvec2(pixel), floatBitsToUint(tapWeight), 0u);
    tapsSoFar += 1u;
    weightSoFar += tapWeight;
}

#define SAMPLES
#ifdef UPSAMPLE
#include "shaders/passes/upsample.glsl"
#else
#include "shaders/passes/gather_pixel.glsl"
#endif

void main() {
    if (gl_GlobalInvocationID.x > 0u) return;
    if (firstSample > 0u) samplesSoFar = sampleCount;
#ifdef UPSAMPLE
    upsamplePixel(chosen);
#else
    bool present;
    uvec4 list;
    gatherPixel(chosen, present, list);
#endif
    sampleCount = samplesSoFar;
    tapCount = tapsSoFar;
    weight = weightSoFar;
}
