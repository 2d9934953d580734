// Writes the leaf of every view that does not start one: that of the first view in its cell.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/morton.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint count;
uniform uint leafLevel;
layout(binding = kUnitViewLevels) uniform usamplerBuffer levels;  // view_hierarchy_levels.comp
layout(binding = kUnitViewKeys) uniform usamplerBuffer keys;
layout(std430, binding = kBlockLeafOfView) buffer Leaves {
    uint leafOfView[];
};  // of starting views: set

void main() {
    uint i = globalIndex();
    if (i >= count || (texelFetch(levels, int(i)).x & 15u) <= leafLevel) return;
    uint shift = 3u * (kMortonLevels - leafLevel);
    uint key = texelFetch(keys, int(i)).x >> shift;
    uint low = 0u;
    uint high = i;
    MV_FIND_FIRST(low, high, middle, texelFetch(keys, int(middle)).x >> shift >= key);
    leafOfView[i] = leafOfView[low];
}
