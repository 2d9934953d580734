// Splats a batch of points into the maps of parallel views (parallel.glsl): one view and some
// clusters of points an invocation.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/bvh_data.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/parallel.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitSurfacePoints) uniform usamplerBuffer points;  // VirPoint
layout(binding = kUnitSkyViews) uniform samplerBuffer skyViews;      // SkyView
layout(std430, binding = kBlockMaps) coherent restrict buffer Maps { uint mapTexels_[]; };

uniform uint pointCount;
uniform uint groupsAcross;  // work groups that hold a view each for every invocation
uniform uint viewCount;
uniform uint pointsEach;  // of an invocation
uniform uint mapRes;
uniform float spacing;
uniform vec3 centre;
uniform float radius;

void main() {
    uint view = (groupIndex() % groupsAcross) * uint(MV_WORKGROUP_SIZE) + gl_LocalInvocationID.x;
    uint index = groupIndex() / groupsAcross * pointsEach;
    if (view >= viewCount) return;
    uint end = min(index + pointsEach, pointCount);
    ParallelView v = parallelView(texelFetch(skyViews, int(2u * view)).xyz);
    uint first = view * mapRes * mapRes;
    while (index < end) {
        uvec4 p = texelFetch(points, int(index));
        uint triangle = p.w == kNone ? 0u : p.w;
        vec3 a = bvhVec3(bvhTriangleTexel(3u * triangle)) - centre;
        vec3 b = bvhVec3(bvhTriangleTexel(3u * triangle + 1u)) - centre;
        vec3 c = bvhVec3(bvhTriangleTexel(3u * triangle + 2u)) - centre;
        ParallelSplat s =
            parallelSplat(v, a, b, c, uintBitsToFloat(p.xyz) - centre, spacing, radius, mapRes);
        uvec4 area = p.w == kNone ? uvec4(0u) : parallelTexels(s, mapRes);
        uvec2 at = area.xy;
        while (at.y < area.w) {
            uint bits = parallelDepth(s, at.x, at.y);
            if (bits != kNone) atomicMin(mapTexels_[first + at.y * mapRes + at.x], bits);
            at.x += 1u;
            if (at.x == area.z) at = uvec2(area.x, at.y + 1u);
        }
        index += 1u;
    }
}
