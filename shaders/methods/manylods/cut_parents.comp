// Writes the parent of each scene node; the root's stays kNone.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(std430, binding = kBlockSceneParents) restrict writeonly buffer ParentBuffer {
    uint parents[];
};

uniform uint nodeCount;

void main() {
    uint node = globalIndex();
    if (node >= nodeCount) return;
    uint children = fetchSceneChildren(node);
    uint first = firstChildOf(children);
    uint count = childCountOf(children);
    for (uint k = 0u; k < count; ++k) parents[first + k] = node;
}
