// Fusion of one view level [Kol19 §3.2]: every map takes from its parent's fused map what is
// nearer, re-centred. One invocation a texel; levels in turn from the root down.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/fuse.glsl"
#include "shaders/shared/pair.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitMapOfNode) uniform usamplerBuffer mapOfNode;

uniform uint firstNode;
uniform uint nodeCount;
uniform uint workMapOffset;        // work map of node n of this level is n + offset
uniform uint parentWorkMapOffset;  // and of its parent

#define MV_WORK_MAPS
#include "shaders/passes/map_texels.glsl"

void main() {
    uint index = globalIndex();
    uint local = index / mapTexels(MV_MAP_RES);
    uint texel = index % mapTexels(MV_MAP_RES);
    if (local >= nodeCount) return;
    uint node = firstNode + local;
    ViewNode view = fetchViewNode(node);
    uint parent = parentOf(view);
    vec3 offset = minus3(boxCenter(fetchViewNode(parent)), boxCenter(view));
    uint bits = loadMapTexel(NodeMap(parent + parentWorkMapOffset, true), texel);
    if (bits == kNone) return;
    NodeMap own = NodeMap(node + workMapOffset, true);
    if (isLeaf(view)) own = NodeMap(texelFetch(mapOfNode, int(node)).x, false);
    lowerMapTexel(own, texel, recenterDepth(bits, texel, MV_MAP_RES, offset));
}
