// What is left of the clearances of an old node, and a test of its chain where that one's has run
// out. Of ancestors that split no longer the topmost takes the place of what is below it.
#define MV_CUT_STEPS
#include "shaders/methods/manylods/cut_update.glsl"

layout(std430, binding = kBlockOldCutNodes) restrict buffer OldCutBuffer { CutEntry oldCut[]; };
layout(std430, binding = kBlockCutMerged) restrict writeonly buffer MergedBuffer {
    CutMerged mergedNodes[];
};

uniform uint mergedCapacity;

void addMerged(CutEntry entry) {
    uint at = atomicAdd(status[kStatusCutMerged], 1u);
    if (at < mergedCapacity) {
        uint before = atomicExchange(steps[entry.slot].merged, at);
        mergedNodes[at] = CutMerged(entry, before);
    } else {
        status[kStatusOverflow] = 1u;
    }
}

void testChain(inout CutEntry e, ViewNode view) {
    e.node.above = kInfinity;
    bool merges = false;
    CutEntry merged = e;
    uint node = cutSceneNode(e.node);
    for (;;) {
        uint parent = parentOfScene(node);
        if (parent == 0u || firstChildOf(fetchSceneChildren(parent)) != node) break;
        Tested tested = testNode(parent, view);
        if (!splits(tested.decision)) {
            merges = true;
            merged = entryOf(parent, tested, kInfinity, e.slot);
        } else if (merges) {
            merged.node.above = min(merged.node.above, tested.clearance);
        } else {
            e.node.above = min(e.node.above, tested.clearance);
        }
        node = parent;
    }
    if (merges) addMerged(merged);
}

void main() {
    beginGroup();
    uint index = globalIndex();
    if (index < min(status[kStatusOldCutNodes], cutCapacity)) {
        CutEntry e = oldCut[index];
        uint viewNode = steps[e.slot].viewNode;
        float displacement = steps[e.slot].displacement;
        if (viewNode != kNone && displacement >= 0.0f) {
            e.node.own = clearanceLeft(e.node.own, displacement);
            e.node.above = clearanceLeft(e.node.above, displacement);
            if (e.node.above < 0.0f) testChain(e, fetchViewNode(viewNode));
            oldCut[index] = e;
        }
    }
    endGroup(nothing());
}
