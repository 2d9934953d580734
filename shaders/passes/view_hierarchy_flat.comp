// ManyLoDs: no tree, one leaf a view in sorted order.
#include "shaders/passes/view_hierarchy_node.glsl"
#include "shaders/shared/bindings.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint count;
layout(std430, binding = kBlockLeafOfView) writeonly buffer Leaves { uint leafOfView[]; };

void main() {
    uint i = globalIndex();
    if (i >= count) return;
    mapOfNode[i] = i;
    leafOfView[i] = i;
    writeNode(i, viewPosition(i), 0u, vec3(0.0), 0u, coneOfView(i), i, 1u, kNone >> 1u);
}
