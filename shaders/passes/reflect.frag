// What glossy surfaces reflect: one ray a pixel, drawn along the gloss, and the surface that it
// meets, written as a G-buffer is. Matt there, with what its gloss adds: gloss is followed once,
// but for mirrors (MV_MIRRORS), from which the ray goes on. What it passes that is clear tints it.
// MV_LAMPS: a point of an emissive surface is asked beside it, since rays seldom meet small lamps.
// MV_THROUGH: what is seen through clear surfaces. Through thin ones rays go on as they came,
// spread by roughness as a reflection is. MV_FILLED: some are filled, and rays bend going in and
// out, reflected ones too.
#define MV_BVH_SIGHT true
#ifdef MV_FILLED
bool meetsFilled = false;
#define MV_BVH_MEETS_FILLED meetsFilled
#endif
#include "shaders/passes/bounded_rays.glsl"
#include "shaders/passes/surface_gloss.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/light.glsl"
#include "shaders/shared/random.glsl"
#ifdef MV_SKY
#include "shaders/passes/sky_seen.glsl"
uniform uint skyRows;
#endif
layout(binding = kUnitPosition) uniform sampler2D positions;
layout(binding = kUnitNormal) uniform sampler2D normals;  // w = depth
#ifdef MV_THROUGH
layout(binding = kUnitClear) uniform sampler2D clears;
#endif
#if defined(MV_THROUGH) && defined(MV_FILLED)
layout(binding = kUnitEmission) uniform sampler2D emissions;
#endif
#ifdef MV_LAMPS
#include "shaders/shared/vpl.glsl"
uniform uint lampTriangles;
uniform float lampDensity;  // of their points: a unit of luminance, 1/m^2 of the lamp
uniform float rootEdge2;    // m^2
#endif

uniform float emissionScale;  // of surfaces
uniform uint seed;
uniform uint set;  // of samples

layout(location = 0) out vec4 outPosition;
layout(location = 1) out vec4 outNormalDepth;
layout(location = 2) out vec4 outAlbedo;
layout(location = 3) out vec4 outEmission;
layout(location = 4) out vec4 outPlane;
layout(location = 5) out vec4 outWeight;  // GBuffer::gloss of surfaces that rays met

#ifdef MV_LAMPS
// Density, 1/sr, with which lamps' points are drawn. distance2: root-cube units.
float lampPointDensity(vec3 emission, float cosine, float distance2) {
    return luminance(emission) * lampDensity * distance2 * rootEdge2 / max(abs(cosine), 1e-6);
}

// The weight of what was drawn with density `own` and could have been with `other` [Veach and
// Guibas 1995, power heuristic].
float powerHeuristic(float own, float other) {
    float ratio = other / max(own, 1e-20);
    return 1.0 / (1.0 + ratio * ratio);
}

// What a point of a lamp gives the eye by the gloss.
vec3 reflectedLamp(NarrowGloss gloss, float alpha, vec3 from, vec3 normal, vec3 plane, vec3 toEye,
                   ivec2 pixel) {
    vec4 r = random4(seed, uint(pixel.y) << 16u | uint(pixel.x), set, kGlossLampDraw);
    vec3 at;
    vec3 lampNormal;
    vec3 emission;
    float area;
    float sides;
    float probability;
    vplLampPoint(lampTriangles, r, 1.0, at, lampNormal, emission, area, sides, probability);
    if (sides > 1.0 && dot3(lampNormal, from - at) < 0.0) {  // the side that is seen
        at -= 2.0 * kVplOffset * lampNormal;
        lampNormal = -lampNormal;
    }
    vec3 way = at - from;
    float distance2 = max(dot3(way, way), 1e-12);
    vec3 toLamp = way * inversesqrt(distance2);
    float cosLamp = -dot3(lampNormal, toLamp);
    float cosHere = dot3(normal, toLamp);
    bool faces = cosLamp > 0.0 && cosHere > 0.0 && dot3(plane, toLamp) > 0.0;
    if (!faces || !(luminance(emission) > 0.0)) return vec3(0.0);
    vec3 passed = bvhPassed(from, way, 0.0, 1.0);
    if (!(luminance(passed) > 0.0)) return vec3(0.0);
    float lamps = lampPointDensity(emission, cosLamp, distance2);
    float share = powerHeuristic(lamps, ggxReflectionDensity(alpha, normal, toEye, toLamp));
    return ggxBrdf(gloss.atNormal, gloss.atGrazing, alpha, normal, toEye, toLamp) * emission *
           passed *
           (cosHere * cosLamp * area * share / (max(probability, 1e-30) * distance2 * rootEdge2));
}
#endif

// A pixel's numbers are spread evenly over its sets [Roberts 2018, the R2 sequence], whose steps
// are 2^32 by the plastic number, 1.3247, and by its square.
const uint kR2Step = 3242174889u;
const uint kR2SecondStep = 2447445414u;
vec2 numbersOf(ivec2 pixel) {
    vec2 first = random4(seed, uint(pixel.y) << 16u | uint(pixel.x), 0u, kGlossDraw).xy;
    return fract(first + vec2(unitFloat(set * kR2Step), unitFloat(set * kR2SecondStep)));
}

// The pixel, and the ray that follows its gloss or goes on through it.
ivec2 pixel;
vec3 position, normal, plane, toEye;
float depth;
NarrowGloss gloss;
float alpha;
vec3 way;
vec3 share;  // of the light of all its rays that comes back
vec3 gain;   // of light that arrives by the gloss, over that share
vec3 own;    // this ray's weight, over that share
#ifdef MV_LAMPS
bool asks;
float ofRay;  // density with which its direction was drawn, 1/sr
#endif

void writeNoSurface() {
    outPosition = vec4(0.0);
    outNormalDepth = vec4(0.0);
    outAlbedo = vec4(0.0);
    outEmission = vec4(0.0);
    outPlane = vec4(0.0);
    outWeight = vec4(0.0);
}

// Whether there is anything to follow.
bool beginPixel() {
    pixel = ivec2(gl_FragCoord.xy);
    position = texelFetch(positions, pixel, 0).xyz;
    vec4 normalDepth = texelFetch(normals, pixel, 0);
    normal = normalizeOr(normalDepth.xyz, vec3(0.0, 1.0, 0.0));
    depth = normalDepth.w;
#ifdef MV_THROUGH
    vec4 clear = texelFetch(clears, pixel, 0);
    if (!(max(clear.r, max(clear.g, clear.b)) > 0.0)) return false;
    gloss = NarrowGloss(vec3(1.0), 1.0, clear.a, 1.0, normal);
    share = clear.rgb;
#else
    gloss = narrowGlossAt(pixel, normal);
    if (!(gloss.share > 0.0)) return false;
    normal = gloss.normal;
#endif
    plane = normalizeOr(texelFetch(planeNormals, pixel, 0).xyz, normal);
    toEye = directionToEye(position);
    alpha = ggxRayAlpha(gloss.roughness);
    return true;
}

void drawRay() {
    vec2 r = numbersOf(pixel);
    vec3 weight;
    way = ggxReflection(gloss.atNormal, gloss.atGrazing, alpha, normal, toEye, r.x, r.y, weight);
    // What is known of all rays is left to the end, so that the filter sees less noise: the ray's
    // own weight over their mean goes with the light it meets.
    float cosEye = clamp(dot3(normal, toEye), 0.0, 1.0);
    vec3 mean = glossReflectance(gloss.atNormal, gloss.atGrazing, gloss.roughness, cosEye);
    gain = glossCompensation(gloss.atNormal, gloss.roughness, cosEye) / max(mean, vec3(1e-4));
    own = weight * gain;
#ifdef MV_LAMPS
    asks = gloss.roughness > kLampGloss;
    ofRay = ggxReflectionDensity(alpha, normal, toEye, way);
#endif
#ifdef MV_THROUGH
    // A reflection mirrored to behind the surface, all of which arrives there.
    own = vec3(1.0);
    way = gloss.roughness > 0.0 ? way - 2.0 * dot3(way, normal) * normal : -toEye;
    plane = -plane;
#else
    share = texelFetch(albedos, pixel, 0).w * gloss.share * mean;
#endif
    // A normal that leans away from the triangle may send rays into it.
    way -= 2.0 * min(dot3(way, plane), 0.0) * plane;
}

void askLamp() {
#ifdef MV_LAMPS
    if (!asks) return;
    vec3 from = position + plane * bvhLift();
    vec3 light = reflectedLamp(gloss, alpha, from, normal, plane, toEye, pixel);
    outEmission = vec4(gain * emissionScale * light, 1.0);
#endif
}

// t: along the ray.
void writeSurface(BvhSurface met, float t) {
    vec3 geometric = vec3(met.geometricX, met.geometricY, met.geometricZ);
    float side = dot3(geometric, way) > 0.0 ? -1.0 : 1.0;
    outPosition = vec4(met.positionX, met.positionY, met.positionZ, 1.0);
    outNormalDepth = vec4(side * vec3(met.shadingX, met.shadingY, met.shadingZ), depth + t);
    outAlbedo = vec4(own * vec3(met.albedoR, met.albedoG, met.albedoB), 1.0);
    outPlane = vec4(side * geometric, 0.0);
    if (side < 0.0 && (met.flags & kMaterialDoubleSided) == 0u) return;
    vec3 radiance = vec3(met.emissionR, met.emissionG, met.emissionB);
    vec3 emission = own * emissionScale * radiance;
#ifdef MV_LAMPS
    if (asks) {
        float lamps = lampPointDensity(radiance, dot3(geometric, way), t * t);
        emission *= powerHeuristic(ofRay, lamps);
    }
#endif
    outEmission += vec4(emission, 1.0);
}

#ifdef MV_FILLED
// The way goes on through a face whose normals lean against it, by Snell's law; where nothing gets
// out, it turns back: false.
bool crossFace(vec3 shading, vec3 geometric, float ratio) {
    vec3 n = dot3(shading, way) < 0.0 ? shading : geometric;
    vec3 on = refract(way, n, ratio);
    bool through = dot3(on, on) > 0.0;
    way = through ? on : reflect(way, n);
    float past = dot3(way, geometric);
    way -= 2.0 * (through ? max(past, 0.0) : min(past, 0.0)) * geometric;
    return through;
}
#endif

// The next surface along the ray, whose weight takes the colour of what is clear on the way.
uint meetNext(vec3 from, out float t, out float u, out float v) {
    vec3 passed;
    uint slot = bvhIntersectTinted(from, way, 0.0, kBeyondScene, t, u, v, passed);
    own *= passed;
    return slot;
}

#if defined(MV_FILLED) || defined(MV_MIRRORS)
#define MV_TURNS
// Of what is filled in and out at each face, and on from mirrors; after so many turns straight
// through, and mirrors are as matt.
const uint kMostTurns = 8u;
uint follow(out float t, out float u, out float v) {
    vec3 from = position + plane * bvhLift();
#ifdef MV_FILLED
    float index = 0.0;  // of what the ray is in
    bool inside = false;
#ifdef MV_THROUGH
    index = texelFetch(emissions, pixel, 0).w;
    inside = index > 0.0;
    if (inside) crossFace(normal, -plane, 1.0 / index);
#endif
#endif
    float before = 0.0;
    uint turns = 0u;
    uint slot;
    bool turned;
    do {
        bool mayTurn = turns < kMostTurns;
#ifdef MV_FILLED
        meetsFilled = mayTurn;
#endif
        slot = meetNext(from, t, u, v);
        turned = false;
        if (slot != kNone && mayTurn) {
            BvhSurface met = bvhSurface(slot, u, v);
            vec3 albedo = vec3(met.albedoR, met.albedoG, met.albedoB);
            vec3 geometric = vec3(met.geometricX, met.geometricY, met.geometricZ);
            float side = dot3(geometric, way) > 0.0 ? -1.0 : 1.0;
            geometric *= side;
            vec3 shading = side * vec3(met.shadingX, met.shadingY, met.shadingZ);
            bool through = false;
#ifdef MV_FILLED
            float filled = bvhFilledIndex(met.material);
            if (filled > 0.0) {
                turned = true;
                through = crossFace(shading, geometric, inside ? index : 1.0 / filled);
                if (through) {
                    if (!inside) own *= albedo;
                    index = filled;
                    inside = !inside;
                }
            }
#endif
#ifdef MV_MIRRORS
            if (!turned && (met.flags & kMaterialMirrors) != 0u) {
                turned = true;
#ifdef MV_LAMPS
                asks = false;  // lamps were asked on the straight way
#endif
                own *= albedo;
                way = reflect(way, dot3(shading, way) < 0.0 ? shading : geometric);
                way -= 2.0 * min(dot3(way, geometric), 0.0) * geometric;
            }
#endif
            if (turned) {
                from = vec3(met.positionX, met.positionY, met.positionZ) +
                       (through ? -bvhLift() : bvhLift()) * geometric;
                before += t;
                ++turns;
            }
        }
    } while (turned);
    t += before;
    return slot;
}
#endif

void main() {
    writeNoSurface();
    if (!beginPixel()) return;
    drawRay();
    askLamp();
    float t, u, v;
#ifdef MV_TURNS
    uint slot = follow(t, u, v);
#else
    uint slot = meetNext(position + plane * bvhLift(), t, u, v);
#endif
    outWeight = vec4(share, slot == kNone ? kBeyondScene : t);
    if (slot != kNone) {
        writeSurface(bvhSurface(slot, u, v), t);
        return;
    }
#ifdef MV_SKY
    outEmission += vec4(own * skySeen(skyRows, way), 1.0);
#endif
}
