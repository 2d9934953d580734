// Adds to the gathered irradiance what the clamp has taken: a short ray a pixel
// (shaders/shared/near_field.glsl), and another to one of the views around the place that it meets.
// MV_EMISSION: some surfaces glow.
#include "shaders/passes/bounded_rays.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/light.glsl"
#include "shaders/shared/morton.glsl"
#include "shaders/shared/near_field.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitSurfaces) uniform usampler2D surfaces;
layout(binding = kUnitPlanes) uniform usampler2D planes;
layout(binding = kUnitViewKeys) uniform usamplerBuffer viewKeys;
layout(binding = kUnitClampDistances) uniform samplerBuffer clampDistances;
layout(binding = kImageIrradiance, rgba32f) uniform restrict image2D irradiance;

uniform ivec2 size;
uniform uint viewCount;
uniform uint seed;
uniform uint accumulationIndex;
uniform float inverseEdge2;
#ifdef MV_EMISSION
uniform float emissionScale;
#endif

// The first view whose key is not below.
uint firstAtLeast(uint key) {
    uint low = 0u;
    uint high = viewCount;
    while (low < high) {
        uint middle = (low + high) >> 1u;
        if (texelFetch(viewKeys, int(middle)).x < key)
            low = middle + 1u;
        else
            high = middle;
    }
    return low;
}

void main() {
    uint index = globalIndex();
    ivec2 pixel = ivec2(index % uint(size.x), index / uint(size.x));
    if (pixel.y >= size.y) return;
    uvec4 surface = texelFetch(surfaces, pixel, 0);
    if (surface.w == kNoSurface) return;
    vec3 normal = unpackNormal(surface.w);
    vec3 plane = unpackNormal(texelFetch(planes, pixel, 0).x);
    vec3 origin = uintBitsToFloat(surface.xyz) + plane * bvhLift();
    vec3 direction =
        nearFieldDirection(normal, seed, uint(pixel.x), uint(pixel.y), accumulationIndex);
    if (dot3(direction, plane) <= 0.0) return;
    float t, u, v;
    uint hit = bvhIntersect(origin, direction, 0.0, kNearFieldReach, false, t, u, v);
    if (hit == kNone) return;

    vec3 a = bvhVec3(bvhTriangleTexel(3u * hit));
    vec3 b = bvhVec3(bvhTriangleTexel(3u * hit + 1u));
    vec3 c = bvhVec3(bvhTriangleTexel(3u * hit + 2u));
    vec3 facing = normalizeOr(cross3(b - a, c - a), -direction);
    if (dot3(facing, direction) > 0.0) facing = -facing;
    vec3 place = origin + direction * t;
    uint middle = firstAtLeast(mortonKeyOf(place));
    uint end = min(middle + kNearFieldWindow, viewCount);
    Choice choice =
        noChoice(nearFieldNumber(seed, uint(pixel.x), uint(pixel.y), accumulationIndex));
    vec3 given = vec3(0.0);
    for (uint i = max(middle, kNearFieldWindow) - kNearFieldWindow; i < end; ++i) {
        vec3 way = viewPosition(i) - place;
        float clampDistance = texelFetch(clampDistances, int(i)).x;
        float share = nearFieldShare(clampDistance, t, dot3(way, way), viewNormal(i), facing);
        if (!(share > 0.0)) continue;
        vec3 light = viewFlux(i) * (share * inverseEdge2);
        choice = withCandidate(choice, i, luminance(light));
        if (choice.chosen == i) given = light;
    }
    if (choice.chosen == kNone) return;
    given *= choice.total / choice.weight;
    bool ask = true;
#ifdef MV_EMISSION
    vec3 emission = emissionScale * bvhEmissionSeen(bvhSurface(hit, u, v), direction);
    ask = !(luminance(emission) > 0.0);
    float clampDistance = texelFetch(clampDistances, int(choice.chosen)).x;
    if (!ask) given = nearFieldEmitted(emission, clampDistance, t);
#endif
    // Loops alone skip work where branches are masked.
    for (; ask; ask = false) {
        vec3 between = origin + direction * (0.5 * t);
        float height = -0.5 * t * dot3(direction, facing);
        vec3 above = viewPosition(choice.chosen) + viewNormal(choice.chosen) * height;
        if (bvhOccluded(between, above - between, 0.0, 1.0)) given = vec3(0.0);
    }
    vec4 gathered = imageLoad(irradiance, pixel);
    vec3 added = nearFieldAdded(given, gathered.rgb);
    float moment = luminance(added) * luminance(added);
    imageStore(irradiance, pixel, gathered + vec4(added, moment));
}
