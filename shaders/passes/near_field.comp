// Adds to the gathered irradiance what the clamp has taken: short rays of each pixel
// (shaders/shared/near_field.glsl), and one more from each place that they meet to what lights it.
// MV_EMISSION: some surfaces glow. MV_SKY: there is a sky.
#include "shaders/passes/bounded_rays.glsl"
#include "shaders/passes/punctual_lights.glsl"
#include "shaders/passes/rests.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/morton.glsl"
#include "shaders/shared/near_field.glsl"

const uint kLanes = kNearFieldTile * kNearFieldTile;
layout(local_size_x = kNearFieldTile, local_size_y = kNearFieldTile) in;

layout(binding = kUnitSurfaces) uniform usampler2D surfaces;
layout(binding = kUnitPlanes) uniform usampler2D planes;
layout(binding = kUnitViewKeys) uniform usamplerBuffer viewKeys;
layout(binding = kUnitClampDistances) uniform samplerBuffer clampDistances;
layout(binding = kImageIrradiance, rgba32f) uniform restrict image2D irradiance;

uniform ivec2 size;
uniform uint viewCount;
uniform float fixedDistance;  // at which all views are clamped; below 0: by their neighbours
uniform uint seed;
uniform uint accumulationIndex;
uniform float edgeM;  // metres of the root cube's edge
uniform uint lightCount;
uniform uint bounces;  // of the views' paths
#ifdef MV_EMISSION
uniform float emissionScale;
#endif
#ifdef MV_SKY
uniform uint skyRows;
uniform float tableShare;
#endif

// The first view from `low` to `high` whose key is not below.
uint firstAtLeast(uint low, uint high, uint key) {
    MV_FIND_FIRST(low, high, middle, texelFetch(viewKeys, int(middle)).x >= key);
    return low;
}

float clampDistanceAt(vec3 place, vec3 facing) {
    if (fixedDistance >= 0.0) return fixedDistance;
    uint key = mortonKeyOf(place);
    uint middle = firstAtLeast(0u, viewCount, key);
    uint end = min(middle + kNearFieldWindow, viewCount);
    // Where all that are looked at lie in the cell, more of them may.
    bool crowded = end > middle && texelFetch(viewKeys, int(end - 1u)).x == key;
    uint inCell = firstAtLeast(middle, crowded ? viewCount : middle, key + 1u) - middle;
    NearestViews nearest = noNearestViews();
    for (uint i = max(middle, kNearFieldWindow) - kNearFieldWindow; i < end; ++i) {
        vec3 way = viewPosition(i) - place;
        nearest = withNearView(nearest, dot3(way, way), viewNormal(i), facing);
    }
    float least = texelFetch(clampDistances, int(viewCount)).x;
    return nearFieldClampDistance(nearest, crowdOf(kNearFieldWindow, inCell, least));
}

// What lights a place that the pixel's n-th ray meets, W/m^2: one light, direction of the sky or
// view is chosen and asked by another ray. numbers: nearFieldNumbers() of the ray.
vec3 lightOf(vec3 place, vec3 normal, uvec2 pixel, uint n, vec4 numbers) {
    NearFieldLight light = noNearFieldLight(numbers.z);
    vec3 way;
    for (uint i = 0u; i < lightCount; ++i) {
        vec3 given = lightIrradiance(fetchLight(i), edgeM, place, normal, way);
        light = withLight(light, i, given, way);
    }
#ifdef MV_SKY
    vec4 r = random4(seed, pixel.y << 16u | pixel.x, n, kNearFieldSkyDraw);
    for (uint k = 0u; k < kNearFieldSky; ++k) {
        vec3 given = nearFieldSky(skyRows, tableShare, normal, r, k, way);
        light = withLight(light, lightCount + k, given, way);
    }
#endif
    for (uint k = 0u; k < kNearFieldViews; ++k) {
        uint i = nearFieldView(k, numbers.w, viewCount);
        if (viewBounce(i) >= bounces) continue;  // its light ends at the place
        way = viewPosition(i) - place;
        float clampDistance = texelFetch(clampDistances, int(i)).x;
        float term = gatherTerm(way, normal, viewNormal(i), false, clampDistance, 0.0);
        vec3 given = nearFieldOfView(viewFlux(i), term, viewCount, edgeM);
        light = withLight(light, lightCount + kNearFieldSky + k, given, way);
    }
    vec3 given = nearFieldGiven(light);
    way = vec3(light.wayX, light.wayY, light.wayZ);
    bool any = light.choice.chosen != kNone;
    // Loops alone skip work where branches are masked.
    for (; any; any = false) {
        given *= bvhPassed(place, way, 0.0, 1.0);
    }
    return given;
}

// What the pixel's n-th ray brings, W/m^2.
vec3 nearLight(uvec2 pixel, vec3 origin, vec3 normal, vec3 plane, uint n) {
    vec4 r = nearFieldNumbers(seed, pixel.x, pixel.y, n);
    vec3 direction = nearFieldDirection(normal, r, pixel.x, pixel.y, n);
    if (dot3(direction, plane) <= 0.0) return vec3(0.0);
    float t, u, v;
    uint hit = bvhIntersect(origin, direction, 0.0, kNearFieldReach, false, t, u, v);
    if (hit == kNone) return vec3(0.0);
    BvhSurface met = bvhSurface(hit, u, v);
    vec3 facing = normalizeOr(vec3(met.geometricX, met.geometricY, met.geometricZ), -direction);
    if (dot3(facing, direction) > 0.0) facing = -facing;
    vec3 place = vec3(met.positionX, met.positionY, met.positionZ);
    float share = nearFieldTaken(clampDistanceAt(place, facing), t);
    if (!(share > 0.0)) return vec3(0.0);
    vec3 given = lightOf(place + facing * bvhLift(), facing, pixel, n, r) *
                 vec3(met.albedoR, met.albedoG, met.albedoB);
#ifdef MV_EMISSION
    given += kPi * emissionScale * bvhEmissionSeen(met, direction);
#endif
    return share * given;
}

shared float powers[kLanes];  // of what near places give the tile's pixels
shared uint present[kLanes];  // there is a surface

// The mean over the tile's surfaces. All its invocations come here.
float meanOfTile(float power, bool isSurface) {
    powers[gl_LocalInvocationIndex] = isSurface ? power : 0.0;
    present[gl_LocalInvocationIndex] = isSurface ? 1u : 0u;
    barrier();
    float sum = 0.0;
    uint count = 0u;
    for (uint i = 0u; i < kLanes; ++i) {
        sum += powers[i];
        count += present[i];
    }
    return sum / float(max(count, 1u));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    bool inside = all(lessThan(pixel, size));
    uvec4 surface = inside ? texelFetch(surfaces, pixel, 0) : uvec4(kNoSurface);
    bool isSurface = surface.w != kNoSurface && !rests(pixel);
    vec3 given = vec3(0.0);
    if (isSurface) {
        vec3 normal = unpackNormal(surface.w);
        vec3 plane = unpackNormal(texelFetch(planes, pixel, 0).x);
        vec3 origin = uintBitsToFloat(surface.xyz) + plane * bvhLift();
        for (uint k = 0u; k < kNearFieldRays; ++k) {
            uint n = accumulationIndex * kNearFieldRays + k;
            given += nearLight(uvec2(pixel), origin, normal, plane, n) / float(kNearFieldRays);
        }
    }
    float around = meanOfTile(gatherPower(given), isSurface);
    if (!isSurface) return;
    vec4 gathered = imageLoad(irradiance, pixel);
    vec3 added = nearFieldAdded(given, gathered.rgb, around);
    float variance = luminance(added) * luminance(added) / float(kNearFieldRays);
    imageStore(irradiance, pixel, gathered + vec4(added, variance));
}
