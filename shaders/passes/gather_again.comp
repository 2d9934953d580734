// Gathers the pixels that second_look.comp lists again, each with views that it draws for itself.
#include "shaders/passes/alone_pixels.glsl"
#include "shaders/passes/gather_own.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/light.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;
layout(binding = kUnitSurfaces) uniform usampler2D surfaces;
layout(binding = kUnitPlanes) uniform usampler2D planes;
// Luminance, the sum over samples, each as if it were the only one: of all looks before, and of
// this one so far, which begins anew where a driver's bound on loops cut it too coarsely.
layout(binding = kImageFound, rg32f) uniform restrict image2D found;
uniform int scale;  // G-buffer pixels a pixel, each way

void main() {
    ivec2 pixel;
    if (!takeAlonePixel(pixel)) return;
    uvec4 surface = texelFetch(surfaces, pixel, 0);
    vec3 position = uintBitsToFloat(surface.xyz);
    vec3 normal = unpackNormal(surface.w);
    uint plane = texelFetch(planes, pixel, 0).x;
    beginReceiver(pixel * scale, position, normal, unpackNormal(plane));
    uint receiver = receiverOf(uvec2(pixel), partOfPlane(plane));
    uvec4 list = texelFetch(lists, int(receiver));
    Gathered sum =
        gatherSum(receiver, list, position, normal, uvec2(pixel), true, samples, kOwnCandidates);
    float light = float(samples) * luminance(sum.clamped);
    vec2 before = imageLoad(found, pixel).xy;
    if (firstSample > 0u) light += before.y;
    imageStore(found, pixel, vec4(before.x, light, 0.0, 0.0));
}
