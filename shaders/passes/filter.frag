// One pass of the cross-bilateral filter: three taps (1 2 1) `spacing` pixels apart, across or
// down, guided by positions, normals and the variance of what is filtered [Schied et al. 2017,
// SVGF]. Passes of doubled spacing widen it ("a trous"). Irradiance only, never albedo; pixels
// without a surface take no part. Alpha is the variance of the luminance, there and here.
#include "shaders/passes/edges.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/light.glsl"

layout(binding = kUnitFilterSource) uniform sampler2D source;
layout(binding = kUnitSurfaces) uniform usampler2D surfaces;
layout(binding = kUnitNormal) uniform sampler2D normals;  // G-buffer: w = depth
uniform ivec2 spacing;
uniform int scale;  // G-buffer pixels a pixel, each way

layout(location = 0) out vec4 irradiance;

// Wide, so that leaves and mouldings, a pixel or two across, share too: what parts them is then
// their luminance. A slope of 31 degrees is far from a depth edge still.
const float kLeastCos = -1.0;
const float kMostSlope = 0.6;
// Standard deviations by which two taps may differ: fewer keep more of a shadow and of the noise,
// since a few samples seldom know how wide their light is spread.
const float kDeviations = 4.0;
// What passes before have mixed into both of two neighbouring taps, as their correlation: that of
// cubic splines one knot apart.
const float kOverlap = 0.25;

// How much two estimates may share by their luminance: they differ by noise, or by a shadow. By
// the variance of their difference, so both say the same of each other and the mean stays.
float noiseWeight(vec4 a, vec4 b) {
    float apart = luminance(a.rgb) - luminance(b.rgb);
    float steps = apart * apart / (kDeviations * kDeviations * (a.a + b.a) + 1e-30);
    return steps < 50.0 ? exp(-steps) : 0.0;  // 0 for NaN
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 limit = textureSize(surfaces, 0) - 1;
    uvec4 surface = texelFetch(surfaces, pixel, 0);
    vec3 position = uintBitsToFloat(surface.xyz);
    vec3 normal = unpackNormal(surface.w);
    ivec2 fullSize = textureSize(normals, 0);
    float depth = texelFetch(normals, min(pixel * scale, fullSize - 1), 0).w;
    float apart = float((spacing.x + spacing.y) * scale) * pixelFootprint(depth);
    vec4 own = texelFetch(source, pixel, 0);
    vec3 sum = own.rgb * 2.0;
    float weights = 2.0;
    float squares = 4.0;
    // A single estimate of the variance is itself noise: neighbours on the surface have as much.
    float variance = own.a * 2.0;
    float edges = 2.0;
    for (int tap = 0; tap < 2; ++tap) {
        ivec2 at = tap == 0 ? pixel - spacing : pixel + spacing;
        ivec2 inside = clamp(at, ivec2(0), limit);
        uvec4 other = texelFetch(surfaces, inside, 0);
        vec4 value = texelFetch(source, inside, 0);
        float edge = edgeWeight(position, normal, uintBitsToFloat(other.xyz), unpackNormal(other.w),
                                kLeastCos, kMostSlope, 0.4 * apart);
        if (at == inside && other.w != kNoSurface && edge > 0.0) {
            float weight = edge * noiseWeight(own, value);
            sum += value.rgb * weight;
            weights += weight;
            squares += weight * weight;
            variance += value.a * edge;
            edges += edge;
        }
    }
    if (spacing.x + spacing.y > 1) squares += 2.0 * kOverlap * 2.0 * (weights - 2.0);
    vec4 filtered = vec4(sum / weights, variance / edges * squares / (weights * weights));
    irradiance = surface.w == kNoSurface ? vec4(0.0) : filtered;
}
