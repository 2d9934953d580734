// Adds the light of the sky to the gathered irradiance: that of a few directions from each surface,
// of which those count that meet nothing, as a ray finds. MV_SKY_MAPS: the directions are those of
// parallel views, and a ray is asked only where the view's depth map cannot tell. MV_ALONE: at the
// pixels that alone_pixels.glsl lists.
#include "shaders/passes/bounded_rays.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_variance.glsl"
#include "shaders/shared/light.glsl"
#include "shaders/shared/map_verdict.glsl"
#ifdef MV_GLOSS
#include "shaders/passes/surface_gloss.glsl"
#endif
#if defined(MV_GLOSS) || defined(MV_SEEN_SHARES)
uniform int scale;  // G-buffer pixels a pixel, each way
#endif

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kImageIrradiance, rgba32f) uniform restrict image2D irradiance;
#ifdef MV_ALONE
#include "shaders/passes/alone_pixels.glsl"
layout(binding = kUnitPosition) uniform sampler2D positions;
layout(binding = kUnitNormal) uniform sampler2D normals;
#ifndef MV_GLOSS
layout(binding = kUnitPlane) uniform sampler2D planeNormals;
#endif
layout(binding = kImageUnfiltered, rgba32f) uniform restrict image2D unfiltered;
#else
#include "shaders/passes/rests.glsl"
layout(binding = kUnitSurfaces) uniform usampler2D surfaces;
layout(binding = kUnitPlanes) uniform usampler2D planes;
#endif

#ifdef MV_SEEN_SHARES
layout(binding = kUnitReflectionWeight) uniform sampler2D seenShares;
#endif

uniform ivec2 size;
uniform int firstRow;
uniform uint samples;  // a pixel, of which some are asked at once
uniform uint firstSample, lastSample;
uniform uint seed;
uniform uint accumulationIndex;

struct SkySample {
    vec3 direction;
    vec3 light;  // irradiance that it stands for if it reaches the sky, W/m^2
    uint view;   // of sky_views.glsl
    uint way;    // 0, 1: how it was drawn
};
#ifdef MV_SKY_MAPS
#include "shaders/passes/sky_views.glsl"
#else
#include "shaders/passes/sky_rays.glsl"
#endif

void main() {
#ifdef MV_ALONE
    ivec2 pixel;
    if (!takeAlonePixel(pixel)) return;
    vec3 position = texelFetch(positions, pixel, 0).xyz;
    vec3 normal = normalizeOr(texelFetch(normals, pixel, 0).xyz, vec3(0.0, 1.0, 0.0));
    vec3 plane = normalizeOr(texelFetch(planeNormals, pixel, 0).xyz, normal);
#else
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, firstRow);
    if (any(greaterThanEqual(pixel, size))) return;
    uvec4 surface = texelFetch(surfaces, pixel, 0);
    if (surface.w == kNoSurface || rests(pixel)) return;
    vec3 position = uintBitsToFloat(surface.xyz);
    vec3 normal = unpackNormal(surface.w);
    vec3 plane = unpackNormal(texelFetch(planes, pixel, 0).x);
#endif
#ifdef MV_GLOSS
    BroadGloss gloss = broadGlossAt(pixel * scale, position, normal, kRoughGloss);
#endif
    vec3 origin = position + plane * bvhLift();
    uint count = samples;
#ifdef MV_SEEN_SHARES
    vec3 seen = texelFetch(seenShares, pixel * scale, 0).rgb;
    count = max(samples / samplesForOne(max(seen.r, max(seen.g, seen.b))), 1u);
#endif
    SkyChoices choices = skyChoices(pixel, count);
    count = choices.count;
    uint end = min(lastSample, count);
    if (firstSample >= end) return;
    vec3 sum = vec3(0.0);
    // The sums of luminances and of their squares, and the number of samples, drawn in either way.
    vec2 sums = vec2(0.0);
    vec2 squares = vec2(0.0);
    uvec2 drawn = uvec2(0u);
    for (uint k = firstSample; k < end; ++k) {
        SkySample s = skySampleOf(choices, k, normal);
        ++drawn[s.way];
        if (!(luminance(s.light) > 0.0) || dot3(s.direction, plane) <= 0.0) continue;
        uint verdict = skyVerdict(s, position, plane);
        vec3 light = s.light;
#if MV_BVH_TINTS
        // Maps know what stops light, not what tints it.
        if (verdict == kVerdictLit) verdict = kVerdictUndecided;
#endif
        // Loops alone skip work where branches are masked.
        for (; verdict == kVerdictUndecided;) {
            vec3 passed = bvhPassed(origin, s.direction, 0.0, kBeyondScene);
            light *= passed;
            verdict = luminance(passed) > 0.0 ? kVerdictLit : kVerdictBlocked;
        }
        if (verdict == kVerdictBlocked) continue;
#ifdef MV_GLOSS
        light *= broadGlossWeight(gloss, normal, s.direction);
#endif
        sum += light;
        float l = luminance(light);
        sums[s.way] += l;
        squares[s.way] += l * l;
    }
    vec3 mean = sum / float(count);
#ifdef MV_ALONE
    imageStore(irradiance, pixel, imageLoad(irradiance, pixel) + vec4(mean, 0.0));
    imageStore(unfiltered, pixel, imageLoad(unfiltered, pixel) + vec4(mean, 0.0));
#else
    float variance = varianceOfTwoWays(sums, squares, drawn) / float(count * count);
    imageStore(irradiance, pixel, imageLoad(irradiance, pixel) + vec4(mean, variance));
#endif
}
