// Receivers x view tree -> runs of kept views [Kol19 §5.1]. One invocation walks the view tree for
// one receiver, depth first, so that kept views come in sorted order and neighbours join.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_data.glsl"
#include "shaders/shared/gather_sampling.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitPowerPrefix) uniform usamplerBuffer prefix;  // power units before each view
layout(binding = kUnitTiles) uniform usamplerBuffer tiles;         // GatherTile

layout(std430, binding = kBlockRuns) writeonly buffer Runs { GatherRun runs[]; };
layout(std430, binding = kBlockReceiverLists) writeonly buffer Lists { GatherList lists[]; };

uniform uint receiverCount;  // 0 holds everything, others are tiles
uniform uint viewCount;
uniform uint capacity;  // runs a receiver
uniform uint cullLevel;
uniform float cutoff;

void main() {
    uint receiver = globalIndex();
    if (receiver >= receiverCount) return;

    // The receiver's box and cone.
    vec3 center = vec3(0.5);
    vec3 extent = vec3(1.0);
    vec3 axis = vec3(0.0, 0.0, 1.0);
    float cosCone = -1.0;
    float sinCone = 0.0;
    uint level = 0u;
    uint limit = 0u;
    bool empty = false;
    if (receiver > 0u) {
        int first = int(receiver - 1u) * 3;
        vec4 a = uintBitsToFloat(texelFetch(tiles, first));
        vec4 b = uintBitsToFloat(texelFetch(tiles, first + 1));
        uvec4 c = texelFetch(tiles, first + 2);
        center = a.xyz;
        extent = b.xyz;
        axis = uintBitsToFloat(c.xyz);
        cosCone = a.w;
        sinCone = b.w;
        empty = c.w == 0u;
        level = cullLevel;
        limit = importanceLimit(texelFetch(prefix, int(viewCount)).x);
    }
    if (empty) {
        lists[receiver] = GatherList(0u, 0u, 0u, level);
        return;
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
                        if (receiver > 0u) {
                            shift = importanceShift(node, center, extent, axis, cosCone, sinCone,
                                                    limit);
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
