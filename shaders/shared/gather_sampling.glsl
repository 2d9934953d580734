// Choosing views for a pixel by their power, in integers: each view owns a range of whole power
// units, a sample is one unit, so probabilities are exact and sum to one whatever the rounding.
// Random numbers are hashes of (seed, pixel, sample, accumulation index) [Kol19 §5.1].
#ifndef MV_GATHER_SAMPLING_GLSL
#define MV_GATHER_SAMPLING_GLSL
#include "shaders/shared/light.glsl"
#include "shaders/shared/random.glsl"

MV_BEGIN_NAMESPACE

// The high word of a * b.
MV_FN uint mulHigh(uint a, uint b) {
#ifdef __cplusplus
    return static_cast<uint>((static_cast<std::uint64_t>(a) * b) >> 32);
#else
    uint high, low;
    umulExtended(a, b, high, low);
    return high;
#endif
}

// What power means here: luminance, bounded so that sums stay finite; 0 for NaN and dark views.
MV_FN float gatherPower(vec3 flux) {
    float power = luminance(flux);
    return power > 0.0f ? min(power, 1e30f) : 0.0f;
}

// All views together have about 2^24 units, and every view that shines has at least one. Below
// 2^23 views, a list whose views count up to 2^kMaxImportanceShift times their units fits 32 bits,
// with room for the rounding of totalPower.
MV_CONST float kPowerUnits = 16777216.0f;
MV_CONST uint kPowerUnitBits = 25u;  // that all views' units together fit
MV_CONST uint kPowerBlock = 64u;     // views whose power one invocation sums
MV_FN uint powerUnits(float power, float totalPower) {
    if (!(power > 0.0f)) return 0u;
    return 1u + uint(min(power / totalPower, 1.0f) * kPowerUnits);
}

// Units [0, total) fall into `count` strata, as equal as integers allow; this is where one begins.
// count <= 65535.
MV_FN uint stratumBegin(uint total, uint count, uint stratum) {
    return (total / count) * stratum + ((total % count) * stratum) / count;
}

// The rank of a pixel in its 4 x 4 block, ordered so that every 2 x 2 quarter is spread evenly.
MV_FN uint blockRank(uint x, uint y) {
    uint d = x ^ y;
    return ((d & 1u) << 3u) | ((y & 1u) << 2u) | (d & 2u) | ((y >> 1u) & 1u);
}

// Where in its stratum a sample lies, in 1 / 2^32. The 16 pixels of a block divide each stratum
// among themselves (interleaved sampling), the block shifts them all, and a jitter within each
// pixel's share makes every value equally likely for every pixel, so that the estimate's mean is
// the full sum. The filter then joins 16 times as many strata.
MV_FN uint blockShift(uint seed, uint x, uint y, uint accumulationIndex) {
    return pcg4d(uvec4(seed, (y >> 2u) << 16u | (x >> 2u), kNone, accumulationIndex)).x +
           (blockRank(x, y) << 28u);
}
MV_FN uint sampleOffset(uint shift, uint seed, uint x, uint y, uint sampleIndex,
                        uint accumulationIndex) {
    uint jitter = pcg4d(uvec4(seed, y << 16u | x, sampleIndex, accumulationIndex)).x;
    return shift + (jitter >> 4u);
}

// A list's units are cut into at most kGuideSlots ranges of 2^guideShift units: a table of where
// each range lies in the list spares most of the search.
MV_CONST uint kGuideSlots = 64u;
MV_FN uint guideShift(uint units) {
    uint shift = 0u;
    for (uint step = 16u; step > 0u; step >>= 1u) {
        if ((units >> (shift + step)) >= kGuideSlots / 2u) shift += step;
    }
    return (units >> shift) >= kGuideSlots ? shift + 1u : shift;
}

MV_END_NAMESPACE
#endif
