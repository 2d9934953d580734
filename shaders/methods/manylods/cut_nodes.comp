// Keeps an old node as it is, or where its clearance has run out hands it to round 0 to be tested.
#include "shaders/methods/manylods/cut_below.glsl"

Placed update(CutEntry e) {
    CutStep step = fetchStep(e.slot);
    uint node = cutSceneNode(e.node);
    if (!goesOn(step) || belowMerged(e.slot, node)) return nothing();
    e.node.own = clearanceLeft(e.node.own, step.displacement);
    bool tested = (e.node.node & kCutChainTested) != 0u;
    if (!tested) e.node.above = clearanceLeft(e.node.above, step.displacement);
    e.node.node &= ~kCutChainTested;
    if (!(e.node.own < 0.0f)) return keep(e, 1u << kCutCountKept);
    Placed p = nothing();
    p.first = node;
    p.count = 1u;
    p.pending = CutPending(0u, e.slot, e.node.above, 0u);
    return p;
}

void main() {
    beginGroup();
    uint index = globalIndex();
    Placed p = nothing();
    if (index < min(status[kStatusOldCutNodes], cutCapacity)) p = update(fetchCutEntry(index));
    endGroup(p);
}
