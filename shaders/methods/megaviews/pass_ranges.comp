// For a pass over the sorted views [firstView, endView): the nodes of each view level that hold
// any of them, a contiguous range, since nodes of a level are in the order of their views. Behind
// them the range of their maps, which are in that order on all levels.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/types.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitMapOfNode) uniform usamplerBuffer mapOfNode;
layout(binding = kUnitLeafOfView) uniform usamplerBuffer leafOfView;
layout(std430, binding = kBlockPassRanges) restrict writeonly buffer RangeBuffer {
    uvec2 ranges[];
};

uniform uint levelBegin[kTreeLevels + 1u];
uniform uint levelCount;
uniform uint firstView;
uniform uint endView;

uint mapOfView(uint view) {
    return texelFetch(mapOfNode, int(texelFetch(leafOfView, int(view)).x)).x;
}

uint endOf(ViewNode node) { return node.firstView + node.viewCount; }

void main() {
    uint level = globalIndex();
    if (level == levelCount) {
        ranges[level] = uvec2(mapOfView(firstView), mapOfView(endView - 1u) + 1u);
    }
    if (level >= levelCount) return;
    uint end = levelBegin[level + 1u];
    // First node that ends after firstView, and first node that starts at or after endView.
    uint low = levelBegin[level];
    uint high = end;
    MV_FIND_FIRST(low, high, middle, endOf(fetchViewNode(middle)) > firstView);
    uint begin = low;
    high = end;
    MV_FIND_FIRST(low, high, middle, fetchViewNode(middle).firstView >= endView);
    ranges[level] = uvec2(begin, low);
}
