// Choosing views for a pixel by their power, in integers: each view owns a range of whole power
// units, a sample is one unit, so probabilities are exact and sum to one whatever the rounding.
// Random numbers are hashes of (seed, pixel, sample, accumulation index) [Kol19 §5.1].
#ifndef MV_GATHER_SAMPLING_GLSL
#define MV_GATHER_SAMPLING_GLSL
#include "shaders/shared/light.glsl"
#include "shaders/shared/random.glsl"

MV_BEGIN_NAMESPACE

// Samples of a pixel that gathers for itself, at least: no filter follows.
MV_CONST uint kAloneSamples = 16u;

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

// All views together have about 2^30 units, and every view that shines has at least one. Half of
// the units go by power. The others are equal: views are chosen so that each gives about as much to
// what the camera sees, and what is dim lights what is near as much as any [Veach 1997, defensive
// sampling after Hesterberg 1995].
MV_CONST float kPowerUnits = 1073741824.0f;
MV_CONST uint kPowerUnitBits = 31u;  // that all units of fewer than 2^30 views fit
MV_CONST uint kPowerBlock = 64u;     // views whose power one invocation sums
MV_CONST float kEqualShare = 0.5f;
MV_FN uint powerUnits(float power, float totalPower, uint views) {
    if (!(power > 0.0f)) return 0u;
    float share = mix(min(power / totalPower, 1.0f), 1.0f / float(views), kEqualShare);
    return 1u + uint(share * kPowerUnits);
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

// ---------------------------------------------------------------- the views of a sample

// The rank of a pixel in its tile of 8 x 8, ordered likewise: its 4 x 4 block's rank leads.
MV_FN uint tileRank(uint x, uint y) {
    uint quarter = ((x >> 2u & 1u) ^ (y >> 2u & 1u)) << 1u | (y >> 2u & 1u);
    return blockRank(x, y) << 2u | quarter;
}

// A tile's pixels share the views that they draw: 128 from each stratum, two for each of them. A
// pixel weighs some of them by what they would give it unshadowed, and asks for the visibility of
// one, drawn by these weights: resampled importance sampling [Talbot, Cline and Egbert 2005].
// Unbiased for any number of candidates. With fewer, what all of a tile err together is larger.
MV_CONST uint kDrawRankBits = 7u;
MV_CONST uint kDrawRanks = 1u << kDrawRankBits;
MV_CONST uint kDrawLanes = 8u;  // invocations that draw a stratum's
// With one candidate a pixel only every second rank is drawn, which are the pixels' own.
MV_FN uint drawShift(uint candidates) { return candidates > 1u ? 0u : 1u; }
MV_FN uint drawsOfStratum(uint candidates) { return kDrawRanks >> drawShift(candidates); }

// A pixel that weighs a quarter of all ranks takes one of each four. Which one is the last two bits
// of its own rank, and for each sixteenth another sum of products of the rest in GF(4), so that any
// two pixels have a quarter in common at most. What pixels err together shows as a block and
// stands; what each errs for itself is noise, which the filter takes out.
MV_FN uint productsInGf4(uint a) {  // with 0 .. 3, two bits each
    uint ax = ((a << 1u) ^ ((a & 2u) != 0u ? 7u : 0u)) & 3u;
    return a << 2u | ax << 4u | (a ^ ax) << 6u;
}
MV_FN uint rankSwaps(uint pixelRank) {
    return productsInGf4(pixelRank >> 2u & 3u) | productsInGf4(pixelRank >> 4u & 3u) << 8u;
}
// swaps: rankSwaps() of the pixel. Candidate 0 of each pixel of a tile has a rank of its own.
MV_FN uint candidateRank(uint pixelRank, uint swaps, uint candidate, uint candidates) {
    // The whole part of candidate * kDrawRanks / candidates: half a unit is more than a float's
    // division is off, and integers are divided lane by lane on a software renderer.
    uint place = uint((float(candidate * kDrawRanks) + 0.5f) / float(candidates));
    uint rank = (place + pixelRank * (kDrawRanks >> 6u)) % kDrawRanks;
    // The pixel's own sixteenth comes first: those of a block of pixels stay as far apart as they
    // are.
    uint at = rank >> (kDrawRankBits - 4u) ^ pixelRank >> 2u;
    uint swap = pixelRank ^ swaps >> (2u * (at & 3u)) ^ swaps >> (8u + 2u * (at >> 2u & 3u));
    return candidates > 1u ? rank ^ (swap & 3u) : rank;
}

// A pixel that draws views for itself weighs so many for each sample.
MV_CONST uint kOwnCandidates = 8u;

// Further looks take so many times a pixel's samples together. What the filter shows is corrected
// where it is so many times more than all of them found; smaller differences are noise, of which
// the filter has less. Where all are blocked a pixel may still have what so many of them would have
// given: that one has more than four times as much, and so is darkened by mistake, has odds of
// e^-(4 * 2.3), 1e-4.
MV_CONST uint kAllLooksSamples = 8u;
MV_CONST float kLooksMisses = 2.3f;
MV_CONST float kLooksFactor = 4.0f;
// A corrected pixel keeps kLooksLeft times the bound; with less, pixels in dim places that were
// merely unlucky would show as dark dots.
MV_CONST float kLooksLeft = 2.0f;
MV_CONST uint kLooksSeed = 0x510E527Fu;

// Where in its stratum a tile's draw of a rank lies, in 1 / 2^32. Ranks divide the stratum among
// themselves (interleaved sampling), the 16 tiles of a block divide each rank's share, the block
// shifts them all, and a jitter makes every value equally likely for every pixel, so that the
// estimate's mean is the full sum. The filter then joins 16 times as many strata, or more.
MV_CONST uint kDrawSeed = 0x3C6EF372u;
MV_FN uint drawOffsetOfTile(uint seed, uint tileX, uint tileY, uint accumulationIndex) {
    uint block = pcg4d(uvec4(seed ^ kDrawSeed, (tileY >> 2u) << 16u | (tileX >> 2u), kNone,
                             accumulationIndex))
                     .x;
    return block + (blockRank(tileX, tileY) << (28u - kDrawRankBits));
}
MV_FN uint drawOffsetOfRank(uint seed, uint tileX, uint tileY, uint sampleIndex, uint rank,
                            uint accumulationIndex) {
    uint jitter = pcg4d(uvec4(seed ^ kDrawSeed, tileY << 16u | tileX,
                              sampleIndex * kDrawRanks + rank, accumulationIndex))
                      .x;
    return (rank << (32u - kDrawRankBits)) + (jitter >> (4u + kDrawRankBits));
}
MV_FN uint drawOffset(uint seed, uint tileX, uint tileY, uint sampleIndex, uint rank,
                      uint accumulationIndex) {
    return drawOffsetOfTile(seed, tileX, tileY, accumulationIndex) +
           drawOffsetOfRank(seed, tileX, tileY, sampleIndex, rank, accumulationIndex);
}

// Four numbers in 1 / 2^32 of a pixel's sample, each spread over the pixel's 4 x 4 block.
MV_FN uvec4 sampleOffsets(uint seed, uint x, uint y, uint sampleIndex, uint accumulationIndex) {
    uvec4 block = pcg4d(uvec4(seed, (y >> 2u) << 16u | (x >> 2u), ~sampleIndex, accumulationIndex));
    uvec4 jitter = pcg4d(uvec4(seed, y << 16u | x, sampleIndex, accumulationIndex));
    return block + (blockRank(x, y) << 28u) + (jitter >> 4u);
}
MV_FN uint sampleOffset(uint seed, uint x, uint y, uint sampleIndex, uint accumulationIndex) {
    return sampleOffsets(seed, x, y, sampleIndex, accumulationIndex).x;
}

MV_CONST uint kChoiceSeed = 0x9E3779B9u;    // of what groups of candidates choose
MV_CONST uint kResampleSeed = 0xBB67AE85u;  // of how many samples each group takes

// One of several candidates by their weights, each looked at once [Chao 1982].
struct Choice {
    uint chosen;   // kNone: none has a weight
    float total;   // of the weights so far
    float weight;  // of the chosen
    float number;  // in [0, 1), uniform whatever was chosen
};
MV_FN Choice noChoice(float number) {
    Choice c;
    c.chosen = kNone;
    c.total = 0.0f;
    c.weight = 0.0f;
    c.number = number;
    return c;
}
MV_FN Choice withCandidate(Choice c, uint candidate, float weight) {
    if (!(weight > 0.0f)) return c;
    c.total += weight;
    float share = weight / c.total;
    if (c.number < share) {
        c.chosen = candidate;
        c.weight = weight;
        c.number /= share;
    } else {
        c.number = (c.number - share) / (1.0f - share);
    }
    return c;
}

// Strata of equal power give unequal light, so samples go where light would come from. The
// candidates of a stratum fall into groups, each group chooses one of its own by their weights, and
// the groups of a batch of strata share out its samples: systematic resampling [Kitagawa 1996].
// Where each stratum has one candidate, it is taken as it is drawn: a batch is a single stratum.
MV_CONST uint kBatchSamples = 8u;
MV_CONST uint kCandidateGroups = 4u;
MV_FN uint resampledTogether(uint candidates) { return candidates > 1u ? kBatchSamples : 1u; }
MV_FN uint candidateGroups(uint candidates) { return min(candidates, kCandidateGroups); }
// Where a stratum's group ends among its candidates.
MV_FN uint groupEnd(uint group, uint candidates) {
    return (group + 1u) * candidates / candidateGroups(candidates);
}
// The number that it chooses by, of a stratum's sampleOffsets().
MV_FN float groupNumber(uvec4 numbers, uint group) {
    return unitFloat(group == 0u   ? numbers.x
                     : group == 1u ? numbers.y
                     : group == 2u ? numbers.z
                                   : numbers.w);
}
// What a group takes samples in proportion to where nobody knows what is hidden: the root of what
// it would give, for what would give much is more often hidden.
MV_FN float groupWeight(Choice choice) { return sqrt(choice.total); }
// The light that each sample of a group stands for, of as many as there are strata. perWeight: what
// the group would give over its weight, which is the weight again of groupWeight().
MV_FN float sampleLight(float perWeight, float total, uint strata, uint candidates) {
    return perWeight * total / float(strata * candidates);
}
// How many of `samples` are taken by groups whose weights sum to `sum`, of `total`; none where
// nothing would give light. number: in [0, 1), the same for all groups of a batch.
MV_FN uint samplesUpTo(float sum, float total, uint samples, float number) {
    if (!(total > 0.0f && total < kInfinity)) return 0u;
    return uint(clamp(ceil(sum / total * float(samples) - number), 0.0f, float(samples)));
}

// A list's units are cut into at most kRunSearchSlots ranges of 2^runSearchShift units: a table of
// where each range lies in the list spares most of the search.
MV_CONST uint kRunSearchSlots = 64u;
MV_FN uint runSearchShift(uint units) {
    uint shift = 0u;
    for (uint step = 16u; step > 0u; step >>= 1u) {
        if ((units >> (shift + step)) >= kRunSearchSlots / 2u) shift += step;
    }
    return (units >> shift) >= kRunSearchSlots ? shift + 1u : shift;
}

MV_END_NAMESPACE
#endif
