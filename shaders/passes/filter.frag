// One pass of the cross-bilateral filter: 3 x 3 taps (1 2 1) `spacing` pixels apart, guided by
// positions, normals and the variance of what is filtered [Schied et al. 2017, SVGF]. Passes of
// doubled spacing widen it ("a trous"). Irradiance only, never albedo; pixels without a surface
// take no part. Alpha is the variance of the luminance, there and here.
#include "shaders/passes/edges.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/light.glsl"

layout(binding = kUnitFilterSource) uniform sampler2D source;
layout(binding = kUnitSurfaces) uniform usampler2D surfaces;
layout(binding = kUnitNormal) uniform sampler2D normals;  // G-buffer: w = depth
uniform int spacing;
uniform int scale;  // G-buffer pixels a pixel, each way

layout(location = 0) out vec4 irradiance;

// Wide, so that leaves and mouldings, a pixel or two across, share too: what parts them is then
// their luminance. A slope of 37 degrees is far from a depth edge still.
const float kLeastCos = -1.0;
const float kMostSlope = 0.6;
// Standard deviations by which two taps may differ: fewer keep more of a shadow and of the noise,
// since a few samples seldom know how wide their light is spread. Many on one plane, where noise
// shows; few where places and normals agree least, where light seldom is the same: dark gaps and
// rims of a pixel or two stay dark.
const float kDeviations = 3.5;
const float kLeastDeviations = 1.5;
// From this spacing on the steadier tap must bear a difference too, with so many times its own
// variance. What lies inside a lamp's shade is bright, and noisy enough to be as dim as anything by
// its own variance; without this it appears on the ceiling beside it, 4, 8, 16 and 32 pixels away.
const int kFar = 4;
const float kMostUneven = 4.0;
// The correlation of two taps into which the passes before have mixed the same pixels, as a mean of
// all pairs.
const float kOverlap = 0.125;

// How much two estimates may share by their luminance: they differ by noise, or by a shadow. By
// the variance of their difference, so both say the same of each other and the mean stays.
// edge: how much they may share by their places, 0 .. 1.
float noiseWeight(vec4 a, vec4 b, float edge) {
    float apart = luminance(a.rgb) - luminance(b.rgb);
    float deviations = mix(kLeastDeviations, kDeviations, edge);
    float variance = a.a + b.a;
    if (spacing >= kFar) variance = min(variance, kMostUneven * min(a.a, b.a));
    float steps = apart * apart / (deviations * deviations * variance + 1e-30);
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
    float footprint = float(spacing * scale) * pixelFootprint(depth);
    vec4 own = texelFetch(source, pixel, 0);
    vec3 sum = own.rgb * 4.0;
    float weights = 4.0;
    float squares = 16.0;
    // A single estimate of the variance is itself noise: neighbours on the surface have as much.
    float variance = own.a * 4.0;
    float edges = 4.0;
    for (int tap = 0; tap < 9; ++tap) {
        ivec2 way = ivec2(tap % 3, tap / 3) - 1;
        ivec2 at = pixel + way * spacing;
        ivec2 inside = clamp(at, ivec2(0), limit);
        if (tap == 4 || at != inside) continue;
        uvec4 other = texelFetch(surfaces, inside, 0);
        if (other.w == kNoSurface) continue;
        vec4 value = texelFetch(source, inside, 0);
        bool corner = way.x != 0 && way.y != 0;
        float edge = edgeWeight(position, normal, uintBitsToFloat(other.xyz), unpackNormal(other.w),
                                kLeastCos, kMostSlope, tapTolerance(corner) * footprint);
        if (!(edge > 0.0)) continue;
        float share = (corner ? 1.0 : 2.0) * edge;
        variance += value.a * share;
        edges += share;
        float weight = share * noiseWeight(own, value, edge);
        if (!(weight > 0.0)) continue;  // the value may be infinite
        sum += value.rgb * weight;
        weights += weight;
        squares += weight * weight;
    }
    if (spacing > 1) squares = mix(squares, weights * weights, kOverlap);
    vec4 filtered = vec4(sum / weights, variance / edges * squares / (weights * weights));
    irradiance = surface.w == kNoSurface ? vec4(0.0) : filtered;
}
