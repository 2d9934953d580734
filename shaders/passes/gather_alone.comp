// Gathers the pixels that upsample.comp lists, side by side: between their neighbours, which have
// nothing to do, each would keep a whole vector of invocations waiting.
#include "shaders/passes/alone_pixels.glsl"
#include "shaders/passes/gather_alone.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;
layout(binding = kImageIrradiance, rgba32f) uniform restrict image2D irradiance;
layout(binding = kImageUnfiltered, rgba32f) uniform restrict image2D unfiltered;

void main() {
    ivec2 pixel;
    if (!takeAlonePixel(pixel)) return;
    vec4 light = vec4(gatherAlone(pixel), 1.0);
    if (firstSample > 0u) light.rgb += imageLoad(irradiance, pixel).rgb;
    imageStore(irradiance, pixel, light);
    imageStore(unfiltered, pixel, light);
}
