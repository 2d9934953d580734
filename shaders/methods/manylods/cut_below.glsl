// Whether an ancestor of a node has merged, so that the node's place is taken.
#include "shaders/methods/manylods/cut_fetch.glsl"
#include "shaders/methods/manylods/cut_update.glsl"

layout(binding = kUnitCutLastMerged) uniform usamplerBuffer lastMerged;

layout(std430, binding = kBlockCutMerged) restrict readonly buffer MergedBuffer {
    CutMerged mergedNodes[];
};

bool belowMerged(uint slot, uint node) {
    uint lists = slot * kCutMergedWords;
    uint merged = ~texelFetch(lastMerged, int(lists + kSceneLevels)).x;  // levels, a bit each
    if (merged == 0u) return false;
    uint level = fetchSceneLevel(node);
    // Until none is left above.
    while ((merged & (1u << level) - 1u) != 0u) {
        node = parentOfScene(node);
        --level;
        if ((merged >> level & 1u) == 0u) continue;
        uint k = texelFetch(lastMerged, int(lists + level)).x;
        for (; k != kNone; k = mergedNodes[k].before) {
            if (cutSceneNode(mergedNodes[k].entry.node) == node) return true;
        }
    }
    return false;
}
