// The gloss of a G-buffer's surfaces: what rays follow of it, and what the light of views, sky and
// lamps is weighed by (microfacet.glsl). MV_COAT: some have a clear coat.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/microfacet.glsl"

layout(binding = kUnitGloss) uniform sampler2D glosses;
layout(binding = kUnitAlbedo) uniform sampler2D albedos;      // w = how much of the surface is seen
layout(binding = kUnitPlane) uniform sampler2D planeNormals;  // w = what gloss reflects at grazing
#ifdef MV_COAT
layout(binding = kUnitCoat) uniform sampler2D coats;
#endif
uniform vec3 seenFrom;  // root-cube units
uniform vec3 forward;
uniform float eyeShare;  // 0: all rays go forward

vec3 directionToEye(vec3 position) {
    return -normalizeOr(mix(forward, position - seenFrom, eyeShare), forward);
}

// The topmost gloss, as far as it is narrow.
struct NarrowGloss {
    vec3 atNormal;
    float atGrazing;
    float roughness;
    float share;  // 0: there is none
    vec3 normal;
};

// pixel: of the G-buffer.
NarrowGloss narrowGlossAt(ivec2 pixel, vec3 normal) {
#ifdef MV_COAT
    vec4 coat = texelFetch(coats, pixel, 0);
    float strength = length3(coat.xyz);
    if (strength > 0.0) {
        return NarrowGloss(vec3(kSpecularOfGlass), 1.0, coat.a, strength, coat.xyz / strength);
    }
#endif
    vec4 gloss = texelFetch(glosses, pixel, 0);
    bool any = max(gloss.r, max(gloss.g, gloss.b)) > 0.0;
    return NarrowGloss(gloss.rgb, texelFetch(planeNormals, pixel, 0).w, gloss.a,
                       any ? glossShare(gloss.a) : 0.0, normal);
}

// leastRoughness: of what lies below a coat and is broad for that alone.
BroadGloss broadGlossAt(ivec2 pixel, vec3 position, vec3 normal, float leastRoughness) {
    vec4 coat = vec4(0.0);
#ifdef MV_COAT
    coat = texelFetch(coats, pixel, 0);
#endif
    return broadGlossOf(texelFetch(albedos, pixel, 0), texelFetch(glosses, pixel, 0),
                        texelFetch(planeNormals, pixel, 0).w, coat, leastRoughness, normal,
                        directionToEye(position));
}
