// Writes down the samples of one pixel, from the very code that gathers them.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather_data.glsl"

layout(std430, binding = kBlockGatheredSamples) buffer Recorded {
    GatherHead head;
    GatheredRecord recorded[];
};
layout(std430, binding = kBlockSortedViews) readonly buffer SortedViews { View viewsByOrder[]; };

uniform ivec2 chosen;
uniform uint recordCapacity;
uniform float share;  // of the pixel, in what is recorded

bool recording = false;  // this invocation's is the chosen pixel
uint samplesSoFar = 0u;
uint tapsSoFar = 0u;
float weightSoFar = 0.0;

void beginRecord() {
    recording = true;
    if (firstSample > 0u) samplesSoFar = head.sampleCount;
}

// open: what it would give if nothing stood between. given: what it gives.
void recordSample(uint view, vec3 open, vec3 given, bool visible) {
    if (!recording) return;
    if (samplesSoFar < recordCapacity) {
        View v = viewsByOrder[view];
        open *= share;
        given *= share;
        recorded[samplesSoFar] =
            GatheredRecord(v.slot, visible ? 1u : 0u, v.positionX, v.positionY, v.positionZ, open.x,
                           open.y, open.z, given.x, given.y, given.z, 0u);
    }
    samplesSoFar += 1u;
}

void recordTap(ivec2 pixel, float tapWeight) {
    head.taps[min(tapsSoFar, kMaxTaps - 1u)] =
        GatherTap(uint(pixel.x), uint(pixel.y), tapWeight, 0u);
    tapsSoFar += 1u;
    weightSoFar += tapWeight;
}

void forgetRecordedTaps() {
    tapsSoFar = 0u;
    weightSoFar = 0.0;
}

void endRecord() {
    if (!recording) return;
    head.sampleCount = samplesSoFar;
    head.tapCount = tapsSoFar;
    head.weight = weightSoFar;
}
