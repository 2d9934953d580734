// The texels of maps, read and written where shaders/shared/map_store.glsl says. Before including:
//   MV_MAP_RES        resolution of all of them;
//   MV_MAPS_READ 1    final maps as texels of a word, 2 of four words; otherwise read and written,
//                     those of them that are bound: from `firstMap` on;
//   MV_MAPS_PACKED 1  those that are read have 16 bits a texel;
//   MV_WORK_MAPS      also the working maps of internal view nodes, while fusion goes on;
//   MV_PARENT_MAPS    also those of the level above, as texels;
//   MV_MIP_MAPS       also coarser levels of the final maps.
// Lanes take minima of texels that other lanes have stored: hence coherent.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/map_store.glsl"

#ifndef MV_MAPS_READ
#define MV_MAPS_READ 0
#endif
#ifndef MV_MAPS_PACKED
#define MV_MAPS_PACKED 0
#endif

#if MV_MAPS_READ > 0
layout(binding = kUnitMaps) uniform usamplerBuffer mapWords_;
uint readMapWord_(uint word) {
#if MV_MAPS_READ == 2
    return texelFetch(mapWords_, int(word >> 2u))[word & 3u];
#else
    return texelFetch(mapWords_, int(word)).x;
#endif
}
uint loadMapTexel(uint map, uint texel) {
#if MV_MAPS_PACKED
    return unpackTexel(readMapWord_(packedWordOf(MapStore(MV_MAP_RES), map, texel)), texel);
#else
    return readMapWord_(mapWordOf(MapStore(MV_MAP_RES), map, texel));
#endif
}
#else
layout(std430, binding = kBlockMaps) coherent restrict buffer MapBlock { uint mapWords_[]; };
uniform uint firstMap;
uint boundWordOf(uint map, uint texel) {
    return mapWordOf(MapStore(MV_MAP_RES), map - firstMap, texel);
}
uint loadMapTexel(uint map, uint texel) { return mapWords_[boundWordOf(map, texel)]; }
void storeMapTexel(uint map, uint texel, uint bits) { mapWords_[boundWordOf(map, texel)] = bits; }
void lowerMapTexel(uint map, uint texel, uint bits) {
    atomicMin(mapWords_[boundWordOf(map, texel)], bits);
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
    if (!m.working) return loadMapTexel(m.map, texel);
    return workWords_[mapWordOf(MapStore(MV_MAP_RES), m.map, texel)];
}
void storeMapTexel(NodeMap m, uint texel, uint bits) {
    if (m.working) {
        workWords_[mapWordOf(MapStore(MV_MAP_RES), m.map, texel)] = bits;
    } else {
        storeMapTexel(m.map, texel, bits);
    }
}
void lowerMapTexel(NodeMap m, uint texel, uint bits) {
    if (m.working) {
        atomicMin(workWords_[mapWordOf(MapStore(MV_MAP_RES), m.map, texel)], bits);
    } else {
        lowerMapTexel(m.map, texel, bits);
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
