// The gloss of a G-buffer's surfaces that no ray follows (BroadGloss), for passes that light them.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/microfacet.glsl"

layout(binding = kUnitGloss) uniform sampler2D glosses;
layout(binding = kUnitLitAlbedo) uniform sampler2D litAlbedos;  // w = how much is seen
uniform vec3 seenFrom;                                          // root-cube units
uniform vec3 forward;
uniform float eyeShare;  // 0: all rays go forward

// pixel: of the G-buffer.
BroadGloss broadGlossAt(ivec2 pixel, vec3 position, vec3 normal) {
    vec4 albedo = texelFetch(litAlbedos, pixel, 0);
    vec4 gloss = texelFetch(glosses, pixel, 0);
    vec3 toEye = -normalizeOr(mix(forward, position - seenFrom, eyeShare), forward);
    return broadGloss(gloss.rgb, gloss.a, albedo.w, albedo.rgb, normal, toEye);
}
