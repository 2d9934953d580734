// Sorted views and their maps -> what the gather reads of each view, 3 texels: position and map;
// kPowerUnits * flux / units and packed normal; centre of the map and units. A sample of w units
// then weighs w / kPowerUnits.
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_sampling.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = 0) uniform usamplerBuffer sortedViews;  // View, 3 texels
layout(binding = 1) uniform usamplerBuffer leafOfView;
layout(binding = 2) uniform usamplerBuffer mapOfNode;
layout(binding = 3) uniform usamplerBuffer mapNodes;  // ViewNode of the maps' hierarchy
layout(binding = 4) uniform usamplerBuffer prefix;    // see gather_power.comp

layout(std430, binding = 0) writeonly buffer Records { uvec4 records[]; };

uniform uint viewCount;
uniform uint mapKind;  // 0: none, 1: one a leaf, 2: one a node

void main() {
    uint view = globalIndex();
    if (view >= viewCount) return;
    uint units = texelFetch(prefix, int(view + 1u)).x - texelFetch(prefix, int(view)).x;
    uvec4 a = texelFetch(sortedViews, int(view * 3u));
    vec3 normal = uintBitsToFloat(texelFetch(sortedViews, int(view * 3u + 1u)).xyz);
    vec3 flux = uintBitsToFloat(texelFetch(sortedViews, int(view * 3u + 2u)).xyz);
    uint map = kNone;
    uvec3 center = a.xyz;
    if (mapKind != 0u) {
        uint leaf = texelFetch(leafOfView, int(view)).x;
        map = mapKind == 1u ? texelFetch(mapOfNode, int(leaf)).x : leaf;
        center = texelFetch(mapNodes, int(leaf * 4u)).xyz;
    }
    vec3 perUnit = units > 0u ? flux * (kPowerUnits / float(units)) : vec3(0.0);
    bool omnidirectional = a.w == kViewOmnidirectional;
    records[view * 3u] = uvec4(a.xyz, map);
    records[view * 3u + 1u] =
        uvec4(floatBitsToUint(perUnit), omnidirectional ? kNoSurface : packNormal(normal));
    records[view * 3u + 2u] = uvec4(center, units);
}
