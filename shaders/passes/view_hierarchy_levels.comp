// Writes on which levels a sorted view starts nodes: first | last << 4, the last of them a leaf;
// first is beyond the leaf level where the view shares its leaf with its predecessor.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/morton.glsl"
#include "shaders/shared/rules.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint capacity;
uniform uint leafLevel;
uniform uint rules;
layout(binding = kUnitSortPairs) uniform usamplerBuffer pairs;  // RG32UI: key, slot; sorted
layout(binding = kUnitSortAlive) uniform usamplerBuffer aliveTexels;
layout(std430, binding = kBlockViewLevels) writeonly buffer Levels { uint levels[]; };

uint firstLevel(uint i, uint alive) {
    if (i == 0u || i >= alive) return 0u;
    return firstDifferentLevel(texelFetch(pairs, int(i - 1u)).x, texelFetch(pairs, int(i)).x,
                               leafLevel);
}

void main() {
    uint i = globalIndex();
    if (i >= capacity) return;
    uint alive = texelFetch(aliveTexels, 0).x;
    uint first = firstLevel(i, alive);
    uint alone = hasRule(rules, kRuleLoneViews) ? max(first, firstLevel(i + 1u, alive)) : leafLevel;
    if (i < alive) levels[i] = first | (min(alone, leafLevel) << 4u);
}
