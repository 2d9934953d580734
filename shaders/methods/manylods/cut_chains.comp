// Tests the chain of an old node whose clearance has run out. The topmost of the ancestors that
// need not be split takes the place of what is below it.
#include "shaders/methods/manylods/cut_fetch.glsl"
#include "shaders/methods/manylods/cut_update.glsl"

layout(binding = kUnitCutChains) uniform usamplerBuffer cutChains;

layout(std430, binding = kBlockOldCutNodes) restrict writeonly buffer OldCutBuffer {
    CutEntry oldCut[];
};
layout(std430, binding = kBlockCutLastMerged) restrict buffer LastBuffer { uint lastMerged[]; };
layout(std430, binding = kBlockCutMerged) restrict writeonly buffer MergedBuffer {
    CutMerged mergedNodes[];
};

uniform uint mergedCapacity;

void addMerged(CutEntry entry) {
    uint at = atomicAdd(status[kStatusCutMerged], 1u);
    if (at < mergedCapacity) {
        uint lists = entry.slot * kCutMergedWords;
        uint level = fetchSceneLevel(cutSceneNode(entry.node));
        uint before = atomicExchange(lastMerged[lists + level], at);
        atomicAnd(lastMerged[lists + kSceneLevels], ~(1u << level));
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
    if (index < min(status[kStatusCutChains], cutCapacity)) {
        uint old = texelFetch(cutChains, int(index)).x;
        CutEntry e = fetchCutEntry(old);
        testChain(e, fetchViewNode(fetchStep(e.slot).viewNode));
        e.node.node |= kCutChainTested;
        oldCut[old] = e;
    }
    endGroup(nothing());
}
