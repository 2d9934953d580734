// One level of pull (MV_PUSH 0) or push (1) over the texels of all maps: level 0 is the map
// itself, coarser ones lie in `mips` as map_store.glsl says.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/ism.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint viewCount;
uniform uint mapRes;
uniform uint level;  // written

#define MV_MAP_RES mapRes
#define MV_MIP_MAPS
#include "shaders/passes/map_texels.glsl"

uint load(uint map, uint from, uint face, uint i, uint j) {
    uint texel = texelAt(face, i, j, mapRes >> from);
    if (from == 0u) return loadMapTexel(map, texel);
    return loadMipTexel(map, mipOffset(from, mapRes) + texel);
}

void main() {
    uint r = mapRes >> level;
    uint index = globalIndex();
    uint view = index / mapTexels(r);
    if (view >= viewCount) return;
    uint texel = index % mapTexels(r);
    uint face = faceOfTexel(texel, r);
    uint i = texel % r;
    uint j = texel / r % r;
#if MV_PUSH
    uvec2 a = ismNeighbours(i, r / 2u);
    uvec2 b = ismNeighbours(j, r / 2u);
    uvec4 coarser =
        uvec4(load(view, level + 1u, face, a.x, b.x), load(view, level + 1u, face, a.y, b.x),
              load(view, level + 1u, face, a.x, b.y), load(view, level + 1u, face, a.y, b.y));
    uint result = ismPush(load(view, level, face, i, j), coarser, level);
#else
    uint below = level - 1u;
    uvec4 finer =
        uvec4(load(view, below, face, 2u * i, 2u * j), load(view, below, face, 2u * i + 1u, 2u * j),
              load(view, below, face, 2u * i, 2u * j + 1u),
              load(view, below, face, 2u * i + 1u, 2u * j + 1u));
    uint result = ismPull(finer, level);
#endif
    if (level == 0u) {
        storeMapTexel(view, texel, result);
    } else {
        storeMipTexel(view, mipOffset(level, mapRes) + texel, result);
    }
}
