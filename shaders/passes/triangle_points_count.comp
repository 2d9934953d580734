// How many points of one level of detail each triangle has; 0 behind the last triangle, and in
// slots of triangles that an earlier one holds.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/bvh_data.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/vir.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(std430, binding = kBlockPointCounts) writeonly buffer Counts { uint counts[]; };
layout(binding = kUnitGroupLevels) uniform usamplerBuffer groupLevels;

uniform uint triangleCount;
uniform uint level;
uniform float spacing;

void main() {
    uint triangle = globalIndex();
    if (triangle > triangleCount) return;
    uint count = 0u;
    if (triangle < triangleCount &&
        (texelFetch(groupLevels, int(triangle / kVirGroup)).x >> level & 1u) != 0u) {
        vec3 a = bvhVec3(bvhTriangleTexel(3u * triangle));
        vec3 b = bvhVec3(bvhTriangleTexel(3u * triangle + 1u));
        uvec4 tc = bvhTriangleTexel(3u * triangle + 2u);
        VirLattice lattice = virLattice(a, b, bvhVec3(tc), spacing, triangle);
        count = tc.w == triangle ? lattice.columns * lattice.rows : 0u;
    }
    counts[triangle] = count;
}
