// The sky as parallel views with depth maps (renderer/passes/sky_maps.h): which of them a pixel
// asks, and what their maps know of it. Either this file or sky_rays.glsl answers sky_light.comp.
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/parallel.glsl"
#include "shaders/shared/sky.glsl"

layout(binding = kUnitSkyViews) uniform samplerBuffer skyViews;  // SkyView
layout(binding = kUnitSkyMaps) uniform usamplerBuffer skyMaps;
uniform uint skyViewCount;
uniform uint skyMapRes;
uniform vec3 skyCentre;
uniform float skyRadius;

struct SkyChoices {
    ivec2 pixel;
    uint count;
};
SkyChoices skyChoices(ivec2 pixel, uint count) {
    return SkyChoices(pixel, min(count, skyViewCount));
}

// One view of each run of the list. Runs are patches of the sky in proportion to what it gives, so
// that what nothing hides has no noise.
SkySample skySampleOf(SkyChoices c, uint k, vec3 normal) {
    float number = unitFloat(
        sampleOffset(seed ^ kSkyDraw, uint(c.pixel.x), uint(c.pixel.y), k, accumulationIndex));
    Choice choice = noChoice(number);
    uint end = (k + 1u) * skyViewCount / c.count;
    for (uint view = k * skyViewCount / c.count; view < end; ++view) {
        vec4 v = texelFetch(skyViews, int(2u * view));
        choice = withCandidate(choice, view, v.w * dot3(normal, v.xyz));
    }
    SkySample s;
    s.view = choice.chosen;
    s.way = 0u;
    s.direction = vec3(0.0);
    s.light = vec3(0.0);
    if (choice.chosen == kNone) return s;
    s.direction = texelFetch(skyViews, int(2u * s.view)).xyz;
    float cosine = max(dot3(normal, s.direction), 0.0);
    s.light = texelFetch(skyViews, int(2u * s.view + 1u)).rgb *
              (float(c.count) * cosine * choice.total / choice.weight);
    return s;
}

// What the four nearest texels say, each compared with the receiver's own plane.
uint skyVerdict(SkySample s, vec3 position, vec3 plane) {
    float facing = dot3(plane, s.direction);
    if (!(facing > kParallelGrazing)) return kVerdictUndecided;
    ParallelView v = parallelView(s.direction);
    float texel = parallelTexel(skyRadius, skyMapRes);
    vec3 place = parallelPlace(v, position - skyCentre, skyRadius, skyMapRes);
    vec2 slope = parallelSlope(v, plane, facing, texel);
    vec2 last = vec2(float(skyMapRes) - 1.0);
    vec2 corner = floor(place.xy - 0.5);
    uint first = kVerdictUndecided;
    for (int i = 0; i < 4; ++i) {
        vec2 at = clamp(corner + vec2(float(i & 1), float(i >> 1)), vec2(0.0), last);
        uint row = s.view * skyMapRes + uint(at.y);
        uint bits = texelFetch(skyMaps, int(row * skyMapRes + uint(at.x))).x;
        float depth = place.z + dot(slope, at + 0.5 - place.xy);
        uint verdict = parallelVerdict(bits, depth, texel);
        if (i == 0) first = verdict;
        if (verdict != first) first = kVerdictUndecided;
    }
    return first;
}
