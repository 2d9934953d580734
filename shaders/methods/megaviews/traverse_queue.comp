// Breadth-first traversal over a queue of pairs, as published [Kol19 §3.2]; with a flat view
// hierarchy ManyLoDs' [HREB11 §3.1]. Queues hold the pairs that go on to be split; an invocation
// takes one, tests its up to eight children, renders or drops them or appends them to the next
// queue, the whole work group by one atomic. Testing before pushing keeps the queues a quarter of
// the published size. Entry: (scene node | bit 31 if the scene is to be split, view node).
// MV_SEED: takes no queue but makes the first pairs, the scene's root with the first view nodes.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/pair.glsl"
#include "shaders/shared/traversal_data.glsl"
#include "shaders/shared/types.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitPairQueue) uniform usamplerBuffer queueIn;
layout(binding = kUnitMapOfNode) uniform usamplerBuffer mapOfNode;

layout(std430, binding = kBlockStatus) restrict buffer StatusBuffer { uint status[]; };
layout(std430, binding = kBlockPairQueue) restrict writeonly buffer QueueBuffer {
    uvec2 queueOut[];
};
layout(std430, binding = kBlockLargePairs) restrict writeonly buffer LargeBuffer {
    uvec2 largePairs[];
};

uniform float pairRes;   // see pair.glsl
uniform uint firstNode;  // MV_SEED: range of view nodes that start with the scene's root
uniform uint nodeCount;
uniform uint firstOwnedView;  // the pass renders views [firstOwnedView, endOwnedView)
uniform uint endOwnedView;
uniform uint queueCapacity;  // pairs
uniform uint largeCapacity;  // pairs
uniform uint statusIndex;    // of the queue written; that of the queue read is one before
// By view level: the work map of node n is n + offset, modulo 2^32.
uniform uint workMapOffset[kTreeLevels];

const uint kRules = uint(MV_RULES);
const bool kFill = MV_HOLE_FILL == 1;
const uint kLanes = uint(MV_WORKGROUP_SIZE);
const uint kPlaces = 8u * kLanes;

// What the group's pairs lead to: pairs to append from the front of sharedPush, splats from the
// front and large ones from the back of sharedDraws.
shared uvec2 sharedPush[8 * MV_WORKGROUP_SIZE];
shared uvec2 sharedDraws[8 * MV_WORKGROUP_SIZE];
shared uint sharedAdded;  // pushed, to draw, large
shared uint sharedFirst;  // place in the queue
shared uint sharedFirstLarge;

#define MV_WORK_MAPS
#if MV_MIPS
#define MV_MIP_MAPS
#endif
#include "shaders/passes/map_texels.glsl"
NodeMap ownMap;
uint ownMips;
#define MV_SPLAT(texel, bits) lowerMapTexel(ownMap, texel, bits)
#if MV_MIPS
#define MV_SPLAT_MIP(mipTexel, bits) lowerMipTexel(ownMips, mipTexel, bits)
#endif
#include "shaders/methods/megaviews/packed_counts.glsl"
#include "shaders/methods/megaviews/pair_counters.glsl"
shared uint sharedViews[kCounterLevels];
uint laneViews = 0u;
#include "shaders/shared/splat.glsl"

void chooseMap(ViewNode view, uint node) {
    uint map = texelFetch(mapOfNode, int(node)).x;
#if MV_FUSE
    bool working = !isLeaf(view);
    ownMap = NodeMap(working ? node + workMapOffset[view.level] : map, working);
#else
    ownMap = NodeMap(node, false);
#endif
    ownMips = map;
}

// Children of a lane's pair: `count` nodes from `first` of one tree, `other` of the other one; and
// which of them go where.
struct Children {
    uint first, count, other;
    bool alongScene;
    uint push, splitScene, draw, large, forced;  // masks
};

Children takeChildren() {
    uint index = globalIndex();
    Children c = Children(0u, 0u, 0u, false, 0u, 0u, 0u, 0u, 0u);
#if MV_SEED
    if (index < nodeCount) {
        c.first = firstNode + index;
        c.count = 1u;
    }
#else
    if (index < min(status[statusIndex - 1u], queueCapacity)) {
        uvec2 pair = texelFetch(queueIn, int(index)).xy;
        c.alongScene = (pair.x & kPairFlag) != 0u;
        uint sceneIndex = pair.x & ~kPairFlag;
        c.other = c.alongScene ? pair.y : sceneIndex;
        uint children = c.alongScene ? fetchSceneChildren(sceneIndex) : fetchViewChildren(pair.y);
        c.first = firstChildOf(children);
        c.count = childCountOf(children);
    }
#endif
    return c;
}

uvec2 pairOf(Children c, uint k) {
    return c.alongScene ? uvec2(c.first + k, c.other) : uvec2(c.other, c.first + k);
}

void countChild(uint decision, bool rendered, SceneNode scene, ViewNode view) {
#if MV_COUNT
    bool owned = view.firstView >= firstOwnedView;
    countPair(owned ? decision : kPairNone, scene.level);
#if MV_COUNT == 2
    if (owned && rendered) atomicAdd(sharedViews[scene.level], view.viewCount);
#else
    laneViews += owned && rendered ? view.viewCount : 0u;
#endif
#endif
}

void testChildren(inout Children c) {
    if (c.count > 0u) {
        uint k = 0u;
        do {
            uvec2 pair = pairOf(c, k);
            SceneNode scene = fetchSceneNode(pair.x);
            ViewNode view = fetchViewNode(pair.y);
            uint decision = decidePair(scene, view, kRules, pairRes);
            bool inPass =
                view.firstView < endOwnedView && view.firstView + view.viewCount > firstOwnedView;
            decision = inPass ? decision : kPairNone;
            bool rendered = pairRendered(decision);
            bool isLarge = kFill && hasRule(kRules, kRuleSurfaces) && decision == kPairForced &&
                           isLargeSplat(scene, boxCenter(view), MV_MAP_RES);
            c.push |= uint(decision == kPairSplitScene || decision == kPairSplitView) << k;
            c.splitScene |= uint(decision == kPairSplitScene) << k;
            c.draw |= uint(rendered && !isLarge) << k;
            c.large |= uint(isLarge) << k;
            c.forced |= uint(decision == kPairForced) << k;
            countChild(decision, rendered, scene, view);
        } while (++k < c.count);
    }
}

// A place in the group for each.
void placeChildren(Children c) {
    uvec3 before = unpackCounts(atomicAdd(sharedAdded, packCounts(c.push, c.draw, c.large)));
    uint largeAt = kPlaces - 1u - before.z;
    while (c.push != 0u) {
        uint k = takeBit(c.push);
        uvec2 pair = pairOf(c, k);
        pair.x |= hasBit(c.splitScene, k) ? kPairFlag : 0u;
        sharedPush[before.x++] = pair;
    }
    while (c.draw != 0u) {
        uint k = takeBit(c.draw);
        uvec2 pair = pairOf(c, k);
        pair.x |= hasBit(c.forced, k) ? kPairFlag : 0u;
        sharedDraws[before.y++] = pair;
    }
    while (c.large != 0u) sharedDraws[largeAt--] = pairOf(c, takeBit(c.large));
}

// One place a group in the queue, and one among the large splats.
void reserve(uint pushed, uint larges) {
    uint start = pushed != 0u ? atomicAdd(status[statusIndex], pushed) : 0u;
    uint startLarge = larges != 0u ? atomicAdd(status[kStatusLarge], larges) : 0u;
    bool full = start + pushed > queueCapacity || startLarge + larges > largeCapacity;
    if (full) status[kStatusOverflow] = 1u;
    sharedFirst = full ? kNone : start;
    sharedFirstLarge = startLarge;
}

void append(uint pushed, uint larges) {
    uint start = sharedFirst;
    uint startLarge = sharedFirstLarge;
    if (start != kNone) {
        for (uint i = gl_LocalInvocationID.x; i < pushed; i += kLanes) {
            queueOut[start + i] = sharedPush[i];
        }
        for (uint i = gl_LocalInvocationID.x; i < larges; i += kLanes) {
            largePairs[startLarge + i] = sharedDraws[kPlaces - 1u - i];
        }
    }
}

void drawPairs(uint count) {
    for (uint i = gl_LocalInvocationID.x; i < count; i += kLanes) {
        uvec2 pair = sharedDraws[i];
        ViewNode view = fetchViewNode(pair.y);
        chooseMap(view, pair.y);
        splatPair(fetchSceneNode(pair.x & ~kPairFlag), boxCenter(view), kRules,
                  (pair.x & kPairFlag) != 0u, kFill, MV_MAP_RES);
    }
}

void sumViews() {
    sumCounts();
    if (laneViews != 0u) atomicAdd(sharedViews[0], laneViews);
}
void storeViews() {
    storeCounts();
    for (uint i = gl_LocalInvocationID.x; i < kCounterLevels; i += kLanes) {
        add64(groupIndex() % kCounterSlots, i, kCountRenderedViews, sharedViews[i], 0u);
    }
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    if (lane == 0u) sharedAdded = 0u;
    for (uint i = lane; i < kCounterLevels; i += kLanes) sharedViews[i] = 0u;
    clearCounts();
    groupBarrier();

    Children children = takeChildren();
    testChildren(children);
    placeChildren(children);
#if MV_COUNT
    sumViews();
#endif
    groupBarrier();

    uvec3 added = unpackCounts(sharedAdded);
    if (lane == 0u) reserve(added.x, added.z);
#if MV_COUNT
    storeViews();
#endif
    groupBarrier();
    append(added.x, added.z);
    drawPairs(added.y);
}
