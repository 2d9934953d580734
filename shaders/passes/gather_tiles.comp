// Surfaces of the gather's pixels -> tiles as receivers: one invocation a tile bounds the points
// that it shows and the normals.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_data.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitSurfaces) uniform usampler2D surfaces;
layout(std430, binding = kBlockTiles) writeonly buffer Tiles { GatherTile tiles[]; };

uniform ivec2 tileCount;
uniform int tileEdge;  // pixels

void main() {
    uint tile = globalIndex();
    if (tile >= uint(tileCount.x * tileCount.y)) return;
    ivec2 begin = ivec2(tile % uint(tileCount.x), tile / uint(tileCount.x)) * tileEdge;
    ivec2 end = min(begin + tileEdge, textureSize(surfaces, 0));

    vec3 low = vec3(kInfinity);
    vec3 high = vec3(-kInfinity);
    vec3 sum = vec3(0.0);
    uint pixels = 0u;
    for (int y = begin.y; y < end.y; ++y) {
        for (int x = begin.x; x < end.x; ++x) {
            uvec4 surface = texelFetch(surfaces, ivec2(x, y), 0);
            if (surface.w == kNoSurface) continue;
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
            uint code = texelFetch(surfaces, ivec2(x, y), 0).w;
            if (code != kNoSurface) cosCone = min(cosCone, dot(axis, unpackNormal(code)));
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
    tiles[tile] = GatherTile(center.x, center.y, center.z, wide, extent.x, extent.y, extent.z,
                             widenedSin(cosCone, sinCone), axis.x, axis.y, axis.z, pixels);
}
