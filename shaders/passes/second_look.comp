// Pixels of the gather all of whose samples were blocked, but that the filter lights from their
// neighbours: in the dark, or out of luck? Those that the filter must have wrong if all of a second
// look's samples are blocked too are listed; gather_again.comp looks, and MV_BOUND corrects those
// that it has wrong still.
#include "shaders/passes/alone_pixels.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/light.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;
layout(binding = kUnitFilterSource) uniform sampler2D unfiltered;
// z: luminance that the samples would have given if nothing stood between, where all were blocked;
// w: that the second look found.
layout(binding = kUnitCandidates) uniform sampler2D candidates;
layout(binding = kImageIrradiance, rgba32f) uniform restrict image2D filtered;
uniform uint samples;
#ifndef MV_BOUND
uniform ivec2 size;
#endif

// The luminance that a pixel may have where a second look finds so much.
float mostLight(ivec2 pixel, float blocked, float found) {
    // Near field and sky. Checked answers of maps may have left less than nothing.
    float rest = max(luminance(texelFetch(unfiltered, pixel, 0).rgb), 0.0);
    return rest + found + kSecondLookMisses * blocked / float(kSecondLookSamples * samples);
}

void main() {
#ifdef MV_BOUND
    ivec2 pixel;
    if (!takeAlonePixel(pixel)) return;
#else
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size))) return;
#endif
    vec4 light = imageLoad(filtered, pixel);
    vec4 looked = texelFetch(candidates, pixel, 0);
    float shown = luminance(light.rgb);
#ifdef MV_BOUND
    float most = mostLight(pixel, looked.z, looked.w);
    if (shown > kSecondLookFactor * most) light.rgb *= most / shown;
    imageStore(filtered, pixel, light);
#else
    bool doubted = shown > kSecondLookFactor * mostLight(pixel, looked.z, 0.0);
    if (looked.z > 0.0 && doubted) addAlonePixel(pixel);
#endif
}
