// Where nodes start. One invocation takes one level of one run of `chunkSize` sorted views.
// MV_COUNT: counts the nodes that start there, and once a chunk the leaves of all levels.
// Otherwise, with these counts summed up, nodes over (level, chunk) and leaves over chunks, every
// node and leaf has its final index: writes, for each node, its first view, the next free child
// index, its parent, and its map (kNone: no leaf), which are numbered in the order of their views.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/types.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint chunkSize;
uniform uint chunks;
uniform uint levelCount;
layout(binding = kUnitViewLevels) uniform usamplerBuffer levels;  // view_hierarchy_levels.comp
layout(binding = kUnitSortAlive) uniform usamplerBuffer aliveTexels;
#ifdef MV_COUNT
layout(std430, binding = kBlockNodeCounts) writeonly buffer Counts { uint counts[]; };
#else
layout(binding = kUnitNodeBegins) uniform usamplerBuffer begins;  // prefix sums of the counts
layout(std430, binding = kBlockNodeStarts) writeonly buffer Starts { uvec4 starts[]; };
#endif

void main() {
    uint id = globalIndex();
    uint blocks = levelCount * chunks;
    if (id >= blocks) return;
    uint level = id / chunks;
    uint chunk = id - level * chunks;
    uint i = chunk * chunkSize;
    uint end = min(texelFetch(aliveTexels, 0).x, i + chunkSize);
#ifdef MV_COUNT
    uint nodes = 0u;
    uint leaves = 0u;
    for (; i < end; ++i) {
        uint range = texelFetch(levels, int(i)).x;
        uint first = range & 15u;
        uint last = range >> 4u;
        nodes += first <= level && level <= last ? 1u : 0u;
        leaves += first < levelCount ? 1u : 0u;
    }
    counts[id] = nodes;
    if (level == 0u) counts[blocks + chunk] = leaves;
#else
    uint node = texelFetch(begins, int(id)).x;
    uint leaf = texelFetch(begins, int(blocks + chunk)).x - texelFetch(begins, int(blocks)).x;
    uint child = texelFetch(begins, int(id + chunks)).x;  // of the last level: never used
    uint parent = level > 0u ? texelFetch(begins, int(id - chunks)).x : 0u;
    while (i < end) {
        // Only the search runs for most views: few start a node on any one level.
        bool starts_ = false;
        bool startsLeaf = false;
        uint last = 0u;
        do {
            leaf += startsLeaf ? 1u : 0u;  // of the view before
            uint range = texelFetch(levels, int(i)).x;
            uint first = range & 15u;
            last = range >> 4u;
            starts_ = first <= level && level <= last;
            startsLeaf = first < levelCount;
            if (level > 0u && first <= level - 1u && level - 1u <= last) ++parent;
            if (!starts_ && first <= level + 1u && level + 1u <= last) ++child;
            ++i;
        } while (!starts_ && i < end);
        if (starts_) {
            bool isLeaf = level == last;
            starts[node] = uvec4(i - 1u, child, parent - 1u, isLeaf ? leaf : kNone);
            ++node;
            if (!isLeaf) ++child;
        }
        leaf += startsLeaf ? 1u : 0u;
    }
#endif
}
