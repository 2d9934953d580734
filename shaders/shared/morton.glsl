// Morton order over the root cube's 1024^3 grid: 10 bits an axis, x lowest. The key of a cell on
// level l is the leaf key without its last 3 * (10 - l) bits.
#ifndef MV_MORTON_GLSL
#define MV_MORTON_GLSL
#include "shaders/shared/language.glsl"

#ifdef __cplusplus
#include <bit>
#endif

MV_BEGIN_NAMESPACE

MV_CONST uint kMortonLevels = 10u;        // deepest level; the root is 0
MV_CONST uint kMortonDead = 0xFFFFFFFFu;  // sorts behind every key

// Bit i of ten goes to bit 3 i.
MV_FN uint spreadBits(uint bits) {
    uint x = bits & 0x3FFu;
    x = (x | (x << 16u)) & 0x030000FFu;
    x = (x | (x << 8u)) & 0x0300F00Fu;
    x = (x | (x << 4u)) & 0x030C30C3u;
    x = (x | (x << 2u)) & 0x09249249u;
    return x;
}
MV_FN uint gatherBits(uint bits) {
    uint x = bits & 0x09249249u;
    x = (x | (x >> 2u)) & 0x030C30C3u;
    x = (x | (x >> 4u)) & 0x0300F00Fu;
    x = (x | (x >> 8u)) & 0x030000FFu;
    x = (x | (x >> 16u)) & 0x3FFu;
    return x;
}
MV_FN uint mortonEncode(uint x, uint y, uint z) {
    return spreadBits(x) | (spreadBits(y) << 1u) | (spreadBits(z) << 2u);
}
MV_FN uvec3 mortonDecode(uint key) {
    return uvec3(gatherBits(key), gatherBits(key >> 1u), gatherBits(key >> 2u));
}

// Cell of a root-cube coordinate; what lies outside (or is not a number) is clamped into the cube.
MV_FN uint mortonCell(float x) {
    if (!(x > 0.0f)) return 0u;
    if (x >= 1.0f) return 1023u;
    return uint(x * 1024.0f);  // exact: a power of two
}
MV_FN uint mortonKeyOf(vec3 p) {
    return mortonEncode(mortonCell(p.x), mortonCell(p.y), mortonCell(p.z));
}

// The first level of 1..leafLevel on which two 30-bit keys lie in different cells, or
// leafLevel + 1 if they share their cell on all of them.
MV_FN uint firstDifferentLevel(uint a, uint b, uint leafLevel) {
    uint different = (a ^ b) >> (3u * (kMortonLevels - leafLevel));
    if (different == 0u) return leafLevel + 1u;
#ifdef __cplusplus
    uint highest = uint(std::bit_width(different)) - 1u;
#else
    uint highest = uint(findMSB(different));
#endif
    return leafLevel - highest / 3u;
}

// Centre and half edge of the cell with a level-l key.
MV_FN vec3 cellCenter(uint key, uint level) {
    uvec3 cell = mortonDecode(key);
    float edge = 1.0f / float(1u << level);  // exact
    return vec3((float(cell.x) + 0.5f) * edge, (float(cell.y) + 0.5f) * edge,
                (float(cell.z) + 0.5f) * edge);
}
MV_FN float cellHalf(uint level) { return 0.5f / float(1u << level); }

MV_END_NAMESPACE
#endif
