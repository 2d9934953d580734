// What the frame before knew of the surface that a pixel shows: its light where the surface stood
// then, though it may have moved by itself, by bilinear weights times those of edges. None where it
// was not in sight.
#include "shaders/passes/edges.glsl"
#include "shaders/shared/bindings.glsl"
#ifdef MV_MOVES
#include "shaders/shared/motion.glsl"
layout(binding = kUnitPosition) uniform sampler2D positions;  // G-buffer
uniform float largestStep;                                    // GBuffer::largestStep
#endif

layout(binding = kUnitSurfaces) uniform usampler2D surfaces;  // of this frame
layout(binding = kUnitNormal) uniform sampler2D normals;      // G-buffer: w = depth
layout(binding = kUnitRememberedSurfaces) uniform usampler2D oldSurfaces;
layout(binding = kUnitRememberedLight) uniform sampler2D oldLight;
layout(binding = kUnitRememberedSamples) uniform sampler2D oldSamples;
// The frame before had this camera and G-buffer, and so many of its pixels, each way, had
// one of the gather's, which stands for the first of them.
uniform mat4 clipFromRoot;
uniform ivec2 oldPixels;
uniform int oldScale;
uniform int scale;  // G-buffer pixels a pixel, each way, of this frame

layout(location = 0) out vec4 light;  // a: the variance of its luminance
layout(location = 1) out float samples;

// It must be the same surface.
const float kLeastCos = 0.5;
const float kMostSlope = 0.1;
const float kLeastWeight = 0.05;

void main() {
    light = vec4(0.0);
    samples = 0.0;
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec4 surface = texelFetch(surfaces, pixel, 0);
    if (surface.w == kNoSurface) return;
    vec3 position = uintBitsToFloat(surface.xyz);
    vec3 normal = unpackNormal(surface.w);
#ifdef MV_MOVES
    // The pixel of the G-buffer that this one stands for has the same place.
    for (int i = 0; i < scale * scale; ++i) {
        ivec2 at = min(pixel * scale + ivec2(i % scale, i / scale), textureSize(positions, 0) - 1);
        vec4 marked = texelFetch(positions, at, 0);
        if (marked.w == 0.0 || marked.xyz != position) continue;
        position += stepOfMark(marked.w, largestStep);
        break;
    }
#endif
    vec4 clip = clipFromRoot * vec4(position, 1.0);
    if (!(clip.w > 0.0)) return;
    ivec2 oldSize = textureSize(oldSurfaces, 0);
    vec2 seen = clip.xy / clip.w * 0.5 + 0.5;
    if (any(lessThan(seen, vec2(0.0))) || any(greaterThan(seen, vec2(1.0)))) return;
    vec2 place = (seen * vec2(oldPixels) - 0.5) / float(oldScale);
    ivec2 limit = textureSize(normals, 0) - 1;
    float depth = texelFetch(normals, min(pixel * scale, limit), 0).w;
    float tolerance = 0.4 * float(scale) * pixelFootprint(depth);

    ivec2 base = ivec2(floor(place));
    vec2 part = place - vec2(base);
    float weights = 0.0;
    for (int tap = 0; tap < 4; ++tap) {
        ivec2 corner = ivec2(tap & 1, tap >> 1);
        ivec2 at = clamp(base + corner, ivec2(0), oldSize - 1);
        uvec4 other = texelFetch(oldSurfaces, at, 0);
        if (other.w == kNoSurface) continue;
        vec2 near = 1.0 - abs(vec2(corner) - part);
        float weight = near.x * near.y *
                       edgeWeight(position, normal, uintBitsToFloat(other.xyz),
                                  unpackNormal(other.w), kLeastCos, kMostSlope, tolerance);
        if (!(weight > 0.0)) continue;
        light += texelFetch(oldLight, at, 0) * weight;
        samples += texelFetch(oldSamples, at, 0).x * weight;
        weights += weight;
    }
    if (weights < kLeastWeight) {
        light = vec4(0.0);
        samples = 0.0;
        return;
    }
    light /= weights;
    samples /= weights;
}
