// One pass of the cross-bilateral filter: 3 x 3 taps `spacing` pixels apart ("a trous"), guided by
// positions and normals. Irradiance only, never albedo; pixels without a surface take no part.
#include "shaders/passes/edges.glsl"

layout(binding = 0) uniform sampler2D source;
layout(binding = 1) uniform usampler2D surfaces;
uniform int spacing;

layout(location = 0) out vec4 irradiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 limit = textureSize(surfaces, 0) - 1;
    uvec4 surface = texelFetch(surfaces, pixel, 0);
    vec3 position = uintBitsToFloat(surface.xyz);
    vec3 normal = unpackNormal(surface.w);
    vec4 center = texelFetch(source, pixel, 0);
    vec3 sum = center.rgb * 4.0;
    float weights = 4.0;
    for (int tap = 0; tap < 9; ++tap) {
        ivec2 move = ivec2(tap % 3 - 1, tap / 3 - 1);
        ivec2 at = pixel + move * spacing;
        bool inside = move != ivec2(0) && all(greaterThanEqual(at, ivec2(0))) &&
                      all(lessThanEqual(at, limit));
        at = clamp(at, ivec2(0), limit);
        uvec4 other = texelFetch(surfaces, at, 0);
        float weight = float((2 - abs(move.x)) * (2 - abs(move.y))) *
                       edgeWeight(position, normal, uintBitsToFloat(other.xyz),
                                  unpackNormal(other.w));
        if (!inside || other.w == kNoSurface) weight = 0.0;
        vec3 value = texelFetch(source, at, 0).rgb;
        if (weight > 0.0) sum += value * weight;
        weights += weight;
    }
    irradiance = surface.w == kNoSurface ? vec4(0.0) : vec4(sum / weights, 1.0);
}
