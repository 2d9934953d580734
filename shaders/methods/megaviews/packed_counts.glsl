// How many of three kinds each lane of a work group has found, ten bits a kind: one atomic addition
// gives every lane its places in three shared arrays. Each kind is a mask of the lane's up to eight
// children.
#include "shaders/shared/traversal_data.glsl"
#if MV_WORKGROUP_SIZE > MV_MOST_LANES
#error "eight children a lane of so large a work group are more than ten bits can count"
#endif

uint packCounts(uint a, uint b, uint c) {
    return uint(bitCount(a)) | uint(bitCount(b)) << 10u | uint(bitCount(c)) << 20u;
}
uvec3 unpackCounts(uint sums) { return uvec3(sums & 0x3FFu, sums >> 10u & 0x3FFu, sums >> 20u); }

// The lowest bit of a mask that is not empty; it is taken out.
uint takeBit(inout uint mask) {
    uint bit = uint(findLSB(mask));
    mask &= mask - 1u;
    return bit;
}
bool hasBit(uint mask, uint bit) { return (mask >> bit & 1u) != 0u; }
