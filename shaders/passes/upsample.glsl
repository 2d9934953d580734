// Irradiance gathered at half resolution -> full resolution, by bilinear weights times those of
// edges.
#include "shaders/passes/edges.glsl"
#include "shaders/shared/bindings.glsl"

layout(binding = kUnitSurfaces) uniform usampler2D surfaces;  // at half resolution
layout(binding = kUnitFilteredHalf) uniform sampler2D filteredHalf;
layout(binding = kUnitUnfilteredHalf) uniform sampler2D unfilteredHalf;
layout(binding = kUnitCandidatesHalf) uniform sampler2D candidatesHalf;
#ifndef SAMPLES                                               // else gather_alone.glsl has them
layout(binding = kUnitPosition) uniform sampler2D positions;  // G-buffer
layout(binding = kUnitNormal) uniform sampler2D normals;
#endif
uniform int scale;

// A neighbour's light is taken as it is, so it must be of the same surface.
const float kLeastCos = 0.5;
const float kMostSlope = 0.1;
const float kAlone = 1e-3;  // of weights below which no neighbour shares the surface
const ivec2 kRing[12] =
    ivec2[12](ivec2(0, -1), ivec2(1, -1), ivec2(-1, 0), ivec2(2, 0), ivec2(-1, 1), ivec2(2, 1),
              ivec2(0, 2), ivec2(1, 2), ivec2(-1, -1), ivec2(2, -1), ivec2(-1, 2), ivec2(2, 2));

struct Upsampled {
    vec4 irradiance, unfiltered;
    vec2 candidates;  // kept share, undecided share
    bool alone;       // no neighbour shares its surface: black
};

Upsampled upsamplePixel(ivec2 pixel) {
    vec4 position = texelFetch(positions, pixel, 0);
    bool present = position.w != 0.0;
    vec4 normalAndDepth = texelFetch(normals, pixel, 0);
    vec3 normal = normalizeOr(normalAndDepth.xyz, vec3(0.0, 1.0, 0.0));
    ivec2 limit = textureSize(surfaces, 0) - 1;

    float apart = float(scale) * pixelFootprint(normalAndDepth.w);
    vec2 place = (vec2(pixel) + 0.5) / float(scale) - 0.5;
    ivec2 base = ivec2(floor(place));
    vec2 part = place - vec2(base);
    vec3 sum = vec3(0.0);
    vec3 noisy = vec3(0.0);
    float weights = 0.0;
    // The four neighbours; where none will do, the ring of twelve around them.
    int tap = present ? 0 : 16;
    while (tap < 4 || (tap < 16 && weights < kAlone)) {
        ivec2 corner = tap < 4 ? ivec2(tap & 1, tap >> 1) : kRing[tap - 4];
        ivec2 at = clamp(base + corner, ivec2(0), limit);
        uvec4 other = texelFetch(surfaces, at, 0);
        vec2 near = max(vec2(0.0), 1.0 - abs(vec2(corner) - part));
        float weight = (tap < 4 ? near.x * near.y : 0.1) *
                       edgeWeight(position.xyz, normal, uintBitsToFloat(other.xyz),
                                  unpackNormal(other.w), kLeastCos, kMostSlope, 0.4 * apart);
        vec3 value = texelFetch(filteredHalf, at, 0).rgb;
        vec3 raw = texelFetch(unfilteredHalf, at, 0).rgb;
        if (other.w != kNoSurface && weight > 0.0) {
            sum += value * weight;
            noisy += raw * weight;
            weights += weight;
#ifdef SAMPLES
            recordTap(at, weight);
#endif
        }
        ++tap;
    }
    float inverse = weights > 0.0 ? 1.0 / weights : 0.0;
    float alpha = present ? 1.0 : 0.0;
    Upsampled result;
    result.alone = present && weights < kAlone;
    if (result.alone) inverse = 0.0;
    result.irradiance = vec4(sum * inverse, 1.0) * alpha;
    result.unfiltered = vec4(noisy * inverse, 1.0) * alpha;
    result.candidates = alpha * texelFetch(candidatesHalf, min(pixel / scale, limit), 0).xy;
    return result;
}
