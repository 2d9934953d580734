// The sum over a receiver's kept views, or an estimate of it from samples drawn by power. Included
// by every shader that gathers.
// MV_VISIBILITY: the file that answers whether a sample's light passes, see VisibilitySample.
// MV_MAPS_DECIDE: only where the maps do not know (decide_by_maps.glsl).
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
uniform uint samples;                                                        // 0: the full sum
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
    vec3 plane;             // its triangle's normal
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

// What is known of a sample before that question is put.
const uint kBlocked = 0u;
const uint kLit = 1u;
const uint kAsk = 2u;
#ifdef MV_MAPS_DECIDE
#include "shaders/passes/decide_by_maps.glsl"
#else
uint decide(VisibilitySample s) { return kAsk; }
#endif

vec3 receiverPlane;  // of the pixel: its triangle's normal

// x: with the clamp, y: without it; both with visibility.
struct Gathered {
    vec3 clamped;
    vec3 unclamped;
};

// One view and what it would give a receiver if nothing stood between them.
struct Gift {
    VisibilitySample way;
    bool omnidirectional;
    vec3 flux;  // W, of what the sample stands for
    float term;
};

// sampled: power units that the sample stands for; 0 in the full sum, where a view has all its own.
Gift giftOf(uint view, float sampled, vec3 position, vec3 normal) {
    uvec4 a = texelFetch(records, int(view * 3u));
    uvec4 b = texelFetch(records, int(view * 3u + 1u));
    uvec4 c = texelFetch(records, int(view * 3u + 2u));
    Gift gift;
    gift.omnidirectional = b.w == kNoSurface;
    vec3 viewNormal = gift.omnidirectional ? vec3(0.0) : unpackNormal(b.w);
    vec3 toView = uintBitsToFloat(a.xyz) - position;
    float weight = (sampled > 0.0 ? sampled : float(c.w)) * (1.0 / kPowerUnits);
    float clampDistance = texelFetch(clampDistances, int(view)).x;
    gift.term = gatherTerm(toView, normal, viewNormal, gift.omnidirectional, clampDistance, cutoff);
    gift.way = VisibilitySample(position, normal, receiverPlane, toView, viewNormal, a.w,
                                position - uintBitsToFloat(c.xyz), gift.term > 0.0);
    gift.flux = uintBitsToFloat(b.xyz) * weight;
    return gift;
}

void addView(uint view, float sampled, vec3 position, vec3 normal, inout Gathered sum) {
    Gift gift = giftOf(view, sampled, position, normal);
    uint known = decide(gift.way);
    bool visible = known == kAsk ? isVisible(gift.way) : known == kLit;
    float lit = visible ? 1.0 : 0.0;
    sum.clamped += gift.flux * lit * gift.term;
#ifdef SAMPLES
    recordSample(view, gift.flux * gift.term, visible);
#endif
#ifdef MEASURE
    sum.unclamped +=
        gift.flux * lit *
        gatherTerm(gift.way.toView, normal, gift.way.viewNormal, gift.omnidirectional, 0.0, cutoff);
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

// One view from each of `count` strata of equal power: stratumBegin(), step by step.
struct Strata {
    uint count, quotient, remainder, carried, begin, i;
};
Strata strataFrom(uint units, uint count, uint first) {
    uint remainder = units % count;
    return Strata(count, units / count, remainder, (remainder * first) % count,
                  stratumBegin(units, count, first), first);
}
// The view of the next stratum. sampled: the power units it stands for; 0: the stratum is empty.
uint nextView(inout Strata strata, uint receiver, uint slotShift, uint block, uvec2 pixel,
              out float sampled) {
    uint width = strata.quotient;
    strata.carried += strata.remainder;
    if (strata.carried >= strata.count) {
        strata.carried -= strata.count;
        ++width;
    }
    uint offset = sampleOffset(block, seed, pixel.x, pixel.y, strata.i, accumulationIndex);
    uint unit = strata.begin + mulHigh(offset, width);
    uint shift;
    uint view = viewOfUnit(receiver, receiver * capacity, slotShift, unit, shift);
    sampled = float(width) * uintBitsToFloat((127u - shift) << 23u);
    strata.begin += width;
    ++strata.i;
    return view;
}

// Of `count` samples those from firstSample on that are before `last`.
void sumStrata(uint receiver, uint units, uint count, uint last, uvec2 pixel, vec3 position,
               vec3 normal, inout Gathered sum) {
    uint block = blockShift(seed, pixel.x, pixel.y, accumulationIndex);
    uint slotShift = guideShift(units);
    Strata strata = strataFrom(units, count, firstSample);
    do {
        float sampled;
        uint view = nextView(strata, receiver, slotShift, block, pixel, sampled);
        if (sampled > 0.0) addView(view, sampled, position, normal, sum);
    } while (strata.i < last);
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
