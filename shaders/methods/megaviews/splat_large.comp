// Leaf pairs that cover many texels of their map, left over by the traversal: one work group a
// pair, its lanes share the texels. Entry: (scene node, view node). Only view leaves have such
// pairs, so nothing waits for them.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/pair.glsl"
#include "shaders/shared/traversal_data.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitMapOfNode) uniform usamplerBuffer mapOfNode;
layout(binding = kUnitLargePairs) uniform usamplerBuffer largePairs;

layout(std430, binding = kBlockStatus) restrict readonly buffer StatusBuffer { uint status[]; };

uniform uint statusIndex;
uniform uint largeCapacity;

#include "shaders/passes/map_texels.glsl"
uint ownMap;
#define MV_SPLAT(texel, bits) lowerMapTexel(ownMap, texel, bits)
#include "shaders/shared/splat.glsl"

void main() {
    uint index = groupIndex();
    if (index >= min(status[statusIndex], largeCapacity)) return;
    uvec2 pair = texelFetch(largePairs, int(index)).xy;
    SceneNode scene = fetchSceneNode(pair.x);
    ownMap = MV_FUSE == 1 ? texelFetch(mapOfNode, int(pair.y)).x : pair.y;
    SplatArea area = splatAreaOf(scene, boxCenter(fetchViewNode(pair.y)), true, MV_MAP_RES);
    for (uint k = gl_LocalInvocationID.x; k < area.count; k += uint(MV_WORKGROUP_SIZE)) {
        splatAreaTexel(area, splatTexelOf(area, k), MV_MAP_RES);
    }
}
