// What the kernels that bring cuts up to date share; the readable form is mv::ViewCuts. A lane
// takes one node, tests what there is to test, and places what comes of it: the node in the new
// cut, or its children among those of the next round.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/cut_data.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/traversal_data.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitSceneParents) uniform usamplerBuffer sceneParents;

layout(std430, binding = kBlockStatus) restrict buffer StatusBuffer { uint status[]; };
layout(std430, binding = kBlockCutNodes) restrict writeonly buffer CutBuffer { CutEntry newCut[]; };
layout(std430, binding = kBlockCutPending) restrict writeonly buffer PendingBuffer {
    CutPending nextPending[];
};
uniform float pairRes;                   // see pair.glsl
uniform uint movingBegin[kSceneLevels];  // by level the first scene node that moves
uniform uint iterations;                 // CutOptions
uniform uint cutCapacity;                // nodes
uniform uint pendingCapacity;            // nodes
uniform uint nextRound;                  // of the nodes that are pushed; status counts them

const uint kRules = uint(MV_RULES);
const uint kLanes = uint(MV_WORKGROUP_SIZE);

#include "shaders/methods/megaviews/pair_counters.glsl"

bool splits(uint decision) { return decision == kPairSplitScene; }

struct Tested {
    uint decision;
    float clearance;
};
Tested testNode(uint node, ViewNode view) {
    SceneNode scene = fetchSceneNode(node);
    PairTerms terms;
    uint decision = decidePair(scene, view, kRules, pairRes, terms);
#if MV_COUNT
    countPair(decision, scene.level);
#endif
    // Where the node itself moves nothing is known of the next frame.
    bool moves = node >= movingBegin[scene.level];
    return Tested(decision, moves ? -1.0f : pairClearance(scene, view, decision, pairRes, terms));
}

uint parentOfScene(uint node) { return texelFetch(sceneParents, int(node)).x; }

// What a lane's node leads to.
struct Placed {
    bool kept;
    CutEntry entry;
    uint first, count;   // children for the next round
    CutPending pending;  // what they have in common
    uint counted;        // mask of kCutCount*
};
Placed nothing() {
    CutEntry entry = CutEntry(CutNode(0u, 0.0f, 0.0f), 0u);
    return Placed(false, entry, 0u, 0u, CutPending(0u, 0u, 0.0f, 0u), 0u);
}
Placed keep(CutEntry entry, uint counted) {
    Placed p = nothing();
    p.kept = true;
    p.entry = entry;
    p.counted = counted | uint(cutDecision(entry.node) == kPairCulled) << kCutCountCulled;
    return p;
}
CutEntry entryOf(uint node, Tested tested, float above, uint slot) {
    return CutEntry(CutNode(node | tested.decision << kCutDecisionShift, tested.clearance, above),
                    slot);
}
Placed split(uint node, float above, uint slot, uint unlimited) {
    Placed p = nothing();
    uint children = fetchSceneChildren(node);
    p.first = firstChildOf(children);
    p.count = childCountOf(children);
    p.pending = CutPending(unlimited, slot, above, 0u);
    p.counted = 1u << kCutCountSplit;
    return p;
}
// A node that was tested in this round and whose ancestors split.
Placed placeNode(uint node, Tested tested, float above, uint slot, ViewNode view, uint unlimited) {
    if (!splits(tested.decision)) return keep(entryOf(node, tested, above, slot), 0u);
    if (unlimited != 0u || nextRound <= iterations) {
        return split(node, min(above, tested.clearance), slot, unlimited);
    }
    // Too large, but an update goes no further: it stands for what is below it, like a leaf.
    SceneNode leaf = fetchSceneNode(node);
    leaf.children = 0u;
    Tested coarse = Tested(decidePair(leaf, view, kRules, pairRes), -1.0f);
    return keep(entryOf(node, coarse, above, slot), 1u << kCutCountCoarse);
}

// How many nodes a group keeps and pushes, and what of; ten and eight bits each.
shared uint sharedPlaces;
shared uint sharedCounted;
shared uint sharedFirstKept;
shared uint sharedFirstPushed;
const uint kPushedShift = 10u;
const uint kKeptCountShift = 20u;

// Every lane calls this before it tests.
void beginGroup() {
    if (gl_LocalInvocationID.x == 0u) {
        sharedPlaces = 0u;
        sharedCounted = 0u;
    }
    clearCounts();
    groupBarrier();
}

void addCount(uint counter, uint n) {
    if (n != 0u) atomicAdd(status[kStatusCutCounts + counter], n);
}

// One place a group in the cut and in the next round.
void reserve() {
    uint kept = sharedPlaces & 0x3FFu;
    uint pushed = sharedPlaces >> kPushedShift & 0x3FFu;
    uint counted = sharedCounted;
    uint firstKept = kept != 0u ? atomicAdd(status[kStatusCutNodes], kept) : 0u;
    uint next = kFirstStatusCounter + nextRound;
    uint firstPushed = pushed != 0u ? atomicAdd(status[next], pushed) : 0u;
    bool full = firstKept + kept > cutCapacity || firstPushed + pushed > pendingCapacity;
    if (full) status[kStatusOverflow] = 1u;
    sharedFirstKept = full ? kNone : firstKept;
    sharedFirstPushed = firstPushed;
    addCount(kCutCountKept, sharedPlaces >> kKeptCountShift);
    addCount(kCutCountCulled, counted & 0xFFu);
    addCount(kCutCountCoarse, counted >> 8u & 0xFFu);
    addCount(kCutCountSplit, counted >> 16u & 0xFFu);
    addCount(kCutCountMerged, counted >> 24u);
}

// A pair that is rendered is rendered for one view.
void storeViews() {
    for (uint level = gl_LocalInvocationID.x; level < kCounterLevels; level += kLanes) {
        uint rendered = sharedCounts[level * kPairCounters + kCountRendered];
        add64(groupIndex() % kCounterSlots, level, kCountRenderedViews, rendered, 0u);
    }
}

// Every lane calls this.
void endGroup(Placed p) {
    uint places = uint(p.kept) | p.count << kPushedShift |
                  (p.counted >> kCutCountKept & 1u) << kKeptCountShift;
    uint before = places != 0u ? atomicAdd(sharedPlaces, places) : 0u;
    uint counted = 0u;
    for (uint k = kCutCountCulled; k < kCutCounters; ++k) {
        counted |= (p.counted >> k & 1u) << 8u * (k - kCutCountCulled);
    }
    if (counted != 0u) atomicAdd(sharedCounted, counted);
#if MV_COUNT
    sumCounts();
#endif
    groupBarrier();
    if (gl_LocalInvocationID.x == 0u) reserve();
#if MV_COUNT
    storeCounts();
    storeViews();
#endif
    groupBarrier();
    if (sharedFirstKept == kNone) return;
    if (p.kept) newCut[sharedFirstKept + (before & 0x3FFu)] = p.entry;
    uint pushedAt = sharedFirstPushed + (before >> kPushedShift & 0x3FFu);
    for (uint k = 0u; k < p.count; ++k) {
        CutPending pending = p.pending;
        pending.node |= p.first + k;
        // Its chain goes up through the first child alone.
        if (k > 0u) pending.above = kInfinity;
        nextPending[pushedAt + k] = pending;
    }
}
