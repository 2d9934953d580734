// Gathers a pixel of the G-buffer for itself, from all views, where no pixel of a gather at a lower
// resolution shares its surface. Biased: what the clamp takes here is not given back, as the near
// field's rays do for the gather's own pixels.
#include "shaders/passes/gather_own.glsl"
#include "shaders/shared/bindings.glsl"

layout(binding = kUnitPosition) uniform sampler2D positions;  // G-buffer
layout(binding = kUnitNormal) uniform sampler2D normals;

vec3 gatherAlone(ivec2 pixel) {
    vec3 position = texelFetch(positions, pixel, 0).xyz;
    vec3 normal = normalizeOr(texelFetch(normals, pixel, 0).xyz, vec3(0.0, 1.0, 0.0));
    beginReceiver(pixel, position, normal, normal);
    uvec4 list = texelFetch(lists, 0);
    return gatherSum(0u, list, position, normal, uvec2(pixel), true,
                     samples == 0u ? 0u : max(samples, kAloneSamples), kOwnCandidates)
        .clamped;
}
