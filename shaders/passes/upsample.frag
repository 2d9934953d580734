// Irradiance gathered at half resolution -> full resolution, by bilinear weights times the filter's
// own. A pixel none of whose four neighbours shares its surface is gathered here, from all views.
#include "shaders/passes/edges.glsl"
#include "shaders/passes/gather_sum.glsl"

layout(binding = 8) uniform usampler2D surfaces;  // at half resolution
layout(binding = 9) uniform sampler2D positions;  // G-buffer
layout(binding = 10) uniform sampler2D normals;
layout(binding = 11) uniform sampler2D filteredHalf;
layout(binding = 12) uniform sampler2D unfilteredHalf;
layout(binding = 13) uniform sampler2D candidatesHalf;
uniform int scale;

layout(location = 0) out vec4 irradiance;
layout(location = 1) out vec4 unfiltered;
layout(location = 2) out float candidates;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 position = texelFetch(positions, pixel, 0);
    bool present = position.w != 0.0;
    vec3 normal = normalizeOr(texelFetch(normals, pixel, 0).xyz, vec3(0.0, 1.0, 0.0));
    ivec2 limit = textureSize(surfaces, 0) - 1;

    vec2 place = (vec2(pixel) + 0.5) / float(scale) - 0.5;
    ivec2 base = ivec2(floor(place));
    vec2 part = place - vec2(base);
    vec3 sum = vec3(0.0);
    vec3 noisy = vec3(0.0);
    float weights = 0.0;
    for (int tap = 0; tap < 4; ++tap) {
        ivec2 corner = ivec2(tap & 1, tap >> 1);
        ivec2 at = clamp(base + corner, ivec2(0), limit);
        uvec4 other = texelFetch(surfaces, at, 0);
        float weight = (corner.x == 1 ? part.x : 1.0 - part.x) *
                       (corner.y == 1 ? part.y : 1.0 - part.y) *
                       edgeWeight(position.xyz, normal, uintBitsToFloat(other.xyz),
                                  unpackNormal(other.w));
        vec3 value = texelFetch(filteredHalf, at, 0).rgb;
        vec3 raw = texelFetch(unfilteredHalf, at, 0).rgb;
        if (other.w != kNoSurface && weight > 0.0) {
            sum += value * weight;
            noisy += raw * weight;
            weights += weight;
        }
    }
    bool alone = present && weights < 1e-3;
    uvec4 list = texelFetch(lists, 0);
    Gathered own = gatherSum(0u, list, position.xyz, normal, uvec2(pixel), alone);
    float inverse = weights > 0.0 ? 1.0 / weights : 0.0;
    float alpha = present ? 1.0 : 0.0;
    irradiance = vec4(alone ? own.clamped : sum * inverse, 1.0) * alpha;
    unfiltered = vec4(alone ? own.clamped : noisy * inverse, 1.0) * alpha;
    candidates = alpha * texelFetch(candidatesHalf, min(pixel / scale, limit), 0).x;
}
