// Lists pixels of the gather none of whose samples was seen to pass, but that the filter lights
// from their neighbours: they lie in the dark, or were out of luck. Those are listed that the
// filter must have wrong if nothing passes on further looks either, and gather_again.comp looks.
// Those that it leaves in doubt are listed once more, for a longer look. MV_BOUND: corrects those
// for which the last look, too, finds too little.
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
layout(binding = kImageFound, rg32f) uniform restrict image2D found;  // see gather_again.comp
uniform uint samples;
uniform uint looked;  // samples of all looks so far
uniform ivec2 size;

// The luminance that a pixel may have. light: that looks found, the mean of their samples.
float mostLight(ivec2 pixel, vec4 own, float light) {
    float rest = max(luminance(texelFetch(unfiltered, pixel, 0).rgb) - own.w, 0.0);
    return rest + light + kLooksMisses * own.z / float(kAllLooksSamples * samples);
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
    vec4 own = texelFetch(candidates, pixel, 0);
    float shown = luminance(light.rgb);
    vec2 looks = looked > 0u ? imageLoad(found, pixel).xy : vec2(0.0);
    float sum = looks.x + looks.y;
    float most = mostLight(pixel, own, sum / float(max(looked, 1u)));
    bool doubted = own.z > 0.0 && shown > kLooksFactor * most;
#ifdef MV_BOUND
    if (doubted) light.rgb *= kLooksLeft * most / shown;
    imageStore(filtered, pixel, light);
#else
    imageStore(found, pixel, vec4(sum, 0.0, 0.0, 0.0));
    if (doubted) addAlonePixel(pixel);
#endif
}
