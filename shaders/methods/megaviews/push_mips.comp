// Multi-pixel filling without surface elements: texels of the fused maps that are still empty
// take the finest coarser level that is not, the push of [Kol19 §3.2, fig. 9].
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/parametrisation.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint mapCount;

#define MV_MIP_MAPS
#include "shaders/passes/map_texels.glsl"

void main() {
    uint index = globalIndex();
    uint map = index / mapTexels(MV_MAP_RES);
    uint texel = index % mapTexels(MV_MAP_RES);
    if (map >= mapCount) return;
    uint bits = loadMapTexel(map, texel);
    if (bits != kNone) return;
    for (uint level = 1u; bits == kNone && (MV_MAP_RES >> level) > 0u; ++level) {
        bits = loadMipTexel(map, mipTexelOf(texel, level, MV_MAP_RES));
    }
    storeMapTexel(map, texel, bits);
}
