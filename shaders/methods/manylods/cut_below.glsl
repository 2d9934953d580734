// Whether an ancestor of a node has merged, so that the node's place is taken.
#include "shaders/methods/manylods/cut_fetch.glsl"
#include "shaders/methods/manylods/cut_update.glsl"

layout(binding = kUnitCutLastMerged) uniform usamplerBuffer lastMerged;

layout(std430, binding = kBlockCutMerged) restrict readonly buffer MergedBuffer {
    CutMerged mergedNodes[];
};

bool belowMerged(uint slot, uint node) {
    uint last = texelFetch(lastMerged, int(slot)).x;
    if (last == kNone) return false;
    for (node = parentOfScene(node); node != 0u && node != kNone; node = parentOfScene(node)) {
        for (uint k = last; k != kNone; k = mergedNodes[k].before) {
            if (cutSceneNode(mergedNodes[k].entry.node) == node) return true;
        }
    }
    return false;
}
