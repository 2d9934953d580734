// The texels of maps, read and written where shaders/shared/map_store.glsl says. Before including:
//   MV_MAP_RES        resolution of all of them;
//   MV_MAPS_READ 1    final maps as texels, 2 as a storage block; otherwise read and written;
//   MV_WORK_MAPS      also the working maps of internal view nodes, while fusion goes on;
//   MV_PARENT_MAPS    also those of the level above, as texels;
//   MV_MIP_MAPS       also coarser levels of the final maps.
// Lanes take minima of texels that other lanes have stored: hence coherent.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/map_store.glsl"

#ifndef MV_MAPS_READ
#define MV_MAPS_READ 0
#endif

#if MV_MAPS_READ == 1
layout(binding = kUnitMaps) uniform usamplerBuffer mapWords_;
uint loadMapTexel(uint map, uint texel) {
    return texelFetch(mapWords_, int(mapWordOf(MapStore(MV_MAP_RES), map, texel))).x;
}
#else
#if MV_MAPS_READ == 2
layout(std430, binding = kBlockMaps) restrict readonly buffer MapBlock { uint mapWords_[]; };
#else
layout(std430, binding = kBlockMaps) coherent restrict buffer MapBlock { uint mapWords_[]; };
void storeMapTexel(uint map, uint texel, uint bits) {
    mapWords_[mapWordOf(MapStore(MV_MAP_RES), map, texel)] = bits;
}
void lowerMapTexel(uint map, uint texel, uint bits) {
    atomicMin(mapWords_[mapWordOf(MapStore(MV_MAP_RES), map, texel)], bits);
}
#endif
uint loadMapTexel(uint map, uint texel) {
    return mapWords_[mapWordOf(MapStore(MV_MAP_RES), map, texel)];
}
#endif

#ifdef MV_WORK_MAPS
layout(std430, binding = kBlockWorkMaps) coherent restrict buffer WorkBlock { uint workWords_[]; };

// The map of a view node: a final one, or a working one.
struct NodeMap {
    uint map;
    bool working;
};
uint loadMapTexel(NodeMap m, uint texel) {
    uint word = mapWordOf(MapStore(MV_MAP_RES), m.map, texel);
    return m.working ? workWords_[word] : mapWords_[word];
}
void storeMapTexel(NodeMap m, uint texel, uint bits) {
    uint word = mapWordOf(MapStore(MV_MAP_RES), m.map, texel);
    if (m.working) {
        workWords_[word] = bits;
    } else {
        mapWords_[word] = bits;
    }
}
void lowerMapTexel(NodeMap m, uint texel, uint bits) {
    uint word = mapWordOf(MapStore(MV_MAP_RES), m.map, texel);
    if (m.working) {
        atomicMin(workWords_[word], bits);
    } else {
        atomicMin(mapWords_[word], bits);
    }
}
#endif

#ifdef MV_PARENT_MAPS
layout(binding = kUnitParentMaps) uniform usamplerBuffer parentWords_;
uint loadParentTexel(uint map, uint texel) {
    return texelFetch(parentWords_, int(mapWordOf(MapStore(MV_MAP_RES), map, texel))).x;
}
#endif

#ifdef MV_MIP_MAPS
layout(std430, binding = kBlockMips) restrict buffer MipBlock { uint mipWords_[]; };
uint loadMipTexel(uint map, uint mipTexel) {
    return mipWords_[mipWordOf(MapStore(MV_MAP_RES), map, mipTexel)];
}
void storeMipTexel(uint map, uint mipTexel, uint bits) {
    mipWords_[mipWordOf(MapStore(MV_MAP_RES), map, mipTexel)] = bits;
}
void lowerMipTexel(uint map, uint mipTexel, uint bits) {
    atomicMin(mipWords_[mipWordOf(MapStore(MV_MAP_RES), map, mipTexel)], bits);
}
#endif
