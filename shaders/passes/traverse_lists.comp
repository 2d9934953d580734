// View-major traversal: one work group takes one view node of the current level, tests the scene
// nodes that its parent's pairs handed on, descends the scene tree from there, renders into its
// map, and leaves the list of scene nodes that its children have to look at. The same pairs as the
// published queue of [Kol19 §3.2], without storing them. The map starts as what the parent's map
// saw, re-centred: that is the fusion. Flat hierarchies (ManyLoDs [HREB11 §3.1]) have no parents
// and start at the scene's root.
//
// A list is a chain of chunks [entries, next chunk, entry...] in one buffer; a view node's head is
// its newest chunk. Scene nodes whose children are to be tested are a stack at the front of the
// shared entries, those to hand on grow from the back and are written out when space runs short.
// Leaves hand nothing on: there the back holds splats of many texels, filled by all lanes together.
// Other rendered nodes wait until there is one for every lane.
//
// Software renderers end every loop of an invocation after 65535 iterations in all. A work group
// that has spent its budget of them therefore saves its entries and its place and is resumed by a
// further dispatch.
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/fuse.glsl"
#include "shaders/shared/pair.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = 0) uniform usamplerBuffer sceneNodes;
layout(binding = 1) uniform usamplerBuffer viewNodes;
layout(binding = 2) uniform usamplerBuffer parentLists;  // the level above
layout(binding = 3) uniform usamplerBuffer parentMaps;
layout(binding = 4) uniform usamplerBuffer ownLists;  // of this level: saved stacks

layout(std430, binding = 1) restrict buffer StatusBuffer { uint status[]; };  // see traversal_job.h
layout(std430, binding = 2) restrict writeonly buffer ListBuffer { uint lists[]; };
layout(std430, binding = 3) restrict buffer HeadBuffer { uint heads[]; };
layout(std430, binding = 4) restrict readonly buffer MapOfNodeBuffer { uint mapOfNode[]; };
layout(std430, binding = 5) restrict buffer LeafMapBuffer { uint leafMaps[]; };
layout(std430, binding = 6) restrict buffer WorkMapBuffer { uint workMaps[]; };
#if MV_MIPS
layout(std430, binding = 7) restrict buffer MipBuffer { uint mips[]; };
#endif
struct Suspended {
    uint node, newest, nextChunk, listAt, listLeft, stackChunk, stackEntries, largeEntries;
};
layout(std430, binding = 9) restrict readonly buffer ResumeBuffer { Suspended resumed[]; };
layout(std430, binding = 10) restrict writeonly buffer SuspendBuffer { Suspended suspended[]; };

uniform float pairRes;   // see pair.glsl
uniform uint firstNode;  // of the level's range
uniform uint nodeCount;
uniform uint firstParentNode;  // of the range of the level above
uniform uint firstOwnedView;   // pairs of nodes that start before it count elsewhere
uniform uint listCapacity;     // words
uniform uint statusIndex;
uniform uint loopBudget;    // iterations
uniform uint resume;        // 1: work groups go on with `resumed`
uniform uint suspendIndex;  // status counter of `suspended`

const bool kPublished = MV_PUBLISHED == 1;
const bool kFill = MV_HOLE_FILL == 1;
const uint kRes = uint(MV_VIEW_RES);
const uint kLanes = uint(MV_WORKGROUP_SIZE);
const uint kEntries = uint(MV_SHARED_ENTRIES);
// Popping one node at a time, newest first, needs at most this: seven siblings a level wait.
const uint kReserve = 7u * 11u + 8u;
const uint kForcedBit = 0x80000000u;
// Iterations of one round at most: eight children to test against eight corners each, their places,
// nine draws of up to 32 texels (or nine coarser levels).
const uint kRoundCost = MV_PUBLISHED == 1 ? 200u : 420u;

shared uint sharedEntries[MV_SHARED_ENTRIES];
shared uint sharedDraws[MV_WORKGROUP_SIZE * 9];  // a round's and what waited before it
shared uint sharedAdded[2];                      // of a round: pushed | kept << 10 | to draw << 20
shared uint sharedValue;
#if MV_MAP_SHARED
shared uint sharedMap[2 * MV_VIEW_RES * MV_VIEW_RES];
#endif

bool mapIsLeaf;
uint mapBase;  // in leafMaps or workMaps
uint mipBase;
#if MV_MAP_SHARED
#define MV_SPLAT(texel, bits) atomicMin(sharedMap[texel], bits)
#else
void splatGlobal(uint texel, uint bits) {
    if (mapIsLeaf) {
        atomicMin(leafMaps[mapBase + texel], bits);
    } else {
        atomicMin(workMaps[mapBase + texel], bits);
    }
}
#define MV_SPLAT(texel, bits) splatGlobal(texel, bits)
#endif
#if MV_MIPS
#define MV_SPLAT_MIP(texel, bits) atomicMin(mips[mipBase + (texel)], bits)
#endif
#include "shaders/passes/pair_counters.glsl"
#include "shaders/shared/splat.glsl"

void storeTexel(uint texel, uint bits) {
    if (mapIsLeaf) {
        leafMaps[mapBase + texel] = bits;
    } else {
        workMaps[mapBase + texel] = bits;
    }
}

uint loadTexel(uint texel) {
    return mapIsLeaf ? leafMaps[mapBase + texel] : workMaps[mapBase + texel];
}

// Writes `count` shared entries, from `first` on by `stride`, as a chunk of this level's lists that
// points to `next`, and returns it. Overflow sets the flag that makes the frame start again in
// smaller parts.
uint writeChunk(uint first, int stride, uint count, uint next) {
    uint lane = gl_LocalInvocationID.x;
    if (lane == 0u) {
        uint at = atomicAdd(status[statusIndex], count + 2u);
        if (at + count + 2u > listCapacity) {
            status[0] = 1u;
            at = kNone;
        } else {
            lists[at] = count;
            lists[at + 1u] = next;
        }
        sharedValue = at;
    }
    barrier();
    uint chunk = sharedValue;
    if (chunk != kNone) {
        for (uint i = lane; i < count; i += kLanes) {
            lists[chunk + 2u + i] = sharedEntries[uint(int(first) + stride * int(i))];
        }
    }
    barrier();
    return chunk == kNone ? next : chunk;
}

// How many entries the next round takes: from the stack, or from the list where that is low. 0:
// there is none, or the back has to be cleared first. A list entry may push one, a popped one
// seven more than itself.
uint entriesToTake(uint top, uint kept, uint listLeft, out bool fromList) {
    int room = int(kEntries) - int(kReserve) - int(top + kept);
    fromList = listLeft > 0u && top < kLanes && room >= int(kLanes);
    uint wanted = min(kLanes, fromList ? listLeft : top);
    uint taken = fromList ? wanted : min(wanted, uint(max(1, room / 7)));
    bool crowded = taken < wanted && kept >= kEntries / 8u;
    bool full = !fromList && top + kept + 7u > kEntries;
    return crowded || full ? 0u : taken;
}

// Renders the last `count` <= kLanes of the waiting nodes.
void drawWaiting(uint waiting, uint count, vec3 center) {
    uint lane = gl_LocalInvocationID.x;
    if (lane < count) {
        uint entry = sharedDraws[waiting - 1u - lane];
        splatPair(fetchSceneNode(sceneNodes, entry & ~kForcedBit), center, kPublished,
                  (entry & kForcedBit) != 0u, kFill, kRes);
    }
}

// One splat of many texels, shared by all lanes; returns the iterations it took.
uint drawLarge(uint index, vec3 center) {
    SceneNode scene = fetchSceneNode(sceneNodes, index);
    SplatArea area = splatAreaOf(scene, center, kRes);
    for (uint k = gl_LocalInvocationID.x; k < area.count; k += kLanes) {
        splatAreaTexel(area, true, scene.surface, k, kRes);
    }
    return area.count / kLanes + 2u;
}

void main() {
    uint group = groupIndex();
    if (group >= nodeCount) return;
    uint lane = gl_LocalInvocationID.x;
    Suspended state = Suspended(firstNode + group, kNone, kNone, 0u, 0u, kNone, 0u, 0u);
    if (resume != 0u) state = resumed[group];
    uint node = state.node;
    ViewNode view = fetchViewNode(viewNodes, node);
    vec3 center = boxCenter(view);
    uint parent = parentOf(view);
    bool isRoot = parent == kNone;

    uint map = mapOfNode[node];
#if MV_FUSE
    mapIsLeaf = isLeaf(view);
    mapBase = (mapIsLeaf ? map : node - firstNode) * mapTexels(kRes);
#else
    mapIsLeaf = true;
    mapBase = node * mapTexels(kRes);
#endif
    mipBase = map * mipTexels(kRes);

    // The map begins as what the parent saw.
    vec3 offset = vec3(0.0);
    uint parentBase = 0u;
    if (!isRoot) {
        offset = minus3(boxCenter(fetchViewNode(viewNodes, parent)), center);
        parentBase = (parent - firstParentNode) * mapTexels(kRes);
    }
    bool fuse = MV_FUSE == 1 && !isRoot;
    if (resume == 0u) {
        for (uint texel = lane; texel < mapTexels(kRes); texel += kLanes) {
            uint bits = kNone;
            if (fuse) {
                bits = texelFetch(parentMaps, int(parentBase + texel)).x;
                bits = recenterDepth(bits, texel, kRes, offset);
            }
#if MV_MAP_SHARED
            sharedMap[texel] = bits;
#else
            storeTexel(texel, bits);
#endif
        }
    } else {
#if MV_MAP_SHARED
        for (uint texel = lane; texel < mapTexels(kRes); texel += kLanes) {
            sharedMap[texel] = loadTexel(texel);
        }
#endif
        for (uint i = lane; i < state.stackEntries; i += kLanes) {
            sharedEntries[i] = texelFetch(ownLists, int(state.stackChunk + 2u + i)).x;
        }
        for (uint i = lane; i < state.largeEntries; i += kLanes) {
            sharedEntries[kEntries - 1u - i] = texelFetch(ownLists, int(state.newest + 2u + i)).x;
        }
    }
    if (lane == 0u) {
        sharedAdded[0] = 0u;
        sharedAdded[1] = 0u;
        uint head = resume != 0u ? state.nextChunk : isRoot ? kNone : heads[parent];
        sharedValue = status[0] != 0u ? kNone : head;
    }
    clearCounts();
#if !MV_MAP_SHARED
    memoryBarrierBuffer();
#endif
    barrier();

    // All loop variables below are the same in every lane. Software renderers execute what an `if`
    // guards under masks, only loops skip it: so whatever is rare stands outside the inner loop.
    bool leaf = isLeaf(view);
    uint nextChunk = sharedValue;  // of the parent's list
    uint listAt = state.listAt;
    uint listLeft = resume != 0u ? state.listLeft : isRoot ? 1u : 0u;
    uint newest = leaf ? kNone : state.newest;  // chunk of our own list
    uint top = state.stackEntries;              // of the stack
    uint kept = state.largeEntries;             // entries to hand on, or large splats
    uint waiting = 0u;                          // nodes to draw
    uint spent = 0u;                            // iterations
    uint round = 0u;
    bool finished = false;
    for (;;) {
        if (listLeft == 0u && nextChunk != kNone) {
            listAt = nextChunk + 2u;
            listLeft = texelFetch(parentLists, int(nextChunk)).x;
            nextChunk = texelFetch(parentLists, int(nextChunk + 1u)).x;
        }
        if (listLeft == 0u && top == 0u) {
            if (leaf && kept > 0u && spent < loopBudget) {
                do {
                    spent += drawLarge(sharedEntries[kEntries - kept], center);
                } while (--kept > 0u && spent < loopBudget);
            }
            finished = !leaf || kept == 0u;
            break;
        }
        if (spent >= loopBudget) break;

        bool fromList = false;
        uint taken = entriesToTake(top, kept, listLeft, fromList);
        if (taken == 0u) {
            // Crowded: make room at the back.
            if (leaf) {
                do {
                    spent += drawLarge(sharedEntries[kEntries - kept], center);
                } while (--kept > 0u && spent < loopBudget);
            } else {
                newest = writeChunk(kEntries - 1u, -1, kept, newest);
                kept = 0u;
            }
            continue;
        }
        do {
            // Each lane's run of scene nodes to test: one of the list, or the children of one that
            // it pops.
            uint first = 0u;
            uint count = 0u;
            if (lane < taken) {
                if (fromList) {
                    first = isRoot ? 0u : texelFetch(parentLists, int(listAt + lane)).x;
                    count = 1u;
                } else {
                    uint children = fetchSceneChildren(sceneNodes, sharedEntries[top - 1u - lane]);
                    first = firstChildOf(children);
                    count = childCountOf(children);
                }
            }
            listAt += fromList ? taken : 0u;
            listLeft -= fromList ? taken : 0u;
            top -= fromList ? 0u : taken;

            uint push = 0u;
            uint keep = 0u;
            uint draw = 0u;
            uint forced = 0u;
            if (count > 0u) {
                uint k = 0u;
                do {
                    SceneNode scene = fetchSceneNode(sceneNodes, first + k);
                    uint decision = decidePair(scene, view, kPublished, pairRes);
                    bool large = kFill && !kPublished && decision == kPairForced &&
                                 isLargeSplat(scene, center, kRes);
                    bool small = decision == kPairRendered || (decision == kPairForced && !large);
                    push |= uint(decision == kPairSplitScene) << k;
                    keep |= uint(decision == kPairSplitView || large) << k;
                    draw |= uint(small) << k;
                    forced |= uint(decision == kPairForced) << k;
#if MV_COUNT
                    countPair(decision, scene.level);
#endif
                } while (++k < count);
            }

            // Places for what goes on: one atomic a lane, then a barrier, after which all popped
            // entries have been read as well.
            uint mine =
                uint(bitCount(push)) | uint(bitCount(keep)) << 10u | uint(bitCount(draw)) << 20u;
            uint base = atomicAdd(sharedAdded[round & 1u], mine);
            barrier();
            uint added = sharedAdded[round & 1u];
            if (lane == 0u) sharedAdded[(round + 1u) & 1u] = 0u;
            if (push != 0u) {
                uint at = top + (base & 0x3FFu);
                do {
                    sharedEntries[at++] = first + uint(findLSB(push));
                    push &= push - 1u;
                } while (push != 0u);
            }
            if (keep != 0u) {
                uint at = kEntries - 1u - kept - (base >> 10u & 0x3FFu);
                do {
                    sharedEntries[at--] = first + uint(findLSB(keep));
                    keep &= keep - 1u;
                } while (keep != 0u);
            }
            if (draw != 0u) {
                uint at = waiting + (base >> 20u);
                do {
                    uint k = uint(findLSB(draw));
                    uint bit = (forced >> k & 1u) != 0u ? kForcedBit : 0u;
                    sharedDraws[at++] = (first + k) | bit;
                    draw &= draw - 1u;
                } while (draw != 0u);
            }
            top += added & 0x3FFu;
            kept += added >> 10u & 0x3FFu;
            waiting += added >> 20u;
            spent += kRoundCost;
            ++round;
            barrier();
            if (waiting >= kLanes) {
                do {
                    drawWaiting(waiting, kLanes, center);
                    waiting -= kLanes;
                } while (waiting >= kLanes);
            }
            taken = spent < loopBudget ? entriesToTake(top, kept, listLeft, fromList) : 0u;
        } while (taken > 0u);
    }
    drawWaiting(waiting, waiting, center);
    if (kept > 0u) newest = writeChunk(kEntries - 1u, -1, kept, newest);
    if (finished) {
        if (lane == 0u && !leaf) heads[node] = newest;
    } else {
        uint stackChunk = top > 0u ? writeChunk(0u, 1, top, kNone) : kNone;
        if (lane == 0u) {
            uint at = atomicAdd(status[suspendIndex], 1u);
            suspended[at] = Suspended(node, newest, nextChunk, listAt, listLeft, stackChunk, top,
                                      leaf ? kept : 0u);
        }
    }

#if MV_COUNT
    sumCounts();
#endif
    barrier();
#if MV_MAP_SHARED
    for (uint texel = lane; texel < mapTexels(kRes); texel += kLanes) {
        storeTexel(texel, sharedMap[texel]);
    }
#endif
#if MV_COUNT
    if (view.firstView >= firstOwnedView) {
        storeCounts();
        for (uint level = lane; level < kCounterLevels; level += kLanes) {
            uint high = 0u;
            uint low = 0u;
            umulExtended(sharedCounts[level * 5u + 1u], view.viewCount, high, low);
            add64(group % kCounterSlots, level, 5u, low, high);
        }
    }
#endif
}
