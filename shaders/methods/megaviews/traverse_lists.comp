// View-major traversal: one work group takes one view node of the current level, tests the scene
// nodes that its parent's pairs handed on, descends the scene tree from there, renders into its
// map, and leaves the list of scene nodes that its children have to look at. The same pairs as the
// published queue of [Kol19 §3.2], without storing them. The map starts as what the parent's map
// saw, re-centred: that is the fusion. Flat hierarchies (ManyLoDs [HREB11 §3.1]) have no parents
// and start at the scene's root.
//
// Nodes that are rendered wait until there is one for every lane; those of many texels wait longer
// and are filled by all lanes together.
//
// Software renderers end every loop of an invocation after 65535 iterations in all. A work group
// that has spent its budget of them therefore saves its entries and its place and is resumed by a
// further dispatch. They also execute what an `if` guards under masks, only loops skip it: so
// whatever is rare stands outside the inner loop.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/fuse.glsl"
#include "shaders/shared/pair.glsl"
#include "shaders/shared/traversal_data.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitMapOfNode) uniform usamplerBuffer mapOfNode;

layout(std430, binding = kBlockListHeads) restrict buffer HeadBuffer { uint heads[]; };
layout(std430, binding = kBlockResumed) restrict readonly buffer ResumeBuffer {
    Suspended resumed[];
};
layout(std430, binding = kBlockSuspended) restrict writeonly buffer SuspendBuffer {
    Suspended suspended[];
};

uniform float pairRes;   // see pair.glsl
uniform uint firstNode;  // of the level's range
uniform uint nodeCount;
uniform uint firstParentNode;  // of the range of the level above
uniform uint firstOwnedView;   // pairs of nodes that start before it count elsewhere
uniform uint loopBudget;       // iterations
uniform uint resume;           // 1: work groups go on with `resumed`
uniform uint suspendIndex;     // status counter of `suspended`

const uint kRules = uint(MV_RULES);
const bool kFill = MV_HOLE_FILL == 1;
// Iterations of one round at most: eight children to test against eight corners each, their places,
// nine draws of up to 32 texels (or nine coarser levels).
const uint kRoundCost = (kRules & kRuleSurfaces) != 0u ? 420u : 200u;

shared uint sharedAdded[2];  // of a round: pushed, kept, to draw
shared uint sharedLarge;     // of all rounds
shared uint sharedHead;      // of the parent's list
#if MV_MAP_SHARED
shared uint sharedMap[kMapFaces * MV_MAP_RES * MV_MAP_RES];
#endif

#define MV_WORK_MAPS
#define MV_PARENT_MAPS
#if MV_MIPS
#define MV_MIP_MAPS
#endif
#include "shaders/passes/map_texels.glsl"
NodeMap ownMap;
uint ownMips;
#if MV_MAP_SHARED
#define MV_SPLAT(texel, bits) atomicMin(sharedMap[texel], bits)
#else
#define MV_SPLAT(texel, bits) lowerMapTexel(ownMap, texel, bits)
#endif
#if MV_MIPS
#define MV_SPLAT_MIP(mipTexel, bits) lowerMipTexel(ownMips, mipTexel, bits)
#endif
#include "shaders/methods/megaviews/list_entries.glsl"
#include "shaders/methods/megaviews/packed_counts.glsl"
#include "shaders/methods/megaviews/pair_counters.glsl"
#include "shaders/shared/splat.glsl"

// The work group's view node, and where it stands; the same in every lane.
uint node;
ViewNode view;
vec3 center;
uint parent;
uint waiting;  // nodes to draw
uint larges;   // nodes of many texels to draw
uint spent;    // iterations
uint rounds;

// ---------------------------------------------------------------- maps

void chooseMap() {
    uint map = texelFetch(mapOfNode, int(node)).x;
#if MV_FUSE
    ownMap = NodeMap(isLeaf(view) ? map : node - firstNode, !isLeaf(view));
#else
    ownMap = NodeMap(node, false);
#endif
    ownMips = map;
}

// The map begins as what the parent saw.
void beginMap() {
    bool fuse = MV_FUSE == 1 && parent != kNone;
    vec3 offset = vec3(0.0);
    if (fuse) offset = minus3(fetchViewNodeCenter(parent), center);
    for (uint texel = gl_LocalInvocationID.x; texel < mapTexels(MV_MAP_RES); texel += kLanes) {
        uint bits = kNone;
        if (fuse) {
            bits = recenterDepth(loadParentTexel(parent - firstParentNode, texel), texel,
                                 MV_MAP_RES, offset);
        }
#if MV_MAP_SHARED
        sharedMap[texel] = bits;
#else
        storeMapTexel(ownMap, texel, bits);
#endif
    }
}

void loadMap() {
#if MV_MAP_SHARED
    for (uint texel = gl_LocalInvocationID.x; texel < mapTexels(MV_MAP_RES); texel += kLanes) {
        sharedMap[texel] = loadMapTexel(ownMap, texel);
    }
#endif
}

void storeMap() {
#if MV_MAP_SHARED
    for (uint texel = gl_LocalInvocationID.x; texel < mapTexels(MV_MAP_RES); texel += kLanes) {
        storeMapTexel(ownMap, texel, sharedMap[texel]);
    }
#endif
}

// ---------------------------------------------------------------- drawing

// Renders the last `count` <= kLanes of the waiting nodes.
void drawWaiting(uint count) {
    uint lane = gl_LocalInvocationID.x;
    if (lane < count) {
        uint entry = sharedEntries[kDrawsAt + waiting - 1u - lane];
        splatPair(fetchSceneNode(entry & kEntryNode), center, kRules, (entry & kEntryForced) != 0u,
                  kFill, MV_MAP_RES);
    }
}

// Nodes of many texels, each shared by all lanes, while the budget lasts.
void drawLarge() {
    do {
        uint entry = sharedEntries[kLargesAt + --larges];
        SceneNode scene = fetchSceneNode(entry & kEntryNode);
        bool ask = (entry & kEntryInside) != 0u;
        bool seen = !ask || facesSurface(scene, view);
        SplatArea area = splatAreaOf(scene, center, true, MV_MAP_RES);
        uint count = seen ? area.count : 0u;
        if (gl_LocalInvocationID.x < count) {
            uint k = gl_LocalInvocationID.x;
            do {
                splatAreaTexel(area, splatTexelOf(area, k), MV_MAP_RES);
                k += kLanes;
            } while (k < count);
        }
#if MV_COUNT
        if (ask && gl_LocalInvocationID.x == 0u) {
            countPair(seen ? kPairForced : kPairSkipped, scene.level);
        }
#endif
        spent += count / kLanes + 2u;
    } while (larges > 0u && spent < loopBudget);
    groupBarrier();
    if (gl_LocalInvocationID.x == 0u) sharedLarge = larges;
    groupBarrier();
}

// ---------------------------------------------------------------- rounds

// A lane's run of scene nodes to test, and which of them go where.
struct Run {
    uint first, count;
    bool listed;  // entries of the list from `first` on, else nodes
    uint push, keep, draw, large, forced, inside;  // masks
};

uint nodeOfRun(Run run, uint k) {
    return run.listed ? texelFetch(parentLists, int(run.first + k)).x : run.first + k;
}

// A few nodes of the list, or the children of one that the lane pops.
Run takeRun(uint taken, bool fromList) {
    uint lane = gl_LocalInvocationID.x;
    Run run = Run(0u, 0u, fromList && parent != kNone, 0u, 0u, 0u, 0u, 0u, 0u);
    if (fromList) {
        uint begin = min(lane * kListRun, taken);
        run.first = parent == kNone ? 0u : listAt + begin;
        run.count = min(taken - begin, kListRun);
        listAt += taken;
        listLeft -= taken;
    } else {
        if (lane < taken) {
            uint children = fetchSceneChildren(sharedEntries[top - 1u - lane]);
            run.first = firstChildOf(children);
            run.count = childCountOf(children);
        }
        top -= taken;
    }
    return run;
}

void testRun(inout Run run) {
    if (run.count > 0u) {
        uint k = 0u;
        do {
            SceneNode scene = fetchSceneNode(nodeOfRun(run, k));
            // What is drawn as points is decided here; the rest waits for drawLarge().
            uint decision = kFill ? decidePairOutside(scene, view, kRules, pairRes)
                                  : decidePair(scene, view, kRules, pairRes);
            bool large = decision == kPairInside ||
                         (decision == kPairForced && kFill && hasRule(kRules, kRuleSurfaces) &&
                          isLargeSplat(scene, center, MV_MAP_RES));
            run.push |= uint(decision == kPairSplitScene) << k;
            run.keep |= uint(decision == kPairSplitView) << k;
            run.draw |= uint(pairRendered(decision) && !large) << k;
            run.large |= uint(large) << k;
            run.forced |= uint(decision == kPairForced) << k;
            run.inside |= uint(decision == kPairInside) << k;
#if MV_COUNT
            countPair(decision, scene.level);
#endif
        } while (++k < run.count);
    }
}

// Writes what goes on to its places: one atomic a lane, then a barrier, after which all popped
// entries have been read as well.
void placeRun(Run run) {
    uvec3 before =
        unpackCounts(atomicAdd(sharedAdded[rounds & 1u], packCounts(run.push, run.keep, run.draw)));
    uint largeAt = kLargesAt;
    if (run.large != 0u) largeAt += atomicAdd(sharedLarge, uint(bitCount(run.large)));
    groupBarrier();
    uvec3 added = unpackCounts(sharedAdded[rounds & 1u]);
    larges = sharedLarge;
    if (gl_LocalInvocationID.x == 0u) sharedAdded[(rounds + 1u) & 1u] = 0u;
    uint pushAt = top + before.x;
    uint keepAt = kEntries - 1u - kept - before.y;
    uint drawAt = kDrawsAt + waiting + before.z;
    uint going = run.push | run.keep | run.draw | run.large;
    if (going != 0u) {
        do {
            uint k = takeBit(going);
            uint push = run.push >> k & 1u;
            uint keep = run.keep >> k & 1u;
            uint draw = run.draw >> k & 1u;
            uint at = push != 0u ? pushAt : keep != 0u ? keepAt : draw != 0u ? drawAt : largeAt;
            sharedEntries[at] = nodeOfRun(run, k) | (hasBit(run.forced, k) ? kEntryForced : 0u) |
                                (hasBit(run.inside, k) ? kEntryInside : 0u);
            pushAt += push;
            keepAt -= keep;
            drawAt += draw;
            largeAt += 1u - push - keep - draw;
        } while (going != 0u);
    }
    top += added.x;
    kept += added.y;
    waiting += added.z;
    spent += kRoundCost;
    ++rounds;
    groupBarrier();
}

// Takes entries, tests them and places what they lead to, until the back is crowded, nothing is
// left, or the budget is spent. taken: of the first round, at least one.
void testEntries(uint taken, bool fromList) {
    do {
        Run run = takeRun(taken, fromList);
        testRun(run);
        placeRun(run);
        if (waiting >= kLanes) {
            do {
                drawWaiting(kLanes);
                waiting -= kLanes;
            } while (waiting >= kLanes);
        }
        taken = spent < loopBudget && larges <= kLargesMost ? entriesToTake(fromList) : 0u;
    } while (taken > 0u);
}

// ---------------------------------------------------------------- beginning and end

// Sets up the map, the shared arrays and the place in the traversal, anew or as it was suspended.
void begin(Suspended state) {
    if (resume == 0u) {
        beginMap();
    } else {
        loadMap();
        restoreEntries(state);
    }
    if (gl_LocalInvocationID.x == 0u) {
        sharedAdded[0] = 0u;
        sharedAdded[1] = 0u;
        uint head = resume != 0u ? state.nextChunk : parent == kNone ? kNone : heads[parent];
        sharedHead = status[kStatusOverflow] != 0u ? kNone : head;
        sharedLarge = state.largeEntries;
    }
    clearCounts();
#if !MV_MAP_SHARED
    memoryBarrierBuffer();
#endif
    groupBarrier();
    nextChunk = sharedHead;
    listAt = state.listAt;
    listLeft = resume != 0u ? state.listLeft : parent == kNone ? 1u : 0u;
    newest = state.newest;
    top = state.stackEntries;
    kept = 0u;
    larges = state.largeEntries;
    waiting = 0u;
    spent = 0u;
    rounds = 0u;
}

// Everything that the view node looks at, while the budget lasts; false if something is left.
bool traverse() {
    for (;;) {
        openChunk();
        if (spent >= loopBudget || (listLeft == 0u && top == 0u)) break;
        bool fromList = false;
        uint taken = entriesToTake(fromList);
        if (larges > kLargesMost) {
            drawLarge();
        } else if (taken > 0u) {
            testEntries(taken, fromList);
        } else {
            writeKept();
            kept = 0u;
        }
    }
    if (larges > 0u && spent < loopBudget) drawLarge();
    return listLeft == 0u && nextChunk == kNone && top == 0u && larges == 0u;
}

// Hands on what is kept, or saves everything for the dispatch that goes on.
void end(bool finished) {
    uint lane = gl_LocalInvocationID.x;
    if (kept > 0u) writeKept();
    if (finished) {
        if (lane == 0u && !isLeaf(view)) heads[node] = newest;
    } else {
        uint stackChunk = top > 0u ? writeChunk(0u, 1, top, kNone) : kNone;
        uint largeChunk = larges > 0u ? writeChunk(kLargesAt, 1, larges, kNone) : kNone;
        if (lane == 0u) {
            uint at = atomicAdd(status[suspendIndex], 1u);
            suspended[at] = Suspended(node, newest, nextChunk, listAt, listLeft, stackChunk, top,
                                      largeChunk, larges);
        }
    }
}

void storeOwnedCounts(uint group) {
#if MV_COUNT
    if (view.firstView >= firstOwnedView) {
        storeCounts();
        for (uint level = gl_LocalInvocationID.x; level < kCounterLevels; level += kLanes) {
            uint high = 0u;
            uint low = 0u;
            umulExtended(sharedCounts[level * kPairCounters + kCountRendered], view.viewCount, high,
                         low);
            add64(group % kCounterSlots, level, kCountRenderedViews, low, high);
        }
    }
#endif
}

void main() {
    uint group = groupIndex();
    if (group >= nodeCount) return;
    Suspended state = Suspended(firstNode + group, kNone, kNone, 0u, 0u, kNone, 0u, kNone, 0u);
    if (resume != 0u) state = resumed[group];
    node = state.node;
    view = fetchViewNode(node);
    center = boxCenter(view);
    parent = parentOf(view);
    chooseMap();

    begin(state);
    bool finished = traverse();
    drawWaiting(waiting);
    end(finished);
#if MV_COUNT
    sumCounts();
#endif
    groupBarrier();
    storeMap();
    storeOwnedCounts(group);
}
