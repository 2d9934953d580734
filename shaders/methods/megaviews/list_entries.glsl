// Entries of a work group of traverse_lists.comp: scene nodes in shared memory, and the lists in
// which they are handed on.
//
// A list is a chain of chunks [entries, next chunk, entry...] in one buffer; a view node's head is
// its newest chunk. Scene nodes whose children are to be tested are a stack at the front of the
// shared entries, those to hand on grow from the back and are written out when space runs short.
// Behind them wait the nodes to draw, first the small ones, then those of many texels.

layout(binding = kUnitParentLists) uniform usamplerBuffer parentLists;  // the level above
layout(binding = kUnitOwnLists) uniform usamplerBuffer ownLists;  // of this level: saved stacks

layout(std430, binding = kBlockStatus) restrict buffer StatusBuffer { uint status[]; };
layout(std430, binding = kBlockLists) restrict writeonly buffer ListBuffer { uint lists[]; };

uniform uint listCapacity;  // words
uniform uint statusIndex;

const uint kLanes = uint(MV_WORKGROUP_SIZE);
const uint kEntries = uint(MV_SHARED_ENTRIES);
// Popping one node at a time, newest first, needs at most this: seven siblings a level wait.
const uint kReserve = 7u * kTreeLevels + 8u;

// A round draws what waited before it and up to eight a lane; large ones are drawn late.
const uint kDrawsAt = kEntries;
const uint kLargesAt = kDrawsAt + 9u * kLanes;
const uint kLargesMost = 128u;

// An entry to draw: a scene node, which packChildren() gives 28 bits, and how.
const uint kEntryNode = 0x0FFFFFFFu;
const uint kEntryForced = 0x80000000u;  // the pair is kPairForced
const uint kEntryInside = 0x40000000u;  // only if facesSurface

shared uint sharedEntries[kLargesAt + kLargesMost + 8u * kLanes];
shared uint sharedChunk;

// The place of the work group in its traversal: the same in every lane.
uint nextChunk;  // of the parent's list
uint listAt;
uint listLeft;
uint newest;  // chunk of our own list
uint top;     // of the stack
uint kept;    // entries to hand on

// Writes `count` shared entries, from `first` on by `stride`, as a chunk of this level's lists that
// points to `next`, and returns it. Overflow sets the flag that makes the frame start again in
// smaller parts.
uint writeChunk(uint first, int stride, uint count, uint next) {
    uint lane = gl_LocalInvocationID.x;
    if (lane == 0u) {
        uint words = count + kChunkHeader;
        uint at = atomicAdd(status[statusIndex], words);
        if (at + words > listCapacity) {
            status[kStatusOverflow] = 1u;
            at = kNone;
        } else {
            lists[at] = count;
            lists[at + 1u] = next;
        }
        sharedChunk = at;
    }
    groupBarrier();
    uint chunk = sharedChunk;
    if (chunk != kNone) {
        for (uint i = lane; i < count; i += kLanes) {
            lists[chunk + kChunkHeader + i] = sharedEntries[uint(int(first) + stride * int(i))];
        }
    }
    groupBarrier();
    return chunk == kNone ? next : chunk;
}

void writeKept() { newest = writeChunk(kEntries - 1u, -1, kept, newest); }

// What a work group that goes on had in its shared entries.
void restoreEntries(Suspended state) {
    uint lane = gl_LocalInvocationID.x;
    for (uint i = lane; i < state.stackEntries; i += kLanes) {
        sharedEntries[i] = texelFetch(ownLists, int(state.stackChunk + kChunkHeader + i)).x;
    }
    for (uint i = lane; i < state.largeEntries; i += kLanes) {
        sharedEntries[kLargesAt + i] =
            texelFetch(ownLists, int(state.largeChunk + kChunkHeader + i)).x;
    }
}

// On to the next chunk of the parent's list where the last one is used up.
void openChunk() {
    if (listLeft == 0u && nextChunk != kNone) {
        listAt = nextChunk + kChunkHeader;
        listLeft = texelFetch(parentLists, int(nextChunk)).x;
        nextChunk = texelFetch(parentLists, int(nextChunk + 1u)).x;
    }
}

// Entries of a list that a lane tests in a round.
const uint kListRun = 4u;

// How many entries the next round takes: from the stack, or from the list where that is low. 0:
// there is none, or the back has to be cleared first. A list entry may push one, a popped one
// seven more than itself.
uint entriesToTake(out bool fromList) {
    int room = int(kEntries) - int(kReserve) - int(top + kept);
    fromList = listLeft > 0u && top < kLanes && room >= int(kLanes);
    uint wanted = min(kLanes, top);
    if (fromList) wanted = min(min(kListRun * kLanes, uint(room)), listLeft);
    uint taken = fromList ? wanted : min(wanted, uint(max(1, room / 7)));
    bool crowded = taken < wanted && kept >= kEntries / 8u;
    bool full = !fromList && top + kept + 7u > kEntries;
    return crowded || full ? 0u : taken;
}
