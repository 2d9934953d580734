// Multi-pixel filling under the published rules: texels of the fused maps that are still empty
// take the finest coarser level that is not, the push of [Kol19 §3.2, fig. 9].
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/paraboloid.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(std430, binding = 5) restrict buffer LeafMapBuffer { uint leafMaps[]; };
layout(std430, binding = 7) restrict readonly buffer MipBuffer { uint mips[]; };

uniform uint mapCount;

const uint kRes = uint(MV_VIEW_RES);

void main() {
    uint index = globalIndex();
    uint map = index / mapTexels(kRes);
    uint texel = index % mapTexels(kRes);
    if (map >= mapCount) return;
    uint bits = leafMaps[index];
    if (bits != kNone) return;
    for (uint level = 1u; bits == kNone && (kRes >> level) > 0u; ++level) {
        bits = mips[map * mipTexels(kRes) + mipTexelOf(texel, level, kRes)];
    }
    leafMaps[index] = bits;
}
