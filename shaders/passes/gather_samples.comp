// The samples of one pixel, written down by the very code that gathers them: of a pixel of the
// gather, or (UPSAMPLE) the gather's pixels that a full pixel is brought up from.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather_data.glsl"

layout(local_size_x = 1) in;

layout(std430, binding = kBlockGatheredSamples) buffer Recorded {
    GatherHead head;
    GatheredRecord recorded[];
};
layout(std430, binding = kBlockSortedViews) readonly buffer SortedViews { View viewsByOrder[]; };

uniform ivec2 chosen;
uniform uint recordCapacity;
uniform float share;  // of the pixel, in what is recorded

uint samplesSoFar = 0u;
uint tapsSoFar = 0u;
float weightSoFar = 0.0;

void recordSample(uint view, vec3 contribution, bool visible) {
    if (samplesSoFar < recordCapacity) {
        View v = viewsByOrder[view];
        vec3 given = contribution * share;
        recorded[samplesSoFar] = GatheredRecord(v.slot, visible ? 1u : 0u, v.positionX, v.positionY,
                                                v.positionZ, given.x, given.y, given.z);
    }
    samplesSoFar += 1u;
}

void recordTap(ivec2 pixel, float tapWeight) {
    head.taps[min(tapsSoFar, kMaxTaps - 1u)] =
        GatherTap(uint(pixel.x), uint(pixel.y), tapWeight, 0u);
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
    if (firstSample > 0u) samplesSoFar = head.sampleCount;
#ifdef UPSAMPLE
    upsamplePixel(chosen);
#else
    bool present;
    uvec4 list;
    gatherPixel(chosen, present, list);
#endif
    head.sampleCount = samplesSoFar;
    head.tapCount = tapsSoFar;
    head.weight = weightSoFar;
}
