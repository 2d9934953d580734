// Leaf pairs that cover many texels of their map, left over by the traversal: one work group a
// pair, its lanes share the texels. Entry: (scene node, view node). Only view leaves have such
// pairs, so nothing waits for them.
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/pair.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = 0) uniform usamplerBuffer sceneNodes;
layout(binding = 1) uniform usamplerBuffer viewNodes;
layout(binding = 2) uniform usamplerBuffer largePairs;

layout(std430, binding = 1) restrict readonly buffer StatusBuffer { uint status[]; };
layout(std430, binding = 4) restrict readonly buffer MapOfNodeBuffer { uint mapOfNode[]; };
layout(std430, binding = 5) restrict buffer LeafMapBuffer { uint leafMaps[]; };

uniform uint statusIndex;
uniform uint largeCapacity;

const uint kRes = uint(MV_VIEW_RES);

uint mapBase;
#define MV_SPLAT(texel, bits) atomicMin(leafMaps[mapBase + (texel)], bits)
#include "shaders/shared/splat.glsl"

void main() {
    uint index = groupIndex();
    if (index >= min(status[statusIndex], largeCapacity)) return;
    uvec2 pair = texelFetch(largePairs, int(index)).xy;
    SceneNode scene = fetchSceneNode(sceneNodes, pair.x);
    mapBase = (MV_FUSE == 1 ? mapOfNode[pair.y] : pair.y) * mapTexels(kRes);
    SplatArea area = splatAreaOf(scene, boxCenter(fetchViewNode(viewNodes, pair.y)), kRes);
    for (uint k = gl_LocalInvocationID.x; k < area.count; k += uint(MV_WORKGROUP_SIZE)) {
        splatAreaTexel(area, true, scene.surface, k, kRes);
    }
}
