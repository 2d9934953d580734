// What glossy surfaces reflect: one ray a pixel, drawn along the gloss, and the surface that it
// meets, written as a G-buffer is. Matt there, with what its gloss adds: gloss is followed once.
// MV_THROUGH: what is seen through clear surfaces. They are thin: rays go on as they came, spread
// by roughness as a reflection is.
#include "shaders/passes/bounded_rays.glsl"
#include "shaders/passes/surface_gloss.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/random.glsl"
#ifdef MV_SKY
#include "shaders/passes/sky_seen.glsl"
uniform uint skyRows;
#endif
layout(binding = kUnitPosition) uniform sampler2D positions;
layout(binding = kUnitNormal) uniform sampler2D normals;  // w = depth
layout(binding = kUnitPlane) uniform sampler2D planeNormals;
#ifdef MV_THROUGH
layout(binding = kUnitClear) uniform sampler2D clears;
#endif

uniform uint seed;
uniform uint set;  // of samples

layout(location = 0) out vec4 outPosition;
layout(location = 1) out vec4 outNormalDepth;
layout(location = 2) out vec4 outAlbedo;
layout(location = 3) out vec4 outEmission;
layout(location = 4) out vec4 outPlane;
layout(location = 5) out vec4 outWeight;  // GBuffer::gloss of surfaces that rays met

const float kBeyondScene = 4.0;  // the root cube's diagonal is 1.73

// A pixel's numbers are spread evenly over its sets [Roberts 2018, the R2 sequence].
vec2 numbersOf(ivec2 pixel) {
    vec2 first = random4(seed, uint(pixel.y) << 16u | uint(pixel.x), 0u, kGlossDraw).xy;
    return fract(first + vec2(unitFloat(set * 3242174889u), unitFloat(set * 2447445414u)));
}

void main() {
    outPosition = vec4(0.0);  // no surface
    outNormalDepth = vec4(0.0);
    outAlbedo = vec4(0.0);
    outEmission = vec4(0.0);
    outPlane = vec4(0.0);
    outWeight = vec4(0.0);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
#ifdef MV_THROUGH
    vec4 clear = texelFetch(clears, pixel, 0);
    if (!(max(clear.r, max(clear.g, clear.b)) > 0.0)) return;
#endif

    vec3 position = texelFetch(positions, pixel, 0).xyz;
    vec4 normalDepth = texelFetch(normals, pixel, 0);
    vec3 normal = normalizeOr(normalDepth.xyz, vec3(0.0, 1.0, 0.0));
#ifdef MV_THROUGH
    NarrowGloss gloss = NarrowGloss(vec3(1.0), clear.a, 1.0, normal);
#else
    NarrowGloss gloss = narrowGlossAt(pixel, normal);
    if (!(gloss.share > 0.0)) return;
    normal = gloss.normal;
#endif
    vec3 plane = normalizeOr(texelFetch(planeNormals, pixel, 0).xyz, normal);
    vec3 toEye = directionToEye(position);
    vec2 r = numbersOf(pixel);
    vec3 weight;
    vec3 way =
        ggxReflection(gloss.atNormal, ggxAlpha(gloss.roughness), normal, toEye, r.x, r.y, weight);
    // What is known of all rays is left to the end, so that the filter sees less noise: the ray's
    // own weight over their mean goes with the light it meets.
    float cosEye = clamp(dot3(normal, toEye), 0.0, 1.0);
    vec3 mean = glossReflectance(gloss.atNormal, gloss.roughness, cosEye);
    vec3 own =
        weight * glossCompensation(gloss.atNormal, gloss.roughness, cosEye) / max(mean, vec3(1e-4));
#ifdef MV_THROUGH
    // A reflection mirrored to behind the surface, all of which arrives there.
    vec3 share = clear.rgb;
    own = vec3(1.0);
    way = clear.a > 0.0 ? way - 2.0 * dot3(way, normal) * normal : -toEye;
    plane = -plane;
#else
    vec3 share = texelFetch(albedos, pixel, 0).w * gloss.share * mean;
#endif
    // A normal that leans away from the triangle may send rays into it.
    way -= 2.0 * min(dot3(way, plane), 0.0) * plane;

    float t;
    float u;
    float v;
    uint slot = bvhIntersect(position + plane * kVplOffset, way, 0.0, kBeyondScene, false, t, u, v);
    outWeight = vec4(share, slot == kNone ? kBeyondScene : t);
    if (slot == kNone) {
#ifdef MV_SKY
        outEmission = vec4(own * skySeen(skyRows, way), 1.0);
#endif
        return;
    }
    BvhSurface met = bvhSurface(slot, u, v);
    vec3 geometric = vec3(met.geometricX, met.geometricY, met.geometricZ);
    float side = dot3(geometric, way) > 0.0 ? -1.0 : 1.0;
    outPosition = vec4(met.positionX, met.positionY, met.positionZ, 1.0);
    outNormalDepth = vec4(side * vec3(met.shadingX, met.shadingY, met.shadingZ), normalDepth.w + t);
    outAlbedo = vec4(own * vec3(met.albedoR, met.albedoG, met.albedoB), 1.0);
    bool emits = side > 0.0 || (met.flags & kMaterialDoubleSided) != 0u;
    vec3 emission = vec3(met.emissionR, met.emissionG, met.emissionB);
    outEmission = emits ? vec4(own * emission, 1.0) : vec4(0.0);
    outPlane = vec4(side * geometric, 0.0);
}
