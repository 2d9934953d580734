// Pixels of the gather of whose samples none was seen to pass, but that the filter lights from
// their neighbours: in the dark, or out of luck? Those that the filter must have wrong if nothing
// passes on a second look either are listed; gather_again.comp looks, and MV_BOUND corrects those
// that it has wrong still.
#include "shaders/passes/alone_pixels.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/light.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;
layout(binding = kUnitFilterSource) uniform sampler2D unfiltered;
// z: luminance that the samples would have given if nothing stood between, where none was seen to
// pass; w: that they gave (by maps alone).
layout(binding = kUnitCandidates) uniform sampler2D candidates;
layout(binding = kImageIrradiance, rgba32f) uniform restrict image2D filtered;
uniform uint samples;
#ifdef MV_BOUND
layout(binding = kImageFound, r32f) uniform restrict readonly image2D found;  // by a second look
#else
uniform ivec2 size;
#endif

// The luminance that a pixel may have where a second look finds so much.
float mostLight(ivec2 pixel, vec4 looked, float found) {
    float rest = max(luminance(texelFetch(unfiltered, pixel, 0).rgb) - looked.w, 0.0);
    return rest + found + kSecondLookMisses * looked.z / float(kSecondLookSamples * samples);
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
    float most = mostLight(pixel, looked, imageLoad(found, pixel).x);
    if (shown > kSecondLookFactor * most) light.rgb *= most / shown;
    imageStore(filtered, pixel, light);
#else
    bool doubted = shown > kSecondLookFactor * mostLight(pixel, looked, 0.0);
    if (looked.z > 0.0 && doubted) addAlonePixel(pixel);
#endif
}
