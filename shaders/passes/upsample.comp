// The full-resolution pixels of a gather at a lower resolution. Those that nobody serves
// are listed, and gathered by gather_alone.comp.
#include "shaders/passes/alone_pixels.glsl"
#include "shaders/passes/upsample.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;
layout(binding = kImageIrradiance, rgba32f) uniform restrict writeonly image2D irradiance;
layout(binding = kImageUnfiltered, rgba32f) uniform restrict writeonly image2D unfiltered;
layout(binding = kImageUpsampledCandidates, rgba32f) uniform restrict writeonly image2D candidates;

uniform ivec2 size;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size))) return;
    Upsampled result = upsamplePixel(pixel);
    imageStore(irradiance, pixel, result.irradiance);
    imageStore(unfiltered, pixel, result.unfiltered);
    imageStore(candidates, pixel, vec4(result.candidates, 0.0, 0.0));
    if (result.alone) addAlonePixel(pixel);
}
