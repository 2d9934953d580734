// Makes a batch of the points of one level of detail, a cluster of them and the box around it an
// invocation. Point number n belongs to the last triangle whose first point is not behind it.
#include "shaders/passes/last_at_most.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/bvh.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/vir.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(std430, binding = kBlockPoints) writeonly buffer Points { VirPoint points[]; };
layout(std430, binding = kBlockClusters) writeonly buffer Clusters { vec4 clusters[]; };
layout(binding = kUnitFirstPoints) uniform usamplerBuffer firstPoints;  // of each triangle

uniform uint triangleCount;
uniform uint firstPoint;
uniform uint pointCount;
uniform float spacing;

VirPoint makePoint(uint number) {
    uint triangle = lastAtMost(firstPoints, 0u, triangleCount, 1u, number);
    uvec4 ta = bvhTriangleTexel(3u * triangle);
    uvec4 tb = bvhTriangleTexel(3u * triangle + 1u);
    vec3 a = bvhVec3(ta);
    vec3 b = bvhVec3(tb);
    vec3 c = bvhVec3(bvhTriangleTexel(3u * triangle + 2u));
    VirLattice lattice = virLattice(a, b, c, spacing, triangle);
    vec3 weights = virWeights(lattice, number - texelFetch(firstPoints, int(triangle)).x);
#if MV_BVH_MASKS
    if ((tb.w & kMaterialMask) != 0u &&
        bvhMaskedOut(ta.w, tb.w & ~kMaterialMask, weights.y, weights.z)) {
        triangle = kNone;
    }
#endif
    vec3 p = virPosition(a, b, c, weights);
    return VirPoint(p.x, p.y, p.z, triangle);
}

void main() {
    uint cluster = globalIndex();
    uint index = cluster * kVirCluster;
    if (index >= pointCount) return;
    uint end = min(index + kVirCluster, pointCount);
    vec3 low = vec3(kInfinity);
    vec3 high = vec3(-kInfinity);
    while (index < end) {
        VirPoint p = makePoint(firstPoint + index);
        points[index] = p;
        low = min(low, vec3(p.x, p.y, p.z));
        high = max(high, vec3(p.x, p.y, p.z));
        index += 1u;
    }
    clusters[2u * cluster] = vec4(low, 0.0);
    clusters[2u * cluster + 1u] = vec4(high, 0.0);
}
