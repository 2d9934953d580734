// Surfaces of the gather's pixels -> receivers: one invocation a tile parts its pixels, such as an
// edge and what lies behind it, and bounds the points and the normals of each part.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_data.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitSurfaces) uniform usampler2D surfaces;
layout(binding = kImagePlanes, r32ui) uniform restrict uimage2D planes;
layout(std430, binding = kBlockTiles) writeonly buffer Tiles { GatherTile tiles[]; };

uniform ivec2 tileCount;
uniform int tileEdge;  // pixels

ivec2 begin, end;  // of the tile
// A part are the pixels that differ less from one of these than from the others.
uvec4 seeds[kTileParts];
uint parts;
float size2;  // squared: so far apart counts as much as normals across
// What is no farther from a seed's plane has no need of a part of its own.
const float kFlat = 0.01;

float difference(uvec4 a, uvec4 b) {
    vec3 way = uintBitsToFloat(a.xyz) - uintBitsToFloat(b.xyz);
    return dot(way, way) / size2 + 1.0 - dot(unpackNormal(a.w), unpackNormal(b.w));
}
float fromPlane(uvec4 a, uvec4 plane) {
    vec3 normal = unpackNormal(plane.w);
    float off = dot(normal, uintBitsToFloat(a.xyz) - uintBitsToFloat(plane.xyz));
    return off * off / size2 + 1.0 - dot(unpackNormal(a.w), normal);
}
uint partOf(uvec4 surface) {
    uint part = 0u;
    float least = kInfinity;
    for (uint i = 0u; i < parts; ++i) {
        float d = difference(surface, seeds[i]);
        if (d < least) part = i;
        least = min(least, d);
    }
    return part;
}

uvec4 farthestFrom(uvec4 seed) {
    uvec4 farthest = seed;
    float most = -1.0;
    for (int y = begin.y; y < end.y; ++y) {
        for (int x = begin.x; x < end.x; ++x) {
            uvec4 surface = texelFetch(surfaces, ivec2(x, y), 0);
            if (surface.w == kNoSurface) continue;
            float d = difference(surface, seed);
            if (d > most) {
                most = d;
                farthest = surface;
            }
        }
    }
    return farthest;
}

// Another seed: what is farthest from the planes of all; false where nothing is far.
bool addSeed() {
    uvec4 farthest = seeds[0];
    float most = kFlat;
    for (int y = begin.y; y < end.y; ++y) {
        for (int x = begin.x; x < end.x; ++x) {
            uvec4 surface = texelFetch(surfaces, ivec2(x, y), 0);
            if (surface.w == kNoSurface) continue;
            float least = kInfinity;
            for (uint i = 0u; i < parts; ++i) least = min(least, fromPlane(surface, seeds[i]));
            if (least > most) {
                most = least;
                farthest = surface;
            }
        }
    }
    if (most == kFlat) return false;
    seeds[parts] = farthest;
    ++parts;
    return true;
}

void assignParts() {
    for (int y = begin.y; y < end.y; ++y) {
        for (int x = begin.x; x < end.x; ++x) {
            ivec2 at = ivec2(x, y);
            uvec4 surface = texelFetch(surfaces, at, 0);
            if (surface.w == kNoSurface) continue;
            uint plane = imageLoad(planes, at).x;
            imageStore(planes, at, uvec4(planeOfPart(plane, partOf(surface))));
        }
    }
}

GatherTile boundsOf(uint part) {
    vec3 low = vec3(kInfinity);
    vec3 high = vec3(-kInfinity);
    vec3 sum = vec3(0.0);
    uint pixels = 0u;
    for (int y = begin.y; y < end.y; ++y) {
        for (int x = begin.x; x < end.x; ++x) {
            ivec2 at = ivec2(x, y);
            uvec4 surface = texelFetch(surfaces, at, 0);
            bool inPart = partOfPlane(imageLoad(planes, at).x) == part;
            if (surface.w == kNoSurface || !inPart) continue;
            vec3 position = uintBitsToFloat(surface.xyz);
            low = min(low, position);
            high = max(high, position);
            sum += unpackNormal(surface.w);
            ++pixels;
        }
    }
    vec3 axis = normalizeOr(sum, vec3(0.0, 1.0, 0.0));
    float cosCone = pixels > 0u ? 1.0 : 0.0;
    for (int y = begin.y; y < end.y; ++y) {
        for (int x = begin.x; x < end.x; ++x) {
            ivec2 at = ivec2(x, y);
            uvec4 surface = texelFetch(surfaces, at, 0);
            bool inPart = partOfPlane(imageLoad(planes, at).x) == part;
            if (surface.w == kNoSurface || !inPart) continue;
            cosCone = min(cosCone, dot(axis, unpackNormal(surface.w)));
        }
    }
    vec3 center = 0.5 * (low + high);
    vec3 extent = 0.5 * (high - low) + kReceiverMargin;
    if (pixels == 0u) {
        center = vec3(0.5);
        extent = vec3(1.0);
    }
    float sinCone = sqrt(max(0.0, 1.0 - cosCone * cosCone));
    float wide = cosCone > 0.0 ? widenedCos(cosCone, sinCone) : -1.0;
    return GatherTile(center.x, center.y, center.z, wide, extent.x, extent.y, extent.z,
                      widenedSin(cosCone, sinCone), axis.x, axis.y, axis.z, pixels);
}

void main() {
    uint tile = globalIndex();
    if (tile >= uint(tileCount.x * tileCount.y)) return;
    begin = ivec2(tile % uint(tileCount.x), tile / uint(tileCount.x)) * tileEdge;
    end = min(begin + tileEdge, textureSize(surfaces, 0));

    vec3 low = vec3(kInfinity);
    vec3 high = vec3(-kInfinity);
    uvec4 any = uvec4(0u, 0u, 0u, kNoSurface);
    for (int y = begin.y; y < end.y; ++y) {
        for (int x = begin.x; x < end.x; ++x) {
            uvec4 surface = texelFetch(surfaces, ivec2(x, y), 0);
            if (surface.w == kNoSurface) continue;
            low = min(low, uintBitsToFloat(surface.xyz));
            high = max(high, uintBitsToFloat(surface.xyz));
            any = surface;
        }
    }
    size2 = dot(high - low, high - low) + 1e-20;
    // The two ends of what the tile shows.
    seeds[0] = farthestFrom(any);
    seeds[1] = farthestFrom(seeds[0]);
    parts = 2u;
    while (parts < kTileParts && addSeed()) {
    }
    assignParts();
    for (uint part = 0u; part < kTileParts; ++part) {
        tiles[kTileParts * tile + part] = boundsOf(part);
    }
}
