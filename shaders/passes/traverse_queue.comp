// Breadth-first traversal over a queue of pairs, as published [Kol19 §3.2]; with a flat view
// hierarchy ManyLoDs' [HREB11 §3.1]. Queues hold the pairs that go on to be split; an invocation
// takes one, tests its up to eight children, renders or drops them or appends them to the next
// queue, the whole work group by one atomic. Testing before pushing keeps the queues a quarter of
// the published size. Entry: (scene node | bit 31 if the scene is to be split, view node).
// MV_SEED: takes no queue but makes the first pairs, the scene's root with the first view nodes.
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/pair.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = 0) uniform usamplerBuffer sceneNodes;
layout(binding = 1) uniform usamplerBuffer viewNodes;
layout(binding = 2) uniform usamplerBuffer queueIn;
layout(binding = 3) uniform usamplerBuffer mapOfNode;

layout(std430, binding = 1) restrict buffer StatusBuffer { uint status[]; };  // see traversal_job.h
layout(std430, binding = 2) restrict writeonly buffer QueueBuffer { uvec2 queueOut[]; };
layout(std430, binding = 5) restrict buffer LeafMapBuffer { uint leafMaps[]; };
layout(std430, binding = 6) restrict buffer WorkMapBuffer { uint workMaps[]; };
#if MV_MIPS
layout(std430, binding = 7) restrict buffer MipBuffer { uint mips[]; };
#endif
layout(std430, binding = 8) restrict writeonly buffer LargeBuffer { uvec2 largePairs[]; };

uniform float pairRes;   // see pair.glsl
uniform uint firstNode;  // MV_SEED: range of view nodes that start with the scene's root
uniform uint nodeCount;
uniform uint firstOwnedView;  // the pass renders views [firstOwnedView, endOwnedView)
uniform uint endOwnedView;
uniform uint queueCapacity;      // pairs
uniform uint largeCapacity;      // pairs
uniform uint statusIndex;        // of the queue written; that of the queue read is one before
uniform uint workMapOffset[11];  // by view level: work map of node n is n + offset, modulo 2^32

const bool kPublished = MV_PUBLISHED == 1;
const bool kFill = MV_HOLE_FILL == 1;
const uint kRes = uint(MV_VIEW_RES);
const uint kSplitScene = 0x80000000u;

const uint kForcedBit = 0x80000000u;
const uint kLanes = uint(MV_WORKGROUP_SIZE);
const uint kPlaces = 8u * kLanes;

// What the group's pairs lead to: pairs to append from the front of sharedPush, splats from the
// front and large ones from the back of sharedDraws.
shared uvec2 sharedPush[8 * MV_WORKGROUP_SIZE];
shared uvec2 sharedDraws[8 * MV_WORKGROUP_SIZE];
shared uint sharedAdded;  // pushed | to draw << 10 | large << 20
shared uint sharedFirst;  // place in the queue
shared uint sharedFirstLarge;

bool mapIsLeaf;
uint mapBase;
uint mipBase;

void splatGlobal(uint texel, uint bits) {
    if (mapIsLeaf) {
        atomicMin(leafMaps[mapBase + texel], bits);
    } else {
        atomicMin(workMaps[mapBase + texel], bits);
    }
}
#define MV_SPLAT(texel, bits) splatGlobal(texel, bits)
#if MV_MIPS
#define MV_SPLAT_MIP(texel, bits) atomicMin(mips[mipBase + (texel)], bits)
#endif
#include "shaders/passes/pair_counters.glsl"
shared uint sharedViews[kCounterLevels];
#include "shaders/shared/splat.glsl"

void chooseMap(ViewNode view, uint node) {
    uint map = texelFetch(mapOfNode, int(node)).x;
#if MV_FUSE
    mapIsLeaf = isLeaf(view);
    mapBase = (mapIsLeaf ? map : node + workMapOffset[view.level]) * mapTexels(kRes);
#else
    mapIsLeaf = true;
    mapBase = node * mapTexels(kRes);
#endif
    mipBase = map * mipTexels(kRes);
}

void main() {
    uint index = globalIndex();
    uint lane = gl_LocalInvocationID.x;
    if (lane == 0u) sharedAdded = 0u;
    for (uint i = lane; i < kCounterLevels; i += kLanes) sharedViews[i] = 0u;
    clearCounts();
    barrier();

    // Children of this invocation's pair: `count` nodes from `first` of one tree, `other` of the
    // other one.
    uint first = 0u;
    uint count = 0u;
    uint other = 0u;
    bool alongScene = false;
#if MV_SEED
    if (index < nodeCount) {
        first = firstNode + index;
        count = 1u;
    }
#else
    if (index < min(status[statusIndex - 1u], queueCapacity)) {
        uvec2 pair = texelFetch(queueIn, int(index)).xy;
        alongScene = (pair.x & kSplitScene) != 0u;
        uint sceneIndex = pair.x & ~kSplitScene;
        other = alongScene ? pair.y : sceneIndex;
        uint children = alongScene ? fetchSceneChildren(sceneNodes, sceneIndex)
                                   : texelFetch(viewNodes, int(pair.y * 4u)).w;
        first = firstChildOf(children);
        count = childCountOf(children);
    }
#endif

    uint push = 0u;
    uint splitScene = 0u;
    uint draw = 0u;
    uint large = 0u;
    uint forced = 0u;
    uint views = 0u;
    if (count > 0u) {
        uint k = 0u;
        do {
            SceneNode scene = fetchSceneNode(sceneNodes, alongScene ? first + k : other);
            ViewNode view = fetchViewNode(viewNodes, alongScene ? other : first + k);
            uint decision = decidePair(scene, view, kPublished, pairRes);
            bool inPass =
                view.firstView < endOwnedView && view.firstView + view.viewCount > firstOwnedView;
            decision = inPass ? decision : kPairNone;
            bool rendered = decision == kPairRendered || decision == kPairForced;
            bool isLarge = kFill && !kPublished && decision == kPairForced &&
                           isLargeSplat(scene, boxCenter(view), kRes);
            push |= uint(decision == kPairSplitScene || decision == kPairSplitView) << k;
            splitScene |= uint(decision == kPairSplitScene) << k;
            draw |= uint(rendered && !isLarge) << k;
            large |= uint(isLarge) << k;
            forced |= uint(decision == kPairForced) << k;
#if MV_COUNT
            bool owned = view.firstView >= firstOwnedView;
            countPair(owned ? decision : kPairNone, scene.level);
#if MV_COUNT == 2
            if (owned && rendered) atomicAdd(sharedViews[scene.level], view.viewCount);
#else
            views += owned && rendered ? view.viewCount : 0u;
#endif
#endif
        } while (++k < count);
    }

    // A place in the group for each.
    uint mine = uint(bitCount(push)) | uint(bitCount(draw)) << 10u | uint(bitCount(large)) << 20u;
    uint base = atomicAdd(sharedAdded, mine);
    uint pushAt = base & 0x3FFu;
    uint drawAt = base >> 10u & 0x3FFu;
    uint largeAt = kPlaces - 1u - (base >> 20u);
    while (push != 0u) {
        uint k = uint(findLSB(push));
        push &= push - 1u;
        uvec2 pair = alongScene ? uvec2(first + k, other) : uvec2(other, first + k);
        pair.x |= (splitScene >> k & 1u) != 0u ? kSplitScene : 0u;
        sharedPush[pushAt++] = pair;
    }
    while (draw != 0u) {
        uint k = uint(findLSB(draw));
        draw &= draw - 1u;
        uvec2 pair = alongScene ? uvec2(first + k, other) : uvec2(other, first + k);
        pair.x |= (forced >> k & 1u) != 0u ? kForcedBit : 0u;
        sharedDraws[drawAt++] = pair;
    }
    while (large != 0u) {
        uint k = uint(findLSB(large));
        large &= large - 1u;
        sharedDraws[largeAt--] = alongScene ? uvec2(first + k, other) : uvec2(other, first + k);
    }
#if MV_COUNT
    sumCounts();
    if (views != 0u) atomicAdd(sharedViews[0], views);
#endif
    barrier();

    // One place a group in the queue, and one among the large splats.
    uint pushed = sharedAdded & 0x3FFu;
    uint drawn = sharedAdded >> 10u & 0x3FFu;
    uint larges = sharedAdded >> 20u;
    if (lane == 0u) {
        uint start = pushed != 0u ? atomicAdd(status[statusIndex], pushed) : 0u;
        uint startLarge = larges != 0u ? atomicAdd(status[1], larges) : 0u;
        bool full = start + pushed > queueCapacity || startLarge + larges > largeCapacity;
        if (full) status[0] = 1u;
        sharedFirst = full ? kNone : start;
        sharedFirstLarge = startLarge;
    }
#if MV_COUNT
    storeCounts();
    for (uint i = lane; i < kCounterLevels; i += kLanes) {
        add64(groupIndex() % kCounterSlots, i, 5u, sharedViews[i], 0u);
    }
#endif
    barrier();
    uint start = sharedFirst;
    uint startLarge = sharedFirstLarge;
    if (start != kNone) {
        for (uint i = lane; i < pushed; i += kLanes) queueOut[start + i] = sharedPush[i];
        for (uint i = lane; i < larges; i += kLanes) {
            largePairs[startLarge + i] = sharedDraws[kPlaces - 1u - i];
        }
    }
    for (uint i = lane; i < drawn; i += kLanes) {
        uvec2 pair = sharedDraws[i];
        uint sceneIndex = pair.x & ~kForcedBit;
        ViewNode view = fetchViewNode(viewNodes, pair.y);
        chooseMap(view, pair.y);
        splatPair(fetchSceneNode(sceneNodes, sceneIndex), boxCenter(view), kPublished,
                  (pair.x & kForcedBit) != 0u, kFill, kRes);
    }
}
