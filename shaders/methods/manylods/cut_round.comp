// One round of tests, of the children of nodes that were split in the round before.
#include "shaders/methods/manylods/cut_fetch.glsl"
#include "shaders/methods/manylods/cut_update.glsl"

void main() {
    beginGroup();
    uint index = globalIndex();
    Placed p = nothing();
    if (index < min(status[kFirstStatusCounter + nextRound - 1u], pendingCapacity)) {
        CutPending a = fetchPending(index);
        uint node = a.node & ~kCutUnlimited;
        ViewNode view = fetchViewNode(fetchStep(a.slot).viewNode);
        Tested tested = testNode(node, view);
        p = placeNode(node, tested, a.above, a.slot, view, a.node & kCutUnlimited);
    }
    endGroup(p);
}
