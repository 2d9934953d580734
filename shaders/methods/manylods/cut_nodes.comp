// An old node as it is, or what takes its place.
#include "shaders/methods/manylods/cut_below.glsl"

layout(std430, binding = kBlockOldCutNodes) restrict readonly buffer OldCutBuffer {
    CutEntry oldCut[];
};

Placed goOn(CutEntry e) {
    CutStep step = steps[e.slot];
    if (step.viewNode == kNone || step.displacement < 0.0f) return nothing();
    uint node = cutSceneNode(e.node);
    if (belowMerged(e.slot, node)) return nothing();
    if (!(e.node.own < 0.0f)) return keep(e, 1u << kCutCountKept);
    ViewNode view = fetchViewNode(step.viewNode);
    return placeNode(node, testNode(node, view), e.node.above, e.slot, view, 0u);
}

void main() {
    beginGroup();
    uint index = globalIndex();
    Placed p = nothing();
    if (index < min(status[kStatusOldCutNodes], cutCapacity)) p = goOn(oldCut[index]);
    endGroup(p);
}
