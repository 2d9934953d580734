// Direct light of one punctual light on the G-buffer, with a ray against the scene's triangles
// where its light arrives if nothing stands between.
#include "shaders/passes/bounded_rays.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/light.glsl"
#include "shaders/shared/types.glsl"
#ifdef MV_GLOSS
#include "shaders/passes/surface_gloss.glsl"
#else
layout(binding = kUnitAlbedo) uniform sampler2D albedos;
#endif

layout(binding = kUnitPosition) uniform sampler2D positions;
layout(binding = kUnitNormal) uniform sampler2D normals;
layout(binding = kUnitPlane) uniform sampler2D planeNormals;

uniform uint type;       // kLightPoint, ...
uniform vec3 place;      // root-cube units; of no sun
uniform vec3 direction;  // of spot and sun
uniform vec3 intensity;  // W/sr, sun: W/m^2
uniform float cosInner;  // of a spot's cones
uniform float cosOuter;
uniform float edgeM;  // metres of the root cube's edge

layout(location = 0) out vec4 radiance;

// As far away as a light counts that is nearer, or on the very surface.
const float kLeastDistance = 1e-4;
const float kBeyondScene = 2.0;  // the root cube's diagonal is 1.73

// W/m^2 on a surface that nothing stands before.
vec3 unshadowed(vec3 way, vec3 normal) {
    float distance = length(way);
    vec3 light = intensity * max(dot(normal, way) / max(distance, 1e-20), 0.0);
    if (type == kLightDirectional) return light;
    float metres = max(distance, kLeastDistance) * edgeM;
    light /= metres * metres;
    if (type != kLightSpot) return light;
    float cosAxis = -dot(way, direction) / max(distance, 1e-20);
    return light * spotFalloff(cosAxis, cosInner, cosOuter);
}

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
    vec3 way = type == kLightDirectional ? -direction * kBeyondScene : place - surface.xyz;
    vec3 light = unshadowed(way, normal);
    if (!(max(light.r, max(light.g, light.b)) > 0.0)) return;
    vec3 plane = normalizeOr(texelFetch(planeNormals, pixel, 0).xyz, normal);
    if (shadowRayBlocked(surface.xyz, plane, surface.xyz + way)) return;
    radiance = vec4(texelFetch(albedos, pixel, 0).rgb * light / kPi, 0.0);
#ifdef MV_GLOSS
    vec3 toLight = normalizeOr(way, normal);
    BroadGloss broad = broadGlossAt(pixel, surface.xyz, normal, 0.0);
    radiance.rgb *= broadGlossWeight(broad, normal, toLight);
    radiance.rgb += texelFetch(albedos, pixel, 0).w * light *
                    highlight(narrowGlossAt(pixel, normal), surface.xyz, toLight);
#endif
}
