// A lane tests the root for a view, and says what becomes of its old cut: it goes on from where the
// view stood, or is dropped; without one the view descends from the root.
#include "shaders/methods/manylods/cut_update.glsl"

layout(std430, binding = kBlockOldCutViews) restrict readonly buffer OldViewBuffer {
    CutView oldViews[];
};
layout(std430, binding = kBlockNewCutViews) restrict writeonly buffer NewViewBuffer {
    CutView newViews[];
};

layout(std430, binding = kBlockCutSteps) restrict writeonly buffer StepBuffer { CutStep steps[]; };

uniform uint viewCount;

Placed beginView(uint viewNode) {
    ViewNode view = fetchViewNode(viewNode);
    uint slot = viewSlot(viewNode);
    CutView before = oldViews[slot];
    if (status[kStatusOldOverflow] != 0u) before.state = kCutNone;  // parts of the cuts are missing
    Tested root = testNode(0u, view);
    bool below = splits(root.decision);
    bool goesOn = below && before.state == kCutBelow;
    newViews[slot] = cutViewOf(view, below ? kCutBelow : kCutRoot);
    steps[slot] = CutStep(viewNode, goesOn ? displacementOf(view, before) : -1.0f);
    if (!below) {
        return keep(entryOf(0u, root, kInfinity, slot), uint(before.state == kCutBelow)
                                                            << kCutCountMerged);
    }
    if (goesOn) return nothing();
    return split(0u, kInfinity, slot, before.state == kCutNone ? kCutUnlimited : 0u);
}

void main() {
    beginGroup();
    uint index = globalIndex();
    Placed p = nothing();
    if (index < viewCount) p = beginView(index);
    endGroup(p);
}
