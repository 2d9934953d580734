// Draws the nodes of the cuts; those that cover many texels are left to splat_large.comp.
#include "shaders/methods/manylods/cut_fetch.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/traversal_data.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(std430, binding = kBlockStatus) restrict buffer StatusBuffer { uint status[]; };
layout(std430, binding = kBlockLargePairs) restrict writeonly buffer LargeBuffer {
    uvec2 largePairs[];
};

uniform uint cutCapacity;
uniform uint largeCapacity;

const uint kRules = uint(MV_RULES);
const bool kFill = MV_HOLE_FILL == 1;

#if MV_MIPS
#define MV_MIP_MAPS
#endif
#include "shaders/passes/map_texels.glsl"
uint ownMap;
#define MV_SPLAT(texel, bits) lowerMapTexel(ownMap, texel, bits)
#if MV_MIPS
#define MV_SPLAT_MIP(mipTexel, bits) lowerMipTexel(ownMap, mipTexel, bits)
#endif
#include "shaders/shared/splat.glsl"

void main() {
    uint index = globalIndex();
    if (index >= min(status[kStatusCutNodes], cutCapacity)) return;
    CutEntry e = fetchCutEntry(index);
    uint decision = cutDecision(e.node);
    if (!pairRendered(decision)) return;
    uint viewNode = fetchStep(e.slot).viewNode;
    ownMap = viewNode;  // of flat hierarchies
    SceneNode scene = fetchSceneNode(cutSceneNode(e.node));
    vec3 center = fetchViewNodeCenter(viewNode);
    bool forced = decision == kPairForced;
    if (forced && kFill && hasRule(kRules, kRuleSurfaces) &&
        isLargeSplat(scene, center, MV_MAP_RES)) {
        uint at = atomicAdd(status[kStatusLarge], 1u);
        if (at < largeCapacity) {
            largePairs[at] = uvec2(cutSceneNode(e.node), viewNode);
        } else {
            status[kStatusOverflow] = 1u;
        }
    } else {
        splatPair(scene, center, kRules, forced, kFill, MV_MAP_RES);
    }
}
