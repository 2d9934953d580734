// A round of tests: children of nodes that were split in the one before.
#define MV_CUT_STEPS readonly
#include "shaders/methods/manylods/cut_update.glsl"

layout(std430, binding = kBlockCutTested) restrict readonly buffer TestedBuffer {
    CutPending pending[];
};

void main() {
    beginGroup();
    uint index = globalIndex();
    Placed p = nothing();
    if (index < min(status[kFirstStatusCounter + nextRound - 1u], pendingCapacity)) {
        CutPending a = pending[index];
        uint node = a.node & ~kCutUnlimited;
        ViewNode view = fetchViewNode(steps[a.slot].viewNode);
        Tested tested = testNode(node, view);
        p = placeNode(node, tested, a.above, a.slot, view, a.node & kCutUnlimited);
    }
    endGroup(p);
}
