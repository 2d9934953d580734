// Fusion of one view level [Kol19 §3.2]: every map takes from its parent's fused map what is
// nearer, re-centred. One invocation a texel; levels in turn from the root down.
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/fuse.glsl"
#include "shaders/shared/pair.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = 1) uniform usamplerBuffer viewNodes;
layout(binding = 3) uniform usamplerBuffer mapOfNode;
layout(std430, binding = 5) restrict buffer LeafMapBuffer { uint leafMaps[]; };
layout(std430, binding = 6) restrict buffer WorkMapBuffer { uint workMaps[]; };

uniform uint firstNode;
uniform uint nodeCount;
uniform uint workMapOffset;        // work map of node n of this level is n + offset
uniform uint parentWorkMapOffset;  // and of its parent

const uint kRes = uint(MV_VIEW_RES);

void main() {
    uint index = globalIndex();
    uint local = index / mapTexels(kRes);
    uint texel = index % mapTexels(kRes);
    if (local >= nodeCount) return;
    uint node = firstNode + local;
    ViewNode view = fetchViewNode(viewNodes, node);
    uint parent = parentOf(view);
    vec3 offset = minus3(boxCenter(fetchViewNode(viewNodes, parent)), boxCenter(view));
    uint bits = workMaps[(parent + parentWorkMapOffset) * mapTexels(kRes) + texel];
    if (bits == kNone) return;
    bits = recenterDepth(bits, texel, kRes, offset);
    if (isLeaf(view)) {
        uint at = texelFetch(mapOfNode, int(node)).x * mapTexels(kRes) + texel;
        leafMaps[at] = min(leafMaps[at], bits);
    } else {
        uint at = (node + workMapOffset) * mapTexels(kRes) + texel;
        workMaps[at] = min(workMaps[at], bits);
    }
}
