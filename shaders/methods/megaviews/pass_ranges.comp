// For a pass over the sorted views [firstView, endView): the nodes of each view level that hold
// any of them, a contiguous range, since nodes of a level are in the order of their views.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(std430, binding = kBlockPassRanges) restrict writeonly buffer RangeBuffer {
    uvec2 ranges[];
};

uniform uint levelBegin[kTreeLevels + 1u];
uniform uint levelCount;
uniform uint firstView;
uniform uint endView;

void main() {
    uint level = globalIndex();
    if (level >= levelCount) return;
    uint end = levelBegin[level + 1u];
    // First node that ends after firstView, and first node that starts at or after endView.
    uint low = levelBegin[level];
    uint high = end;
    while (low < high) {
        uint middle = low + (high - low) / 2u;
        ViewNode view = fetchViewNode(middle);
        if (view.firstView + view.viewCount > firstView) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    uint begin = low;
    high = end;
    while (low < high) {
        uint middle = low + (high - low) / 2u;
        if (fetchViewNode(middle).firstView >= endView) {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    ranges[level] = uvec2(begin, low);
}
