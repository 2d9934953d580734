// Shooting virtual point lights [Kol19 §4.1], [Kel97]: emission from punctual lights, the sky and
// emissive surfaces, a VPL at each bounce, diffuse reflection without roulette. The same lines run
// in shaders/passes/trace_vpls.comp (one invocation a path) and in megaviews/views.
//
// Slots. The first `surfaceSlots` are bounce-0 VPLs on emitters, for their direct light; then
// path p's VPL after segment k = 1..bounces lies at surfaceSlots + p * bounces + k - 1.
// Random numbers hash (seed, path, bounce, dimension), so a slot keeps them from frame to frame.
// Random choices and directions use only + - * / sqrt: C++ and any IEEE GPU shoot the same bits.
//
// Guide. The square of random numbers that choose where a path leaves a light is cut into cells,
// and each cell chosen by what paths through it are worth (megaviews/views/view_guide.h).
//
// Include as bvh.glsl: functions take MV_VPL_PARAMS, callers pass MV_VPL_ARGS. GLSL: three buffer
// textures from unit kUnitLights on: lights, emissive triangles, both RGBA32UI, and the guide's
// running shares, R32F; and the uniform block VplSetupBlock.
#ifndef MV_VPL_GLSL
#define MV_VPL_GLSL
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/bvh.glsl"
#include "shaders/shared/light.glsl"
#include "shaders/shared/random.glsl"
#include "shaders/shared/sampling.glsl"
#include "shaders/shared/sky.glsl"

MV_BEGIN_NAMESPACE

// A frame's constants, 80 bytes.
struct VplSetup {
    uint count;    // slots in all
    uint bounces;  // VPLs a path, >= 1
    uint paths;
    uint surfaceSlots;  // bounce-0 VPLs; 0 without emissive surfaces
    uint seed;
    uint lightCount;
    uint emissiveCount;
    float emissionScale;              // of emissive surfaces
    float centerX, centerY, centerZ;  // of the scene's bounding sphere, root-cube units
    float radius;
    uint guideCells;  // 0: paths follow the lights' power alone
    uint guideBits;   // each light has 2^bits x 2^bits cells
    uint skyRows;     // of its table; 0: no sky
    float skyAreaM2;  // of the disc that its light comes through, from each direction
    // Around what the camera sees; radius 0: nowhere in particular.
    float regionX, regionY, regionZ;
    float regionRadius;
};

MV_CONST float kVplFar = 1e30f;
MV_CONST float kVplWide = 0.7f;  // of the scene's radius: no narrow disc is as wide

// `dimension` of random4; each names the draw of one purpose.
MV_CONST uint kVplDrawEmit = 0u;  // choice of light, direction or point
MV_CONST uint kVplDrawEmitMore = 1u;
MV_CONST uint kVplDrawEmitDirection = 2u;  // from an emissive surface
MV_CONST uint kVplDrawScatter = 3u;
MV_CONST uint kVplDrawSurface = 5u;  // bounce-0 VPLs, beside lampNumbers(): `path` is the slot

#ifdef __cplusplus
struct VplData {
    VplSetup setup;
    const LightRecord* lights = nullptr;
    const EmissiveTriangle* emissive = nullptr;
    const float* guide = nullptr;
    const SkyTexel* sky = nullptr;
};
#define MV_VPL_PARAMS const VplData &vpl, const BvhData &bvh,
#define MV_VPL_ARGS vpl, bvh,
#define MV_VPL_SETUP vpl.setup
#define MV_VPL_SKY_ARGS vpl.sky,
inline uvec4 vplLightTexel(const VplData& vpl, const BvhData&, uint i) {
    return bvhTexelAt(vpl.lights, i);
}
inline uvec4 vplEmissiveTexel(const VplData& vpl, const BvhData&, uint i) {
    return bvhTexelAt(vpl.emissive, i);
}
inline float vplGuideTexel(const VplData& vpl, const BvhData&, uint i) { return vpl.guide[i]; }
#else
#define MV_VPL_PARAMS
#define MV_VPL_ARGS
#define MV_VPL_SETUP vplSetup
#define MV_VPL_SKY_ARGS
layout(binding = kUnitLights + 0) uniform usamplerBuffer vplLightTexels;
layout(binding = kUnitLights + 1) uniform usamplerBuffer vplEmissiveTexels;
layout(binding = kUnitLights + 2) uniform samplerBuffer vplGuideTexels;
layout(std140, binding = kUniformVplSetup) uniform VplSetupBlock { VplSetup vplSetup; };
uvec4 vplLightTexel(uint i) { return texelFetch(vplLightTexels, int(i)); }
uvec4 vplEmissiveTexel(uint i) { return texelFetch(vplEmissiveTexels, int(i)); }
float vplGuideTexel(uint i) { return texelFetch(vplGuideTexels, int(i)).x; }
#endif

// ---------------------------------------------------------------- emission

// A point on one of `count` emissive triangles, lifted off it, and its radiance, zero where a mask
// or a texture leaves nothing: drawn with a density of probability / areaM2. Emission is one-sided
// along the geometric normal unless the material is double-sided, sides = 2; the side is then that
// of sideChoice.
MV_FN void vplLampPoint(MV_VPL_PARAMS uint count, vec4 r, float sideChoice, MV_OUT(vec3) position,
                        MV_OUT(vec3) normal, MV_OUT(vec3) emission, MV_OUT(float) areaM2,
                        MV_OUT(float) sides, MV_OUT(float) probability) {
    // The first triangle whose running share exceeds r.x.
    uint low = 0u;
    uint high = count - 1u;
    MV_FIND_FIRST(low, high, middle, r.x < uintBitsToFloat(vplEmissiveTexel(MV_VPL_ARGS middle).y));
    uvec4 emitter = vplEmissiveTexel(MV_VPL_ARGS low);
    probability = uintBitsToFloat(emitter.z);

    // Uniform over its area.
    MV_PRECISE float s = sqrt(r.y);
    MV_PRECISE float u = s * (1.0f - r.z);
    MV_PRECISE float v = s * r.z;
    BvhSurface surface = bvhSurface(MV_BVH_ARGS emitter.x, u, v);
    bool twoSided = (surface.flags & kMaterialDoubleSided) != 0u;
    normal = vec3(surface.geometricX, surface.geometricY, surface.geometricZ);
    if (twoSided && sideChoice < 0.5f) normal = -normal;
    MV_PRECISE vec3 lifted =
        vec3(surface.positionX, surface.positionY, surface.positionZ) + normal * kVplOffset;
    position = lifted;
    areaM2 = uintBitsToFloat(emitter.w);
    sides = twoSided ? 2.0f : 1.0f;
    emission = vec3(surface.emissionR, surface.emissionG, surface.emissionB);
#if MV_BVH_MASKS
    uvec4 tb = bvhTriangleTexel(MV_BVH_ARGS 3u * emitter.x + 1u);
    if ((tb.w & kMaterialMask) != 0u &&
        bvhMaskedOut(MV_BVH_ARGS surface.triangle, surface.material, u, v)) {
        emission = vec3(0.0f);
    }
#endif
}

// The same with the flux W of one sample (as if it were the only one): pi * area * radiance /
// probability.
MV_FN void vplEmissivePoint(MV_VPL_PARAMS vec4 r, float sideChoice, MV_OUT(vec3) position,
                            MV_OUT(vec3) normal, MV_OUT(vec3) flux) {
    vec3 emission;
    float area;
    float sides;
    float probability;
    vplLampPoint(MV_VPL_ARGS MV_VPL_SETUP.emissiveCount, r, sideChoice, position, normal, emission,
                 area, sides, probability);
    MV_PRECISE float weight =
        kPi * area * sides * MV_VPL_SETUP.emissionScale / max(probability, 1e-30f);
    flux = emission * weight;
}

// Where a path begins: the light, lightCount for the emissive surfaces; where in the unit squares
// of its random numbers; and 1 / probability density of that choice.
struct VplChoice {
    uint light;
    float emitU, emitV;  // of a light: direction, or place on the disc; of the sky emitU: its cell
    float pick;          // of surfaces: the triangle
    float turnU, turnV;  // of surfaces: direction; of the sky: place on the disc
    float weight;
};

// Part `cell` of 2^bits of the unit interval. Below 1 even where the sum rounds up.
MV_FN float vplInCell(float u, uint cell, uint bits) {
    MV_PRECISE float x = (float(cell) + u) / float(1u << bits);
    return min(x, 0.99999994f);
}

// Every light is chosen with the probability its running share says; what the shares leave below 1
// belongs to the emissive surfaces.
MV_FN VplChoice vplChooseByPower(MV_VPL_PARAMS float u, VplChoice choice) {
    uint lightCount = MV_VPL_SETUP.lightCount;
    uint low = 0u;
    uint high = lightCount;
    MV_FIND_FIRST(low, high, middle,
                  u < uintBitsToFloat(vplLightTexel(MV_VPL_ARGS 4u * middle + 3u).w));
    float before = 0.0f;
    float until = 1.0f;
    if (low > 0u) before = uintBitsToFloat(vplLightTexel(MV_VPL_ARGS 4u * low - 1u).w);
    if (low < lightCount) until = uintBitsToFloat(vplLightTexel(MV_VPL_ARGS 4u * low + 3u).w);
    choice.light = low;
    choice.weight = until - before;
    return choice;
}

// Every cell of every light is chosen with the probability that the guide's running share says.
MV_FN VplChoice vplChooseByGuide(MV_VPL_PARAMS float u, VplChoice choice) {
    uint low = 0u;
    uint high = MV_VPL_SETUP.guideCells - 1u;
    MV_FIND_FIRST(low, high, middle, u < vplGuideTexel(MV_VPL_ARGS middle));
    float before = 0.0f;
    if (low > 0u) before = vplGuideTexel(MV_VPL_ARGS low - 1u);
    uint bits = MV_VPL_SETUP.guideBits;
    uint mask = (1u << bits) - 1u;
    choice.light = low >> (2u * bits);
    choice.weight = (vplGuideTexel(MV_VPL_ARGS low) - before) * float(1u << (2u * bits));
    uint column = low & mask;
    uint row = (low >> bits) & mask;
    bool ofSky = MV_VPL_SETUP.skyRows > 0u && choice.light + 1u == MV_VPL_SETUP.lightCount;
    if (choice.light < MV_VPL_SETUP.lightCount && !ofSky) {
        choice.emitU = vplInCell(choice.emitU, column, bits);
        choice.emitV = vplInCell(choice.emitV, row, bits);
    } else {
        if (ofSky) {
            choice.emitU = vplInCell(choice.emitU, column, bits);
        } else {
            choice.pick = vplInCell(choice.pick, column, bits);
        }
        uint turnBits = bits >> 1u;
        choice.turnU = vplInCell(choice.turnU, row & ((1u << turnBits) - 1u), turnBits);
        choice.turnV = vplInCell(choice.turnV, row >> turnBits, bits - turnBits);
    }
    return choice;
}

// Where a path of light from far away starts, and its flux beside that of an even spread.
struct VplStart {
    vec3 origin;
    float weight;
};

// From just outside the scene's bounding sphere along unit `axis`: a place on the disc across it.
// Paths are shared out over discs around the shadow of what the camera sees on it, each twice as
// wide as the one before, up to the whole: a room is a speck of a wide ground, and what lies around
// it lights it the less the farther away. All weigh by the density of all discs together.
MV_FN VplStart vplOnDisc(VplSetup s, vec3 axis, float u, float v) {
    vec3 center = vec3(s.centerX, s.centerY, s.centerZ);
    vec3 region = vec3(s.regionX, s.regionY, s.regionZ);
    uint narrow = 0u;  // discs
    for (float r = s.regionRadius; r > 0.0f && r < kVplWide * s.radius; r = 2.0f * r) ++narrow;
    MV_PRECISE float place = u * float(narrow + 1u);
    uint disc = min(uint(place), narrow);
    bool whole = disc == narrow;
    MV_PRECISE float part = min(place - float(disc), 1.0f);
    vec2 cs = cosSin2Pi(v);
    MV_PRECISE float rho = (whole ? s.radius : s.regionRadius * float(1u << disc)) * sqrt(part);
    MV_PRECISE float x = rho * cs.x;
    MV_PRECISE float y = rho * cs.y;
    MV_PRECISE vec3 toRegion = region - center;
    float along = whole ? 0.0f : dot3(toRegion, axis);
    MV_PRECISE float depth = -1.001f * s.radius - along;
    vec3 across = aroundAxis(axis, x, y, depth);
    VplStart start;
    MV_PRECISE vec3 origin = (whole ? center : region) + across;
    start.origin = origin;

    MV_PRECISE vec3 way = origin - region;
    MV_PRECISE vec3 beside = way - axis * dot3(way, axis);
    float beside2 = dot3(beside, beside);
    float densities = 1.0f;  // in those of the whole
    for (uint k = 0u; k < narrow; ++k) {
        MV_PRECISE float r = s.regionRadius * float(1u << k);
        MV_PRECISE float ratio = s.radius / r;
        MV_PRECISE float sum = densities + ratio * ratio;
        if (k == disc || beside2 < r * r) densities = sum;
    }
    MV_PRECISE float weight = float(narrow + 1u) / densities;
    start.weight = weight;
    return start;
}

// The first segment of a path: a ray (unit direction) and its flux, W.
MV_FN void vplEmit(MV_VPL_PARAMS uint path, MV_OUT(vec3) origin, MV_OUT(vec3) direction,
                   MV_OUT(vec3) flux) {
    uint seed = MV_VPL_SETUP.seed;
    vec4 r = random4(seed, path, 0u, kVplDrawEmit);
    vec4 more = random4(seed, path, 0u, kVplDrawEmitMore);
    vec4 d = random4(seed, path, 0u, kVplDrawEmitDirection);
    uint lightCount = MV_VPL_SETUP.lightCount;
    float paths = float(MV_VPL_SETUP.paths);

    VplChoice choice;
    choice.emitU = r.y;
    choice.emitV = r.z;
    choice.pick = more.x;
    choice.turnU = d.x;
    choice.turnV = d.y;
    if (MV_VPL_SETUP.guideCells == 0u) {
        choice = vplChooseByPower(MV_VPL_ARGS r.x, choice);
    } else {
        choice = vplChooseByGuide(MV_VPL_ARGS r.x, choice);
    }
    MV_PRECISE float weight = 1.0f / (choice.weight * paths);
    uint low = choice.light;

    if (low < lightCount) {
        uvec4 place = vplLightTexel(MV_VPL_ARGS 4u * low);
        uvec4 aim = vplLightTexel(MV_VPL_ARGS 4u * low + 1u);
        uvec4 power = vplLightTexel(MV_VPL_ARGS 4u * low + 3u);
        flux = bvhVec3(power) * weight;
        origin = bvhVec3(place);
        vec3 axis = bvhVec3(aim);
        if (place.w == kLightDirectional) {
            VplStart start = vplOnDisc(MV_VPL_SETUP, axis, choice.emitU, choice.emitV);
            origin = start.origin;
            flux = flux * start.weight;
            direction = axis;
        } else if (place.w == kLightSky) {
            vec3 toSky = vec3(0.0f);
            vec3 radiance = vec3(0.0f);
            float density = skySample(MV_VPL_SKY_ARGS MV_VPL_SETUP.skyRows, choice.emitU, r.w,
                                      more.y, toSky, radiance);
            direction = -toSky;
            VplStart start = vplOnDisc(MV_VPL_SETUP, direction, choice.turnU, choice.turnV);
            origin = start.origin;
            MV_PRECISE float share = MV_VPL_SETUP.skyAreaM2 / density * weight * start.weight;
            flux = radiance * share;
        } else if (place.w == kLightSpot) {
            uvec4 shape = vplLightTexel(MV_VPL_ARGS 4u * low + 2u);
            MV_PRECISE float z = spotCosine(uintBitsToFloat(shape.w), uintBitsToFloat(aim.w),
                                            choice.emitU, r.w, more.x, more.y);
            vec2 cs = cosSin2Pi(choice.emitV);
            MV_PRECISE float sine = sqrt(max((1.0f - z) * (1.0f + z), 0.0f));
            MV_PRECISE float x = sine * cs.x;
            MV_PRECISE float y = sine * cs.y;
            direction = aroundAxis(axis, x, y, z);
        } else {
            direction = sphereDirection(choice.emitU, choice.emitV);
        }
    } else {
        vec3 normal = vec3(0.0f);
        vec3 power = vec3(0.0f);
        vec4 place = vec4(choice.pick, more.y, more.z, more.w);
        vplEmissivePoint(MV_VPL_ARGS place, r.y, origin, normal, power);
        flux = power * weight;
        direction = cosineDirection(normal, choice.turnU, choice.turnV);
    }
}

// ---------------------------------------------------------------- VPLs

MV_FN View vplAt(vec3 position, vec3 normal, vec3 flux, uint bounce, uint slot) {
    View view;
    view.positionX = position.x;
    view.positionY = position.y;
    view.positionZ = position.z;
    view.flags = kViewHemisphere;
    view.normalX = normal.x;
    view.normalY = normal.y;
    view.normalZ = normal.z;
    view.bounce = bounce;
    view.fluxR = flux.x;
    view.fluxG = flux.y;
    view.fluxB = flux.z;
    view.slot = slot;
    return view;
}

MV_FN View vplDead() {
    View view = vplAt(vec3(0.0f), vec3(0.0f), vec3(0.0f), 0u, 0u);
    view.flags = kViewDead;
    return view;
}

MV_FN bool vplAnyFlux(vec3 flux) { return max(flux.x, max(flux.y, flux.z)) > 0.0f; }

// The bounce-0 VPL of a slot below surfaceSlots: an equal part of the emitters' light.
MV_FN View vplOnEmitter(MV_VPL_PARAMS uint slot) {
    uint seed = MV_VPL_SETUP.seed;
    vec4 r = lampNumbers(seed, slot);
    vec4 more = random4(seed, slot, 0u, kVplDrawSurface);
    vec3 position = vec3(0.0f);
    vec3 normal = vec3(0.0f);
    vec3 flux = vec3(0.0f);
    vplEmissivePoint(MV_VPL_ARGS r, more.x, position, normal, flux);
    flux = flux * (1.0f / float(MV_VPL_SETUP.surfaceSlots));
    if (!vplAnyFlux(flux)) return vplDead();
    return vplAt(position, normal, flux, 0u, slot);
}

// Follows one segment and leaves a VPL where it ends; false, and a dead view, if it leaves the
// scene or meets black. The ray and its flux go on to the next segment.
//
// The VPL's normal is the shading normal on the side the ray came from: of its two directions
// the one that agrees with the ray-facing geometric normal, so it never looks into its surface by
// more than their disagreement. Where a direction drawn around it points below the triangle it is
// mirrored to above, so that no light passes through a wall and none is lost.
MV_FN bool vplBounce(MV_VPL_PARAMS uint path, uint bounce, uint slot, MV_INOUT(vec3) origin,
                     MV_INOUT(vec3) direction, MV_INOUT(vec3) flux, MV_OUT(View) view) {
    float t = 0.0f;
    float u = 0.0f;
    float v = 0.0f;
    vec3 passed;
    uint hit = bvhIntersectTinted(MV_BVH_ARGS origin, direction, 0.0f, kVplFar, t, u, v, passed);
    view = vplDead();
    if (hit == kNone) return false;

    BvhSurface surface = bvhSurface(MV_BVH_ARGS hit, u, v);
    vec3 geometric = vec3(surface.geometricX, surface.geometricY, surface.geometricZ);
    vec3 shading = vec3(surface.shadingX, surface.shadingY, surface.shadingZ);
    if (dot3(geometric, direction) > 0.0f) {
        geometric = -geometric;
        shading = -shading;
    }
    MV_PRECISE vec3 lifted =
        vec3(surface.positionX, surface.positionY, surface.positionZ) + geometric * kVplOffset;
    flux = flux * vec3(surface.albedoR, surface.albedoG, surface.albedoB) * passed;
    if (!vplAnyFlux(flux)) return false;
    view = vplAt(lifted, shading, flux, bounce, slot);

    vec4 r = random4(MV_VPL_SETUP.seed, path, bounce, kVplDrawScatter);
    vec3 scattered = cosineDirection(shading, r.x, r.y);
    MV_PRECISE float below = min(dot3(scattered, geometric), 0.0f);
    MV_PRECISE vec3 mirrored = scattered - geometric * (2.0f * below);
    origin = lifted;
    direction = mirrored;
    return true;
}

MV_END_NAMESPACE
#endif
