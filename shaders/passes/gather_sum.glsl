// The sum over a receiver's kept views, or an estimate of it from samples drawn by power. Included
// by every shader that gathers.
// MV_VISIBILITY: the file that answers whether a sample's light passes, see VisibilitySample.
// MV_SAMPLE_ROUNDS: its loops are bounded by sampleRounds.
// SAMPLES: each sample is handed to recordSample(), which the includer defines before.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_data.glsl"
#include "shaders/shared/gather_sampling.glsl"

layout(binding = kUnitGatherRecords) uniform usamplerBuffer records;  // GatherRecord
layout(binding = kUnitPowerPrefix) uniform usamplerBuffer prefix;   // power units before each view
layout(binding = kUnitReceiverLists) uniform usamplerBuffer lists;  // GatherList
layout(binding = kUnitRuns) uniform usamplerBuffer runs;            // GatherRun
layout(binding = kUnitRunWords) uniform usamplerBuffer runUnits;    // the same, word by word
layout(binding = kUnitRunGuide) uniform usamplerBuffer guide;       // see gather_guide.comp
layout(binding = kUnitViewGuide) uniform usamplerBuffer viewGuide;  // see gather_view_guide.comp
layout(binding = kUnitClampDistances) uniform samplerBuffer clampDistances;  // of each view
uniform uint samples;                                               // 0: the full sum
// Of the samples, or of the kept views of a full sum, these are summed: first <= k < last.
uniform uint firstSample;
uniform uint lastSample;
uniform uint capacity;  // runs a receiver
uniform uint viewSlotShift;
uniform uint seed;
uniform uint accumulationIndex;
uniform float cutoff;
uniform float inverseEdge2;  // 1 / m^2 of the root cube's face

// Does light pass between a view and a receiver? The method answers: MV_VISIBILITY defines
//     bool isVisible(VisibilitySample s)
struct VisibilitySample {
    vec3 position, normal;  // of the receiver
    vec3 toView;            // from there
    vec3 viewNormal;        // zero: omnidirectional
    uint map;               // of the view; kNone: none
    vec3 fromMap;           // position - the map's centre
    bool counts;            // false: nobody will use the answer
};
#ifdef MV_SAMPLE_ROUNDS
uniform uint sampleRounds;  // of its loops, that one sample may take
// Set where one took more: the picture is then no good.
layout(std430, binding = kBlockRoundsOverflow) writeonly buffer RoundsOverflow {
    uint roundsOverflow;
};
void noteRounds(uint rounds) {
    if (rounds > sampleRounds) roundsOverflow = 1u;
}
#else
const uint sampleRounds = kNone;
void noteRounds(uint rounds) {}
#endif
#include MV_VISIBILITY

// x: with the clamp, y: without it; both with visibility.
struct Gathered {
    vec3 clamped;
    vec3 unclamped;
};

// sampled: power units that the sample stands for; 0 in the full sum, where a view has all its own.
void addView(uint view, float sampled, vec3 position, vec3 normal, inout Gathered sum) {
    uvec4 a = texelFetch(records, int(view * 3u));
    uvec4 b = texelFetch(records, int(view * 3u + 1u));
    uvec4 c = texelFetch(records, int(view * 3u + 2u));
    bool omnidirectional = b.w == kNoSurface;
    vec3 viewNormal = omnidirectional ? vec3(0.0) : unpackNormal(b.w);
    vec3 toView = uintBitsToFloat(a.xyz) - position;
    float weight = (sampled > 0.0 ? sampled : float(c.w)) * (1.0 / kPowerUnits);
    float clampDistance = texelFetch(clampDistances, int(view)).x;
    float term = gatherTerm(toView, normal, viewNormal, omnidirectional, clampDistance, cutoff);
    bool visible = isVisible(VisibilitySample(position, normal, toView, viewNormal, a.w,
                                              position - uintBitsToFloat(c.xyz), term > 0.0));
    float lit = visible ? weight : 0.0;
    vec3 flux = uintBitsToFloat(b.xyz) * lit;
    sum.clamped += flux * term;
#ifdef SAMPLES
    recordSample(view, uintBitsToFloat(b.xyz) * weight * term, visible);
#endif
#ifdef MEASURE
    sum.unclamped += flux * gatherTerm(toView, normal, viewNormal, omnidirectional, 0.0, cutoff);
#endif
}

// The last of the ascending values texels[begin .. end) that is <= unit; the first always is.
uint lastAtMost(usamplerBuffer texels, uint begin, uint end, uint stride, uint unit) {
    uint lo = begin;
    uint hi = end;
    while (hi - lo > 1u) {
        uint middle = (lo + hi) >> 1u;
        if (texelFetch(texels, int(middle * stride)).x <= unit)
            lo = middle;
        else
            hi = middle;
    }
    return lo;
}

// Every view of every run.
void sumRuns(uint firstRun, uint runCount, vec3 position, vec3 normal, inout Gathered sum) {
    uint run = 0u;
    uint before = 0u;  // views of the runs before
    do {
        uvec4 r = texelFetch(runs, int(firstRun + run));
        uint views = runEnd(r.z) - r.y;
        uint k = max(firstSample, before) - before;
        uint end = min(lastSample - min(before, lastSample), views);
        if (k < end) {
            do addView(r.y + k, 0.0, position, normal, sum);
            while (++k < end);
        }
        before += views;
    } while (++run < runCount && before < lastSample);
}

// The view that owns a unit of the receiver's list; its units count 2^shift times.
uint viewOfUnit(uint receiver, uint firstRun, uint slotShift, uint unit, out uint shift) {
    uint range = texelFetch(guide, int(receiver * kGuideSlots + (unit >> slotShift))).x;
    uint run =
        lastAtMost(runUnits, firstRun + (range & 0xFFFFu), firstRun + (range >> 16u), 4u, unit);
    uvec4 r = texelFetch(runs, int(run));
    shift = runShift(r.z);
    uint power = r.w + ((unit - r.x) >> shift);
    int slot = int(power >> viewSlotShift);
    uint begins = max(r.y, texelFetch(viewGuide, slot).x);
    uint ends = min(runEnd(r.z), texelFetch(viewGuide, slot + 1).x + 1u);
    return lastAtMost(prefix, begins, ends, 1u, power);
}

// One view from each of `count` strata of equal power, of which these are the ones before `last`:
// stratumBegin(), step by step.
void sumStrata(uint receiver, uint units, uint count, uint last, uvec2 pixel, vec3 position,
               vec3 normal, inout Gathered sum) {
    uint block = blockShift(seed, pixel.x, pixel.y, accumulationIndex);
    uint slotShift = guideShift(units);
    uint quotient = units / count;
    uint remainder = units % count;
    uint carried = (remainder * firstSample) % count;
    uint begin = stratumBegin(units, count, firstSample);
    uint i = firstSample;
    do {
        uint width = quotient;
        carried += remainder;
        if (carried >= count) {
            carried -= count;
            ++width;
        }
        uint offset = sampleOffset(block, seed, pixel.x, pixel.y, i, accumulationIndex);
        uint unit = begin + mulHigh(offset, width);
        uint shift;
        uint view = viewOfUnit(receiver, receiver * capacity, slotShift, unit, shift);
        float sampled = float(width) * uintBitsToFloat((127u - shift) << 23u);
        if (width > 0u) addView(view, sampled, position, normal, sum);
        begin += width;
    } while (++i < last);
}

// list: the receiver's texel of `lists`. count: of samples, 0 = the full sum. With enabled false,
// nothing is read or summed.
Gathered gatherSum(uint receiver, uvec4 list, vec3 position, vec3 normal, uvec2 pixel, bool enabled,
                   uint count) {
    Gathered sum = Gathered(vec3(0.0), vec3(0.0));
    bool full = count == 0u || count >= list.z;
    uint last = min(count, lastSample);
    if (list.x == 0u) enabled = false;
    if (full && enabled) sumRuns(receiver * capacity, list.x, position, normal, sum);
    if (!full && enabled && firstSample < last) {
        sumStrata(receiver, list.y, count, last, pixel, position, normal, sum);
    }
    sum.clamped *= inverseEdge2;
    sum.unclamped *= inverseEdge2;
    return sum;
}
