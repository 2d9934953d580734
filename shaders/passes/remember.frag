// This frame's light and that of frames before -> their mean, which the next frame remembers. Where
// the light may have changed, what the two differ by around a pixel, beyond their noise, tells how
// much the old is still worth (shaders/shared/history.glsl). Approximate then: what changes by less
// than the noise of 25 pixels lags behind.
#include "shaders/passes/edges.glsl"
#include "shaders/passes/rests.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/history.glsl"
#include "shaders/shared/light.glsl"

layout(binding = kUnitFilterSource) uniform sampler2D source;  // a: variance of the luminance
layout(binding = kUnitSurfaces) uniform usampler2D surfaces;
layout(binding = kUnitNormal) uniform sampler2D normals;               // G-buffer: w = depth
layout(binding = kUnitRememberedLight) uniform sampler2D beforeLight;  // reproject.frag
uniform int scale;
uniform float samples;      // of this frame, a pixel
uniform float mostSamples;  // that are remembered
uniform bool mayChange;     // views or maps are not those of the frame before

layout(location = 0) out vec4 light;
layout(location = 1) out float worth;  // in samples

const int kRadius = 2;
const float kLeastCos = 0.5;
const float kMostSlope = 0.3;

void main() {
    light = vec4(0.0);
    worth = 0.0;
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec4 surface = texelFetch(surfaces, pixel, 0);
    if (surface.w == kNoSurface) return;
    vec4 own = texelFetch(source, pixel, 0);
    vec4 before = texelFetch(beforeLight, pixel, 0);
    float known = texelFetch(beforeSamples, pixel, 0).x;
    float change2 = 0.0;
    float variance = own.a;
    if (mayChange && known > 0.0) {
        vec3 position = uintBitsToFloat(surface.xyz);
        vec3 normal = unpackNormal(surface.w);
        ivec2 limit = textureSize(surfaces, 0) - 1;
        float depth = texelFetch(normals, min(pixel * scale, textureSize(normals, 0) - 1), 0).w;
        float footprint = float(scale) * pixelFootprint(depth);
        float difference = 0.0;
        float noise = 0.0;
        float weights = 0.0;
        variance = 0.0;
        for (int y = -kRadius; y <= kRadius; ++y) {
            for (int x = -kRadius; x <= kRadius; ++x) {
                ivec2 at = pixel + ivec2(x, y);
                ivec2 inside = clamp(at, ivec2(0), limit);
                uvec4 other = texelFetch(surfaces, inside, 0);
                if (at != inside || other.w == kNoSurface) continue;
                if (texelFetch(beforeSamples, inside, 0).x <= 0.0) continue;
                float weight = edgeWeight(position, normal, uintBitsToFloat(other.xyz),
                                          unpackNormal(other.w), kLeastCos, kMostSlope, footprint);
                if (!(weight > 0.0)) continue;
                vec4 now = texelFetch(source, inside, 0);
                vec4 then = texelFetch(beforeLight, inside, 0);
                difference += weight * (luminance(now.rgb) - luminance(then.rgb));
                noise += weight * weight * (now.a + then.a);
                variance += weight * now.a;
                weights += weight;
            }
        }
        if (weights > 0.0) {
            variance /= weights;
            change2 = changeOfLight(difference / weights, noise / (weights * weights));
        }
    }
    float share = rests(pixel) ? 0.0 : shareOfNew(samples, known, change2, variance);
    // What is not finite is not remembered.
    if (any(isnan(before)) || any(isinf(before))) share = 1.0;
    light = share < 1.0 ? mix(before, own, share) : own;
    light.a = share * share * own.a + (1.0 - share) * (1.0 - share) * before.a;
    if (share == 1.0) light.a = own.a;
    worth = share > 0.0 ? worthOfMean(samples, share, mostSamples) : known;
}
