// Where the texels of maps lie in memory, and as what: nothing else knows. The maps of a store have
// one resolution and lie one behind the other, a 32-bit word a texel: a depth in root-cube units as
// ordered float bits, kNone where it is empty. Coarser levels lie likewise, in a store of their
// own. Maps that are finished may be packed to 16 bits a texel, two in a word, the first in its low
// half.
//
// GLSL reads and writes through shaders/passes/map_texels.glsl, C++ through the functions below.
#ifndef MV_MAP_STORE_GLSL
#define MV_MAP_STORE_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/parametrisation.glsl"

#ifdef __cplusplus
#include <cstddef>
#include <span>
#define MV_WORD_INDEX std::size_t
#else
#define MV_WORD_INDEX uint
#endif

MV_BEGIN_NAMESPACE

struct MapStore {
    uint mapRes;
};

// Words that `maps` maps take, or their coarser levels.
MV_FN MV_WORD_INDEX mapWords(MapStore store, MV_WORD_INDEX maps) {
    return maps * mapTexels(store.mapRes);
}
MV_FN MV_WORD_INDEX mipWords(MapStore store, MV_WORD_INDEX maps) {
    return maps * mipTexels(store.mapRes);
}
// The word of a map's texel, or of one of its coarser levels (a number from mipOffset on).
MV_FN MV_WORD_INDEX mapWordOf(MapStore store, MV_WORD_INDEX map, uint texel) {
    return mapWords(store, map) + texel;
}
MV_FN MV_WORD_INDEX mipWordOf(MapStore store, MV_WORD_INDEX map, uint mipTexel) {
    return mipWords(store, map) + mipTexel;
}

// Packed maps: words that they take, and the word of a texel.
MV_FN MV_WORD_INDEX packedWords(MapStore store, MV_WORD_INDEX maps) {
    return mapWords(store, maps) / 2u;
}
MV_FN MV_WORD_INDEX packedWordOf(MapStore store, MV_WORD_INDEX map, uint texel) {
    return mapWordOf(store, map, texel) / 2u;
}
// Packs of a depth's float bits the 5 that tell exponents from 2^-30 to 2 apart and 11 of the
// mantissa, rounded: off by 2^-12 of the depth at most. The root cube's diagonal is below 4 edges,
// and what is nearer than 2^-30 of one is as far as that.
MV_CONST uint kPackedLeast = 97u << 23u;
MV_CONST uint kPackedNone = 0xFFFFu;
MV_FN uint packTexel(uint bits) {
    uint steps = (max(bits, kPackedLeast) - kPackedLeast + 0x800u) >> 12u;
    return bits == kNone ? kPackedNone : min(steps, kPackedNone - 1u);
}
// Depth bits of `texel`, from the packed word that holds it.
MV_FN uint unpackTexel(uint word, uint texel) {
    uint steps = (texel & 1u) == 0u ? word & 0xFFFFu : word >> 16u;
    return steps == kPackedNone ? kNone : kPackedLeast + (steps << 12u);
}

#ifdef __cplusplus
// What a texel's bits stand for: a depth, infinity where it is empty.
inline float mapDepth(uint bits) { return uintBitsToFloat(bits == kNone ? 0x7F800000u : bits); }
inline uint loadMapTexel(MapStore store, std::span<const uint> words, std::size_t map, uint texel) {
    return words[mapWordOf(store, map, texel)];
}
inline void storeMapTexel(MapStore store, std::span<uint> words, std::size_t map, uint texel,
                          uint bits) {
    words[mapWordOf(store, map, texel)] = bits;
}
// Writes a texel where the map holds nothing nearer.
inline void lowerMapTexel(MapStore store, std::span<uint> words, std::size_t map, uint texel,
                          uint bits) {
    uint& word = words[mapWordOf(store, map, texel)];
    word = min(word, bits);
}
#endif

MV_END_NAMESPACE
#endif
