// Irradiance gathered at a lower resolution -> full resolution, by bilinear weights times those of
// edges.
#include "shaders/passes/edges.glsl"
#include "shaders/shared/bindings.glsl"

layout(binding = kUnitSurfaces) uniform usampler2D surfaces;  // of the gather
layout(binding = kUnitFilteredCoarse) uniform sampler2D filteredCoarse;
layout(binding = kUnitUnfilteredCoarse) uniform sampler2D unfilteredCoarse;
layout(binding = kUnitCandidatesCoarse) uniform sampler2D candidatesCoarse;
#ifndef MV_RECORDS_SAMPLES                                    // else gather_alone.glsl has them
layout(binding = kUnitPosition) uniform sampler2D positions;  // G-buffer
layout(binding = kUnitNormal) uniform sampler2D normals;
#endif
uniform int scale;
uniform bool takesNearest;  // where nobody shares the surface

// A neighbour's light is taken as it is, so it must be of the same surface.
const float kLeastCos = 0.5;  // of normals 60 degrees apart: see edgeWeight()
const float kMostSlope = 0.1;
const float kAlone = 1e-3;      // of weights below which no neighbour shares the surface
const float kRingWeight = 0.1;  // of a tap of the ring; the four's sum to 1, if all share it
const int kTaps = 16;
const ivec2 kRing[12] =
    ivec2[12](ivec2(0, -1), ivec2(1, -1), ivec2(-1, 0), ivec2(2, 0), ivec2(-1, 1), ivec2(2, 1),
              ivec2(0, 2), ivec2(1, 2), ivec2(-1, -1), ivec2(2, -1), ivec2(-1, 2), ivec2(2, 2));

struct Upsampled {
    vec4 irradiance, unfiltered;
    vec2 candidates;  // kept share, undecided share
    bool alone;       // no neighbour serves: black
};

vec3 sumOfTaps, noisyOfTaps;
float weightOfTaps;

void forgetTaps() {
    sumOfTaps = vec3(0.0);
    noisyOfTaps = vec3(0.0);
    weightOfTaps = 0.0;
#ifdef MV_RECORDS_SAMPLES
    forgetRecordedTaps();
#endif
}

void addTap(ivec2 at, uvec4 surface, float weight) {
    vec3 value = texelFetch(filteredCoarse, at, 0).rgb;
    vec3 raw = texelFetch(unfilteredCoarse, at, 0).rgb;
    if (surface.w == kNoSurface || !(weight > 0.0)) return;
    sumOfTaps += value * weight;
    noisyOfTaps += raw * weight;
    weightOfTaps += weight;
#ifdef MV_RECORDS_SAMPLES
    recordTap(at, weight);
#endif
}

// The first four are around the pixel, the others around those.
ivec2 tapCorner(int tap) { return tap < 4 ? ivec2(tap & 1, tap >> 1) : kRing[tap - 4]; }

Upsampled upsamplePixel(ivec2 pixel) {
    vec4 position = texelFetch(positions, pixel, 0);
    bool present = position.w != 0.0;
    vec4 normalAndDepth = texelFetch(normals, pixel, 0);
    vec3 normal = normalizeOr(normalAndDepth.xyz, vec3(0.0, 1.0, 0.0));
    ivec2 limit = textureSize(surfaces, 0) - 1;

    float apart = float(scale) * pixelFootprint(normalAndDepth.w);
    vec2 place = vec2(pixel) / float(scale);  // gathered is the first pixel of a block
    ivec2 base = ivec2(floor(place));
    vec2 part = place - vec2(base);
    forgetTaps();
    // The four neighbours; where none will do, the ring of twelve around them.
    int tap = present ? 0 : kTaps;
    while (tap < 4 || (tap < kTaps && weightOfTaps < kAlone)) {
        ivec2 corner = tapCorner(tap);
        ivec2 at = clamp(base + corner, ivec2(0), limit);
        uvec4 other = texelFetch(surfaces, at, 0);
        vec2 near = max(vec2(0.0), 1.0 - abs(vec2(corner) - part));
        float weight =
            (tap < 4 ? near.x * near.y : kRingWeight) *
            edgeWeight(position.xyz, normal, uintBitsToFloat(other.xyz), unpackNormal(other.w),
                       kLeastCos, kMostSlope, tapTolerance(false) * apart);
        addTap(at, other, weight);
        ++tap;
    }
    bool isShared = !present || weightOfTaps >= kAlone;
    // All of them, of whatever surface: the nearer and the more alike they face the better.
    tap = takesNearest && !isShared ? 0 : kTaps;
    if (tap == 0) forgetTaps();
    while (tap < kTaps) {
        ivec2 at = clamp(base + tapCorner(tap), ivec2(0), limit);
        uvec4 other = texelFetch(surfaces, at, 0);
        vec3 way = (uintBitsToFloat(other.xyz) - position.xyz) / apart;
        float turn = max(dot(normal, unpackNormal(other.w)), 0.0);
        addTap(at, other, (kAlone + turn * turn) / (1.0 + dot(way, way)));
        ++tap;
    }
    float alpha = present ? 1.0 : 0.0;
    Upsampled result;
    result.alone = !isShared && !(takesNearest && weightOfTaps > 0.0);
    float inverse = result.alone || weightOfTaps == 0.0 ? 0.0 : 1.0 / weightOfTaps;
    result.irradiance = vec4(sumOfTaps * inverse, 1.0) * alpha;
    result.unfiltered = vec4(noisyOfTaps * inverse, 1.0) * alpha;
    result.candidates = alpha * texelFetch(candidatesCoarse, min(pixel / scale, limit), 0).xy;
    return result;
}
