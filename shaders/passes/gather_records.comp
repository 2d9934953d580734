// Sorted views and their maps -> what the gather reads of each view.
// MV_BORROWED_MAPS: only some of the views have maps, in a hierarchy of their own
// (view_hierarchy_borrow.comp).
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_data.glsl"
#include "shaders/shared/gather_sampling.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitLeafOfView) uniform usamplerBuffer leafOfView;
layout(binding = kUnitMapOfNode) uniform usamplerBuffer mapOfNode;
layout(binding = kUnitPowerPrefix) uniform usamplerBuffer prefix;  // see gather_power.comp

layout(binding = kUnitClampDistances) uniform samplerBuffer clampDistances;

layout(std430, binding = kBlockGatherRecords) writeonly buffer Records { GatherRecord records[]; };

#ifdef MV_BORROWED_MAPS
layout(std430, binding = kBlockPlaces) readonly buffer Places { uint places[]; };
uint placeOf(uint view) { return places[view]; }
#else
uint placeOf(uint view) { return view; }
#endif

uniform uint viewCount;
uniform uint mapKind;  // 0: none, 1: one a leaf, 2: one a node

void main() {
    uint view = globalIndex();
    if (view >= viewCount) return;
    uint units = texelFetch(prefix, int(view + 1u)).x - texelFetch(prefix, int(view)).x;
    vec3 position = viewPosition(view);
    uint map = kNone;
    vec3 center = position;
    if (mapKind != 0u) {
        uint leaf = texelFetch(leafOfView, int(placeOf(view))).x;
        map = mapKind == 1u ? texelFetch(mapOfNode, int(leaf)).x : leaf;
        center = fetchViewNodeCenter(leaf);  // of the maps' hierarchy
    }
    vec3 perUnit = units > 0u ? viewFlux(view) * (kPowerUnits / float(units)) : vec3(0.0);
    bool omnidirectional = viewFlags(view) == kViewOmnidirectional;
    vec3 normal = omnidirectional ? vec3(0.0) : unpackNormal(packNormal(viewNormal(view)));
    float clampDistance = texelFetch(clampDistances, int(view)).x;
    records[view] = GatherRecord(position.x, position.y, position.z, clampDistance, normal.x,
                                 normal.y, normal.z, luminance(perUnit), perUnit.r, perUnit.g,
                                 perUnit.b, map, center.x, center.y, center.z,
                                 packUnits(units, viewBounce(view) == 0u && !omnidirectional));
}
