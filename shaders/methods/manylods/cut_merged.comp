// Puts an ancestor that has merged into the cut, unless one above it has merged, too.
#include "shaders/methods/manylods/cut_below.glsl"

uniform uint mergedCapacity;

void main() {
    beginGroup();
    uint index = globalIndex();
    Placed p = nothing();
    if (index < min(status[kStatusCutMerged], mergedCapacity)) {
        CutEntry e = mergedNodes[index].entry;
        bool below = belowMerged(e.slot, cutSceneNode(e.node));
        if (!below) p = keep(e, 1u << kCutCountMerged);
    }
    endGroup(p);
}
