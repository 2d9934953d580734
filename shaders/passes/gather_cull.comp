// Receivers x view tree -> runs of kept views [Kol19 §5.1]. One invocation walks the view tree for
// one receiver, depth first, so that kept views come in sorted order and neighbours join.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_data.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitPowerPrefix) uniform usamplerBuffer prefix;  // power units before each view
layout(binding = kUnitReceiverKeys) uniform usamplerBuffer receiverKeys;  // kNone: everything

layout(std430, binding = kBlockRuns) writeonly buffer Runs { GatherRun runs[]; };
layout(std430, binding = kBlockReceiverLists) writeonly buffer Lists { GatherList lists[]; };

uniform uint receiverCount;
uniform uint capacity;  // runs a receiver
uniform uint cullLevel;
uniform float cutoff;

void main() {
    uint receiver = globalIndex();
    if (receiver >= receiverCount) return;

    // The receiver's box and cone.
    uint key = texelFetch(receiverKeys, int(receiver)).x;
    vec3 center = vec3(0.5);
    vec3 extent = vec3(1.0);
    vec3 axis = vec3(0.0, 0.0, 1.0);
    float cosCone = -1.0;
    float sinCone = 0.0;
    uint level = 0u;
    if (key != kNone) {
        uint node = key / kReceiverCones;
        uint cone = key % kReceiverCones;
        SceneNode box = fetchSceneNode(node);
        center = boxCenter(box);
        extent = boxHalf(box) + vec3(kReceiverMargin);
        level = cullLevel;
        if (cone < kReceiverCells) {
            axis = receiverCellAxis(cone);
            cosCone = receiverCellCos(cone);
            sinCone = sqrt(max(0.0, 1.0 - cosCone * cosCone));
        } else {
            fetchSceneCone(node, axis, cosCone, sinCone);
            axis *= cone == kReceiverBack ? -1.0 : 1.0;
        }
        float narrow = cosCone;
        cosCone = widenedCos(narrow, sinCone);
        sinCone = widenedSin(narrow, sinCone);
    }

    // Depth first; children that remain at each depth. Where the runs do not fit, again on a
    // coarser level: it keeps more views, never fewer, and the root alone is one run.
    uint stack[kTreeLevels];
    uint count, units, views;
    bool fits;
    do {
        count = 0u;
        units = 0u;
        views = 0u;
        uint openFirst = 0u;
        uint openEnd = 0u;
        uint openShift = 0u;
        int depth = 0;
        stack[0] = packChildren(0u, 1u);
        do {
            uint rest = stack[depth];
            uint first = 0u;
            uint end = 0u;
            uint shift = 0u;
            if (childCountOf(rest) == 0u) {
                --depth;
            } else {
                uint index = firstChildOf(rest);
                stack[depth] = packChildren(index + 1u, childCountOf(rest) - 1u);
                ViewNode node = fetchViewNode(index);
                if (viewsReachReceiver(node, center, extent, axis, cosCone, sinCone, cutoff)) {
                    if (isLeaf(node) || node.level >= level ||
                        !refineViewNode(node, center, extent)) {
                        first = node.firstView;
                        end = first + node.viewCount;
                        views += node.viewCount;
                        if (key != kNone) {
                            shift = importanceShift(node, center, extent, axis, cosCone, sinCone);
                        }
                    } else {
                        ++depth;
                        stack[depth] = node.children;
                    }
                }
            }
            // A gap, another importance, or the end closes the open run.
            bool done = depth < 0;
            if (done || (end > first && (first != openEnd || shift != openShift))) {
                uint before = texelFetch(prefix, int(openFirst)).x;
                uint power = texelFetch(prefix, int(openEnd)).x - before;
                if (power > 0u) {
                    if (count < capacity) {
                        runs[receiver * capacity + count] =
                            GatherRun(units, openFirst, packRunEnd(openEnd, openShift), before);
                    }
                    ++count;
                    units += power << openShift;
                }
                openFirst = first;
                openShift = shift;
            }
            if (end > first) openEnd = end;
        } while (depth >= 0);
        fits = count <= capacity;
        if (!fits) --level;
    } while (!fits);
    lists[receiver] = GatherList(count, units, views, level);
}
