// Where a search of the views' power units may begin: one invocation for each of the equal ranges
// of units finds the view that owns its first one. Entry j + 1 bounds the search from above.
#include "shaders/passes/last_at_most.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitPowerPrefix) uniform usamplerBuffer prefix;  // power units before each view
layout(std430, binding = kBlockViewSearch) writeonly buffer ViewSearch { uint table[]; };

uniform uint viewCount;
uniform uint slotCount;  // the last slot begins behind all units
uniform uint slotShift;

void main() {
    uint slot = globalIndex();
    if (slot >= slotCount) return;
    table[slot] = lastAtMost(prefix, 0u, viewCount, 1u, slot << slotShift);
}
