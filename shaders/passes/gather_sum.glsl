// The sum over a receiver's kept views, or an estimate of it from samples drawn by power. Included
// by every shader that gathers.
// MV_VISIBILITY: the file that answers whether a sample's light passes, see VisibilitySample.
// MV_MAPS_DECIDE: maps say what they know first (decide_by_maps.glsl).
// MV_VERDICTS: maps are there slice by slice. 1: what those of one slice know is written down and
// nothing summed; 2: what was written down is read.
// MV_SAMPLE_ROUNDS: that file's loops are bounded by sampleRounds.
// MV_RECORDS_SAMPLES: samples are written down (record_samples.glsl).
// MV_MEASURES_CLAMP: light without the clamp is summed, too.
// MV_GLOSS: the G-buffer's surfaces may have broad gloss.
#include "shaders/passes/gather_lists.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_data.glsl"
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/map_belief.glsl"
#ifdef MV_GLOSS
#include "shaders/passes/surface_gloss.glsl"
#endif

layout(binding = kUnitGatherRecords) uniform usamplerBuffer records;  // GatherRecord
uniform uint samples;                                                 // 0: the full sum
// Samples k, or in a full sum kept views k, with firstSample <= k < lastSample are summed.
uniform uint firstSample;
uniform uint lastSample;
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
    bool ofLamp;            // the view lies on an emissive surface, for its direct light
};
#ifdef MV_SAMPLE_ROUNDS
uniform uint sampleRounds;  // of its loops, that one sample may take in the mean
// Set where one took more: the picture is then no good.
layout(std430, binding = kBlockRoundsOverflow) writeonly buffer RoundsOverflow {
    uint roundsOverflow;
};
void noteRounds(uint rounds, uint allowed) {
    if (rounds > allowed) roundsOverflow = 1u;
}
#else
const uint sampleRounds = kNone;
void noteRounds(uint rounds, uint allowed) {}
#endif
#include MV_VISIBILITY

#ifndef MV_VERDICTS
#define MV_VERDICTS 0
#endif
#if MV_VERDICTS > 0
layout(std430, binding = kBlockVerdicts) buffer Verdicts { uint verdicts[]; };  // 16 a word
uint firstVerdict;                                                              // word of the pixel
#endif
#if defined(MV_MAPS_DECIDE) && MV_VERDICTS < 2
#include "shaders/passes/decide_by_maps.glsl"
#endif
// What is known of a sample before the method is asked. number: of the pixel's samples; where maps
// decide, of its groups of candidates; in a full sum, of the views that it keeps.
uint known(VisibilitySample s, uint number) {
#if MV_VERDICTS == 1
    if (s.map >= firstMap && s.map < endMap) {
#ifdef MV_MAPS_DECIDE
        uint verdict = decide(s);
#else
        uint verdict = isVisible(s) ? kVerdictLit : kVerdictBlocked;
#endif
        atomicOr(verdicts[firstVerdict + number / kVerdictsInWord],
                 verdict << (number % kVerdictsInWord * kVerdictBits));
    }
    return kVerdictBlocked;
#elif MV_VERDICTS == 2
    return verdicts[firstVerdict + number / kVerdictsInWord] >>
               (number % kVerdictsInWord * kVerdictBits) &
           kVerdictMask;
#elif defined(MV_MAPS_DECIDE)
    return decide(s);
#else
    return kVerdictRatherBlocked;
#endif
}

#ifdef MV_RECORDS_SAMPLES
#include "shaders/passes/record_samples.glsl"
#endif

vec3 receiverPlane;  // of the pixel: its triangle's normal

// What the pixel's broad gloss makes of light from a view, as a factor.
#ifdef MV_GLOSS
BroadGloss receiverGloss;
vec3 glossWeight(uint view, vec3 position, vec3 normal) {
    vec3 way = uintBitsToFloat(texelFetch(records, int(view * 4u)).xyz) - position;
    return broadGlossWeight(receiverGloss, normal, normalizeOr(way, normal));
}
#else
vec3 glossWeight(uint view, vec3 position, vec3 normal) { return vec3(1.0); }
#endif

// place: of the pixel's surface in the G-buffer. Called before anything is summed.
void beginReceiver(ivec2 place, vec3 position, vec3 normal, vec3 plane) {
    receiverPlane = plane;
#ifdef MV_GLOSS
    receiverGloss = broadGlossAt(place, position, normal, kRoughGloss);
#endif
}

// Irradiance with visibility, with the clamp and without it.
struct Gathered {
    vec3 clamped;
    vec3 unclamped;
};

vec4 recordOf(uint view, uint texel) {
    return uintBitsToFloat(texelFetch(records, int(view * 4u + texel)));
}

// What a view would give a receiver for each power unit of its flux if nothing stood between them.
float termOf(uint view, vec3 position, vec3 normal) {
    vec4 a = recordOf(view, 0u);
    vec3 viewNormal = recordOf(view, 1u).xyz;
    return gatherTerm(a.xyz - position, normal, viewNormal, viewNormal == vec3(0.0), a.w, cutoff);
}

VisibilitySample sampleOf(uint view, vec3 position, vec3 normal, vec3 plane) {
    vec4 a = recordOf(view, 0u);
    vec3 viewNormal = recordOf(view, 1u).xyz;
    uint map = texelFetch(records, int(view * 4u + 2u)).w;
    uvec4 d = texelFetch(records, int(view * 4u + 3u));
    return VisibilitySample(position, normal, plane, a.xyz - position, viewNormal, map,
                            position - uintBitsToFloat(d.xyz), true, isOnLamp(d.w));
}

// The flux of so many power units of a view, W.
vec3 fluxOf(uint view, float units) { return recordOf(view, 2u).rgb * (units / kPowerUnits); }

// units: what the sample stands for; 0 in a full sum, where a view has all its own. number: see
// known().
void addView(uint view, uint number, float units, vec3 position, vec3 normal, inout Gathered sum) {
    if (units == 0.0) units = float(unitsOf(texelFetch(records, int(view * 4u + 3u)).w));
    VisibilitySample way = sampleOf(view, position, normal, receiverPlane);
    float term = termOf(view, position, normal);
    way.counts = term > 0.0;
    vec3 weight = glossWeight(view, position, normal);
    vec3 light = fluxOf(view, units) * weight * term;
    uint verdict = known(way, number);
    bool visible = isSure(verdict) ? verdict == kVerdictLit : isVisible(way);
    if (visible) sum.clamped += light;
#ifdef MV_RECORDS_SAMPLES
    recordSample(view, light, visible ? light : vec3(0.0), visible);
#endif
#ifdef MV_MEASURES_CLAMP
    vec3 viewNormal = way.viewNormal;
    float open = gatherTerm(way.toView, normal, viewNormal, viewNormal == vec3(0.0), 0.0, cutoff);
    if (visible) sum.unclamped += fluxOf(view, units) * weight * open;
#endif
}

// Adds every view of every run.
void sumRuns(uint firstRun, uint runCount, vec3 position, vec3 normal, inout Gathered sum) {
    uint run = 0u;
    uint before = 0u;  // views of the runs before
    do {
        uvec4 r = texelFetch(runs, int(firstRun + run));
        uint views = runEnd(r.z) - r.y;
        uint k = max(firstSample, before) - before;
        uint end = min(lastSample - min(before, lastSample), views);
        if (k < end) {
            do addView(r.y + k, before + k, 0.0, position, normal, sum);
            while (++k < end);
        }
        before += views;
    } while (++run < runCount && before < lastSample);
}

// The groups of candidates of a batch's strata, which share out its samples.
float groupWeights[kBatchSamples * kCandidateGroups];
uint groupViews[kBatchSamples * kCandidateGroups];  // whatever addGroup() was told
uint groupCount;
float groupTotal;    // of the weights
float resampleBy;    // the number of samplesUpTo()
float weightBefore;  // of groups that have taken their samples
uint samplesTaken;   // that they took
// begin: the batch's first stratum.
void beginGroups(uvec2 pixel, uint begin) {
    groupCount = 0u;
    groupTotal = 0.0;
    resampleBy =
        unitFloat(sampleOffset(seed ^ kResampleSeed, pixel.x, pixel.y, begin, accumulationIndex));
    weightBefore = 0.0;
    samplesTaken = 0u;
}
void addGroup(uint view, float weight) {
    groupWeights[groupCount] = weight;
    groupViews[groupCount] = view;
    groupTotal += weight;
    ++groupCount;
}

// How many samples a group takes, of as many as there are strata. Called for one group after
// another.
uint takeSamples(uint group, uint strata) {
    uint before = samplesTaken;
    weightBefore += groupWeights[group];
    samplesTaken = samplesUpTo(weightBefore, groupTotal, strata, resampleBy);
    return samplesTaken - before;
}

// The luminance, in power units, that a view would give for so many of them if nothing stood
// between.
float candidateWeight(uint view, float units, vec3 position, vec3 normal) {
    return units * recordOf(view, 1u).w * termOf(view, position, normal);
}
