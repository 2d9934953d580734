// G-buffer -> the surface that each pixel of the gather stands for: the first of its scale x scale
// pixels that has one, in a fixed order.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/gather.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitPosition) uniform sampler2D positions;
layout(binding = kUnitNormal) uniform sampler2D normals;
layout(binding = kUnitPlane) uniform sampler2D planeNormals;

layout(binding = kImageSurfaces, rgba32ui) uniform writeonly restrict uimage2D surfaces;
layout(binding = kImagePlanes, r32ui) uniform writeonly restrict uimage2D planes;

uniform ivec2 size;  // of the gather
uniform int scale;   // G-buffer pixels a gather pixel, each way

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size))) return;

    ivec2 limit = textureSize(positions, 0) - 1;
    ivec2 origin = pixel * scale;
    vec4 position = vec4(0.0);
    ivec2 chosen = origin;
    for (int i = 0; i < scale * scale && position.w == 0.0; ++i) {
        chosen = min(origin + ivec2(i % scale, i / scale), limit);
        position = texelFetch(positions, chosen, 0);
    }
    if (position.w == 0.0) {
        imageStore(surfaces, pixel, uvec4(0u, 0u, 0u, kNoSurface));
        return;
    }
    uint code = packNormal(normalizeOr(texelFetch(normals, chosen, 0).xyz, vec3(0.0, 1.0, 0.0)));
    vec3 plane = normalizeOr(texelFetch(planeNormals, chosen, 0).xyz, unpackNormal(code));
    imageStore(planes, pixel, uvec4(planeOfPart(packNormal(plane), 0u)));
    imageStore(surfaces, pixel, uvec4(floatBitsToUint(position.xyz), code));
}
