// Splats a batch of points of one level of detail into the maps of the views that it serves: one
// view and some clusters of points an invocation.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/bvh_data.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/vir.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitSurfacePoints) uniform usamplerBuffer points;  // VirPoint
layout(binding = kUnitClusters) uniform samplerBuffer clusters;      // corners of their boxes

uniform uint pointCount;
uniform uint groupsAcross;  // work groups that hold a view each for every invocation
uniform uint viewCount;
uniform uint clustersEach;  // of an invocation
uniform uint mapRes;
uniform float spacing;
uniform uint level;

#define MV_MAP_RES mapRes
#include "shaders/passes/map_texels.glsl"
#include "shaders/passes/splat_texels.glsl"

void main() {
    uint view = (groupIndex() % groupsAcross) * uint(MV_WORKGROUP_SIZE) + gl_LocalInvocationID.x;
    uint cluster = groupIndex() / groupsAcross * clustersEach;
    if (view >= viewCount) return;
    uint endCluster = min(cluster + clustersEach, (pointCount + kVirCluster - 1u) / kVirCluster);
    vec3 origin = viewPosition(view);
    vec3 facing = viewNormal(view);
    uint flags = viewFlags(view);
    vec2 range = virRange(level);
    float radius = spacing * kVirLatticeRadius;
    while (cluster < endCluster) {
        vec3 low = texelFetch(clusters, int(2u * cluster)).xyz - origin;
        vec3 high = texelFetch(clusters, int(2u * cluster + 1u)).xyz - origin;
        uint index = cluster * kVirCluster;
        uint end = min(index + kVirCluster, pointCount);
        if (!virMayServe(range, virDistances(low, high)) || !virMaySee(flags, facing, low, high)) {
            index = end;
        }
        // Loops alone skip work where branches are masked.
        while (index < end) {
            uvec4 p = texelFetch(points, int(index));
            vec3 offset = uintBitsToFloat(p.xyz) - origin;
            float l = length3(offset);
            uvec4 front = uvec4(0u);
            uvec4 back = uvec4(0u);
            for (bool near = p.w != kNone && virServes(range, flags, facing, offset, l); near;
                 near = false) {
                front = pointTexels(0u, offset, l, radius, kVirReach, mapRes);
                back = pointTexels(1u, offset, l, radius, kVirReach, mapRes);
            }
            SplatTexels t = firstTexel(front, back);
            VirSplat splat;
            for (bool any = t.left.z != 0u; any; any = false) {
                vec3 a = bvhVec3(bvhTriangleTexel(3u * p.w));
                vec3 b = bvhVec3(bvhTriangleTexel(3u * p.w + 1u));
                vec3 c = bvhVec3(bvhTriangleTexel(3u * p.w + 2u));
                splat = virSplat(a, b, c, uintBitsToFloat(p.xyz), spacing, origin);
            }
            while (t.left.z != 0u) {
                uint texel = texelAt(t.face, t.at.x, t.at.y, mapRes);
                uint bits = virDepth(splat, texel, mapRes);
                if (bits != kNone && texelReachable(texel, mapRes)) {
                    lowerMapTexel(view, texel, bits);
                }
                toNextTexel(t);
            }
            index += 1u;
        }
        cluster += 1u;
    }
}
