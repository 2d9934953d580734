// One pass of the cross-bilateral filter: three taps (1 2 1) `spacing` pixels apart, across or
// down, guided by positions and normals. Passes of doubled spacing widen it ("a trous"). Irradiance
// only, never albedo; pixels without a surface take no part.
#include "shaders/passes/edges.glsl"
#include "shaders/shared/bindings.glsl"

layout(binding = kUnitFilterSource) uniform sampler2D source;
layout(binding = kUnitSurfaces) uniform usampler2D surfaces;
layout(binding = kUnitNormal) uniform sampler2D normals;  // G-buffer: w = depth
uniform ivec2 spacing;
uniform int scale;  // G-buffer pixels a pixel, each way

layout(location = 0) out vec4 irradiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 limit = textureSize(surfaces, 0) - 1;
    uvec4 surface = texelFetch(surfaces, pixel, 0);
    vec3 position = uintBitsToFloat(surface.xyz);
    vec3 normal = unpackNormal(surface.w);
    ivec2 fullSize = textureSize(normals, 0);
    float depth = texelFetch(normals, min(pixel * scale, fullSize - 1), 0).w;
    float apart = float((spacing.x + spacing.y) * scale) * pixelFootprint(depth);
    vec3 sum = texelFetch(source, pixel, 0).rgb * 2.0;
    float weights = 2.0;
    for (int tap = 0; tap < 2; ++tap) {
        ivec2 at = tap == 0 ? pixel - spacing : pixel + spacing;
        ivec2 inside = clamp(at, ivec2(0), limit);
        uvec4 other = texelFetch(surfaces, inside, 0);
        vec3 value = texelFetch(source, inside, 0).rgb;
        float weight = edgeWeight(position, normal, uintBitsToFloat(other.xyz),
                                  unpackNormal(other.w), 0.4 * apart);
        if (at == inside && other.w != kNoSurface && weight > 0.0) {
            sum += value * weight;
            weights += weight;
        }
    }
    irradiance = surface.w == kNoSurface ? vec4(0.0) : vec4(sum / weights, 1.0);
}
