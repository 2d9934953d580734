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
layout(binding = kUnitPlane) uniform sampler2D planeNormals;
#endif

layout(binding = kUnitPosition) uniform sampler2D positions;
layout(binding = kUnitNormal) uniform sampler2D normals;

uniform uint light;   // of the lights
uniform float edgeM;  // metres of the root cube's edge

layout(location = 0) out vec4 radiance;

#ifdef MV_GLOSS
// What narrow gloss reflects towards the eye, 1/sr.
vec3 highlight(NarrowGloss gloss, vec3 position, vec3 toLight) {
    if (!(gloss.share > 0.0)) return vec3(0.0);
    vec3 toEye = directionToEye(position);
    float cosEye = clamp(dot3(gloss.normal, toEye), 0.0, 1.0);
    return ggxBrdf(gloss.atNormal, gloss.atGrazing, ggxAlpha(gloss.roughness), gloss.normal, toEye,
                   toLight) *
           gloss.share * glossCompensation(gloss.atNormal, gloss.roughness, cosEye);
}
#endif

#ifdef MV_CLEAR
layout(binding = kUnitClear) uniform sampler2D clears;

// What rough glass lets through of a light behind it, which none of the rays of sight meets: as
// many of them as go its way (reflect.frag).
vec3 throughGlass(ivec2 pixel, vec3 position, vec3 normal, vec3 plane) {
    vec4 clear = texelFetch(clears, pixel, 0);
    if (!(clear.a > 0.0)) return vec3(0.0);
    vec3 way;
    lightIrradiance(fetchLight(light), edgeM, position, normal, way);
    vec3 toLight = normalizeOr(way, -normal);
    float behind = -dot3(toLight, normal);
    if (!(behind > 0.0) || dot3(toLight, plane) >= 0.0) return vec3(0.0);
    vec3 given = lightIrradiance(fetchLight(light), edgeM, position, toLight, way);
    vec3 mirrored = toLight + 2.0 * behind * normal;
    float density =
        ggxReflectionDensity(ggxAlpha(clear.a), normal, directionToEye(position), mirrored);
    return clear.rgb * given * shadowRayPassed(position, -plane, position + way) * density;
}
#endif

void main() {
    radiance = vec4(0.0);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 surface = texelFetch(positions, pixel, 0);
    if (surface.w == 0.0) return;
    vec3 normal = texelFetch(normals, pixel, 0).xyz;
    vec3 plane = normalizeOr(texelFetch(planeNormals, pixel, 0).xyz, normal);
#ifdef MV_CLEAR
    radiance.rgb = throughGlass(pixel, surface.xyz, normal, plane);
#endif
    vec3 way;
    vec3 given = lightIrradiance(fetchLight(light), edgeM, surface.xyz, normal, way);
    vec3 any = given;
#ifdef MV_GLOSS
    NarrowGloss gloss = narrowGlossAt(pixel, normal);
    vec3 givenToGloss = lightIrradiance(fetchLight(light), edgeM, surface.xyz, gloss.normal, way);
    any = max(any, givenToGloss);
#endif
    if (!(max(any.r, max(any.g, any.b)) > 0.0)) return;
    vec3 passed = shadowRayPassed(surface.xyz, plane, surface.xyz + way);
    if (!(max(passed.r, max(passed.g, passed.b)) > 0.0)) return;
    vec3 matt = texelFetch(albedos, pixel, 0).rgb * given * passed / kPi;
#ifdef MV_GLOSS
    vec3 toLight = normalizeOr(way, normal);
    BroadGloss broad = broadGlossAt(pixel, surface.xyz, normal, 0.0);
    matt *= broadGlossWeight(broad, normal, toLight);
    radiance.rgb += texelFetch(albedos, pixel, 0).w * givenToGloss * passed *
                    highlight(gloss, surface.xyz, toLight);
#endif
    radiance.rgb += matt;
}
