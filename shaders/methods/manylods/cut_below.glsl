// Whether an ancestor of a node has merged, so that the node's place is taken.
#define MV_CUT_STEPS readonly
#include "shaders/methods/manylods/cut_update.glsl"

layout(std430, binding = kBlockCutMerged) restrict readonly buffer MergedBuffer {
    CutMerged mergedNodes[];
};

bool belowMerged(uint slot, uint node) {
    uint last = steps[slot].merged;
    if (last == kNone) return false;
    for (node = parentOfScene(node); node != 0u && node != kNone; node = parentOfScene(node)) {
        for (uint k = last; k != kNone; k = mergedNodes[k].before) {
            if (cutSceneNode(mergedNodes[k].entry.node) == node) return true;
        }
    }
    return false;
}
