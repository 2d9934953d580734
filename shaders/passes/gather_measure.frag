// GBuffer x kept views x maps -> the luminance that reaches a pixel with and without the clamp, on
// a sparse grid of the gather's pixels.
#include "shaders/passes/gather_own.glsl"
#include "shaders/shared/bindings.glsl"

layout(binding = kUnitSurfaces) uniform usampler2D surfaces;  // see gather_surfaces.comp
layout(binding = kUnitPlanes) uniform usampler2D planes;

uniform int stride;  // of the grid
#ifdef MV_GLOSS
uniform int scale;  // G-buffer pixels a pixel, each way
#endif

layout(location = 0) out vec4 energy;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) * stride;
    uvec4 surface = texelFetch(surfaces, pixel, 0);
    bool present = surface.w != kNoSurface;
    uint plane = texelFetch(planes, pixel, 0).x;
    receiverPlane = unpackNormal(plane);
#ifdef MV_GLOSS
    receiverGloss = broadGlossAt(pixel * scale, uintBitsToFloat(surface.xyz),
                                 unpackNormal(surface.w), kRoughGloss);
#endif
    uint receiver = receiverOf(uvec2(pixel), partOfPlane(plane));
    uvec4 list = texelFetch(lists, int(receiver));
    Gathered sum = gatherSum(receiver, list, uintBitsToFloat(surface.xyz), unpackNormal(surface.w),
                             uvec2(pixel), present, samples, 1u);
    energy = vec4(luminance(sum.clamped), luminance(sum.unclamped), 0.0, 1.0);
}
