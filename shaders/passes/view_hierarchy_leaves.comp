// The leaf of every view that does not start one: that of the first view in its cell.
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
    uint lo = 0u;
    uint hi = i;
    while (lo < hi) {
        uint middle = (lo + hi) / 2u;
        if (texelFetch(keys, int(middle)).x >> shift < key)
            lo = middle + 1u;
        else
            hi = middle;
    }
    leafOfView[i] = leafOfView[lo];
}
