// Direct light of one punctual light on the G-buffer, with a ray against the scene's triangles
// where its light arrives if nothing stands between.
#include "shaders/passes/bounded_rays.glsl"
#include "shaders/passes/punctual_lights.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/types.glsl"
#ifdef MV_GLOSS
#include "shaders/passes/surface_gloss.glsl"
#else
layout(binding = kUnitAlbedo) uniform sampler2D albedos;
#endif

layout(binding = kUnitPosition) uniform sampler2D positions;
layout(binding = kUnitNormal) uniform sampler2D normals;
layout(binding = kUnitPlane) uniform sampler2D planeNormals;

uniform uint light;   // of the lights
uniform float edgeM;  // metres of the root cube's edge

layout(location = 0) out vec4 radiance;

#ifdef MV_GLOSS
// What narrow gloss reflects towards the eye, 1/sr.
vec3 highlight(NarrowGloss gloss, vec3 position, vec3 toLight) {
    if (!(gloss.share > 0.0)) return vec3(0.0);
    vec3 toEye = directionToEye(position);
    float cosEye = clamp(dot3(gloss.normal, toEye), 0.0, 1.0);
    return ggxBrdf(gloss.atNormal, ggxAlpha(gloss.roughness), gloss.normal, toEye, toLight) *
           gloss.share * glossCompensation(gloss.atNormal, gloss.roughness, cosEye);
}
#endif

void main() {
    radiance = vec4(0.0);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 surface = texelFetch(positions, pixel, 0);
    if (surface.w == 0.0) return;
    vec3 normal = texelFetch(normals, pixel, 0).xyz;
    vec3 way;
    vec3 given = lightIrradiance(fetchLight(light), edgeM, surface.xyz, normal, way);
    if (!(max(given.r, max(given.g, given.b)) > 0.0)) return;
    vec3 plane = normalizeOr(texelFetch(planeNormals, pixel, 0).xyz, normal);
    vec3 passed = shadowRayPassed(surface.xyz, plane, surface.xyz + way);
    if (!(max(passed.r, max(passed.g, passed.b)) > 0.0)) return;
    given *= passed;
    radiance = vec4(texelFetch(albedos, pixel, 0).rgb * given / kPi, 0.0);
#ifdef MV_GLOSS
    vec3 toLight = normalizeOr(way, normal);
    BroadGloss broad = broadGlossAt(pixel, surface.xyz, normal, 0.0);
    radiance.rgb *= broadGlossWeight(broad, normal, toLight);
    radiance.rgb += texelFetch(albedos, pixel, 0).w * given *
                    highlight(narrowGlossAt(pixel, normal), surface.xyz, toLight);
#endif
}
