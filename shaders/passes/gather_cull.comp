// Receivers x view tree -> runs of kept views [Kol19 §5.1]. One invocation walks the view tree for
// one receiver, depth first, so that kept views come in sorted order and neighbours join.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_data.glsl"
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/types.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitPowerPrefix) uniform usamplerBuffer prefix;  // power units before each view
layout(binding = kUnitTiles) uniform usamplerBuffer tiles;         // GatherTile

layout(std430, binding = kBlockRuns) buffer Runs { GatherRun runs[]; };
layout(std430, binding = kBlockReceiverLists) writeonly buffer Lists { GatherList lists[]; };

uniform uint receiverCount;  // 0 holds everything, others are tiles
uniform uint capacity;       // runs a receiver
uniform uint cullLevel;
uniform float cutoff;

// Its box and cone, and how its list is made.
struct Receiver {
    vec3 center, extent;
    vec3 axis;
    float cosCone, sinCone;
    uint level;   // nodes are kept whole from here on
    float share;  // of refineViewNode()
    bool empty;
};
Receiver fetchReceiver(uint index) {
    if (index == 0u) {
        return Receiver(vec3(0.5), vec3(1.0), vec3(0.0, 0.0, 1.0), -1.0, 0.0, 0u, kRefineShare,
                        false);
    }
    int first = int(index - 1u) * 3;
    vec4 a = uintBitsToFloat(texelFetch(tiles, first));
    vec4 b = uintBitsToFloat(texelFetch(tiles, first + 1));
    uvec4 c = texelFetch(tiles, first + 2);
    return Receiver(a.xyz, b.xyz, uintBitsToFloat(c.xyz), a.w, b.w, cullLevel, kRefineShare,
                    c.w == 0u);
}

// Views of one importance, one after another.
struct Run {
    uint first, end;
    uint shift;  // of the importance
};

Receiver receiver;
uint receiverIndex;
GatherList list;  // so far
float listSum;    // of its power units times their importance
Run open;         // the last of its runs

// What a node keeps: all of its views, or none. True if its children have to be looked at.
bool keepNode(ViewNode node, out Run kept) {
    kept = Run(0u, 0u, 0u);
    Receiver r = receiver;
    if (!viewsReachReceiver(node, r.center, r.extent, r.axis, r.cosCone, r.sinCone, cutoff)) {
        return false;
    }
    if (!isLeaf(node) && node.level < r.level &&
        refineViewNode(node, r.center, r.extent, r.share)) {
        return true;
    }
    kept = Run(node.firstView, node.firstView + node.viewCount, 0u);
    if (receiverIndex > 0u) {
        kept.shift = importanceShift(node, r.center, r.extent, r.axis, r.cosCone, r.sinCone);
    }
    return false;
}

// Runs beyond the capacity are counted alone. Units follow in numberRuns().
void closeRun() {
    uint before = texelFetch(prefix, int(open.first)).x;
    uint power = texelFetch(prefix, int(open.end)).x - before;
    if (power == 0u) return;
    if (list.runs < capacity) {
        runs[receiverIndex * capacity + list.runs] =
            GatherRun(0u, open.first, packRunEnd(open.end, open.shift), before);
    }
    ++list.runs;
    listSum += float(power) * float(1u << open.shift);
}

// The units of the list, by the scale that the sum of all runs asks for.
void numberRuns() {
    for (uint i = 0u; i < list.runs; ++i) {
        GatherRun run = runs[receiverIndex * capacity + i];
        uint end = runEnd(run.endAndScale);
        uint scale = listScale(runScale(run.endAndScale), listSum);
        uint power = texelFetch(prefix, int(end)).x - run.powerBefore;
        runs[receiverIndex * capacity + i].unitsBefore = list.units;
        runs[receiverIndex * capacity + i].endAndScale = packRunEnd(end, scale);
        list.units += listUnits(power, scale);
    }
}

// Depth first; children that remain at each depth.
void walk() {
    list = GatherList(0u, 0u, 0u, receiver.level);
    listSum = 0.0;
    open = Run(0u, 0u, 0u);
    uint stack[kTreeLevels];
    int depth = 0;
    stack[0] = packChildren(0u, 1u);
    do {
        uint rest = stack[depth];
        Run kept = Run(0u, 0u, 0u);
        if (childCountOf(rest) == 0u) {
            --depth;
        } else {
            uint index = firstChildOf(rest);
            stack[depth] = packChildren(index + 1u, childCountOf(rest) - 1u);
            ViewNode node = fetchViewNode(index);
            if (keepNode(node, kept)) {
                ++depth;
                stack[depth] = node.children;
            }
        }
        // A gap, another importance, or the end closes the open run.
        bool keeps = kept.end > kept.first;
        list.views += kept.end - kept.first;
        if (depth < 0 || (keeps && (kept.first != open.end || kept.shift != open.shift))) {
            closeRun();
            open.first = kept.first;
            open.shift = kept.shift;
        }
        if (keeps) open.end = kept.end;
    } while (depth >= 0);
}

void main() {
    receiverIndex = globalIndex();
    if (receiverIndex >= receiverCount) return;
    receiver = fetchReceiver(receiverIndex);
    list = GatherList(0u, 0u, 0u, receiver.level);
    // Where the runs do not fit, the walk starts again with coarser nodes: they keep more views,
    // never fewer, and the root alone is one run.
    if (!receiver.empty) {
        do {
            walk();
            if (receiver.share < kMostRefineShare) {
                receiver.share *= 2.0;
            } else {
                --receiver.level;
            }
        } while (list.runs > capacity);
        numberRuns();
    }
    lists[receiverIndex] = list;
}
