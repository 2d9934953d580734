// The sky by rays: where those of a pixel go. Only the scene knows what they meet. Either this file
// or sky_views.glsl answers sky_light.comp.
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/map_verdict.glsl"
#include "shaders/shared/sky.glsl"

const uint kGoldenStep = 0x9E3779B9u;  // 2^32 by the golden ratio

uniform uint skyRows;
uniform float tableShare;

struct SkyChoices {
    ivec2 pixel;
    uint place, count;
    float firstPick;
};
SkyChoices skyChoices(ivec2 pixel, uint count) {
    uint place = uint(pixel.y) << 16u | uint(pixel.x);
    float firstPick = random4(seed, place, accumulationIndex, kSkyPickDraw).x;
    return SkyChoices(pixel, place, count, firstPick);
}

SkySample skySampleOf(SkyChoices c, uint k, vec3 normal) {
    uint n = accumulationIndex * c.count + k;
    vec3 r = random4(seed, c.place, n, kSkyDraw).xyz;
    // Spread over the pixels of a block, as the gather's choices are, and over a pixel's own: as
    // many of each pixel's aim at a sun.
    uint base = sampleOffset(seed ^ kSkyDraw, uint(c.pixel.x), uint(c.pixel.y), 0u, 0u);
    r.x = unitFloat(base + n * kGoldenStep);
    float pick = fract(c.firstPick + float(k) / float(c.count));
    SkySample s;
    s.light = skyIrradiance(skyRows, tableShare, normal, r, pick, s.direction);
    s.view = 0u;
    s.way = pick < tableShare ? 0u : 1u;
    return s;
}

uint skyVerdict(SkySample s, vec3 position, vec3 plane) { return kVerdictUndecided; }
