// Which levels of detail the triangles of a group are needed at: bit k of a group's word is set if
// a view that level k may serve may see one of the triangles. Goes through some of the views, and
// keeps what was found before.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/bvh_data.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/vir.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(std430, binding = kBlockGroupLevels) buffer Groups { uint groupLevels[]; };

uniform uint triangleCount;
uniform uint firstView;
uniform uint endView;

void main() {
    uint group = globalIndex();
    uint triangle = group * kVirGroup;
    if (triangle >= triangleCount) return;
    uint end = min(triangle + kVirGroup, triangleCount);
    vec3 low = vec3(kInfinity);
    vec3 high = vec3(-kInfinity);
    while (triangle < end) {
        vec3 a = bvhVec3(bvhTriangleTexel(3u * triangle));
        vec3 b = bvhVec3(bvhTriangleTexel(3u * triangle + 1u));
        uvec4 tc = bvhTriangleTexel(3u * triangle + 2u);
        vec3 c = bvhVec3(tc);
        if (tc.w == triangle) {  // no earlier slot holds it
            low = min(low, min(a, min(b, c)));
            high = max(high, max(a, max(b, c)));
        }
        triangle += 1u;
    }
    const uint all = (1u << kVirLevels) - 1u;
    uint levels = groupLevels[group];
    uint view = firstView;
    while (view < endView && levels != all) {
        vec3 p = viewPosition(view);
        vec2 distances = virDistances(low - p, high - p);
        uint found = 0u;
        for (uint k = 0u; k < kVirLevels; ++k) {
            found |= virMayServe(virRange(k), distances) ? 1u << k : 0u;
        }
        levels |= virMaySee(viewFlags(view), viewNormal(view), low - p, high - p) ? found : 0u;
        view += 1u;
    }
    groupLevels[group] = levels;
}
