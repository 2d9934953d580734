// The gather's sum where a pixel draws candidates for itself, instead of sharing those of its tile
// as gather.comp does.
#include "shaders/passes/gather_sum.glsl"

// Whose candidates they are, and the stratum at hand.
uint ownReceiver, ownUnits;  // a list, and its units
uint ownStrata;              // of equal power, that they fall into
uint ownCandidates;          // of each
uvec2 ownPixel;
uint ownOffset;
Stratum ownStratum;

void beginStratum(uint stratum) {
    ownOffset = sampleOffset(seed, ownPixel.x, ownPixel.y, stratum, accumulationIndex);
    ownStratum = stratumOf(ownUnits, ownStrata, stratum);
}

// They are evenly spread over the stratum.
uint drawCandidate(uint j, out float units) {
    uint place = ownOffset + j * (kNone / ownCandidates + 1u);
    return viewOfStratum(ownReceiver, ownUnits, ownStratum, place, units);
}

void addChoice(Choice choice, uint number) { addGroup(choice.chosen, groupWeight(choice)); }

#include "shaders/passes/candidate_groups.glsl"

// Sums those of `count` samples that lie from firstSample on and before `last`, as gather.comp
// does, but of candidates that the pixel draws for itself.
void sumStrata(uint receiver, uint units, uint count, uint last, uint candidatesOfOne, uvec2 pixel,
               vec3 position, vec3 normal, inout Gathered sum) {
    ownReceiver = receiver;
    ownUnits = units;
    ownStrata = count;
    ownCandidates = candidatesOfOne;
    ownPixel = pixel;
    uint together = resampledTogether(candidatesOfOne);
    for (uint begin = firstSample; begin < last; begin += together) {
        uint strata = min(together, last - begin);
        beginGroups(pixel, begin);
        for (uint i = 0u; i < strata; ++i) {
            addGroupsOfStratum(begin + i, candidatesOfOne, pixel, position, normal);
        }
        for (uint group = 0u; group < groupCount; ++group) {
            uint number = begin + samplesTaken;
            uint taken = takeSamples(group, strata);
            if (taken == 0u) continue;
            uint view = groupViews[group];
            float light = float(taken) *
                          sampleLight(groupWeights[group], groupTotal, strata, candidatesOfOne);
            addView(view, number, light / candidateWeight(view, 1.0, position, normal), position,
                    normal, sum);
        }
    }
}

// list: the receiver's texel of `lists`. count: of samples, 0 = the full sum. With enabled false,
// nothing is read or summed.
Gathered gatherSum(uint receiver, uvec4 list, vec3 position, vec3 normal, uvec2 pixel, bool enabled,
                   uint count, uint candidatesOfOne) {
    Gathered sum = Gathered(vec3(0.0), vec3(0.0));
    bool full = count == 0u || count >= list.z;
    uint last = min(count, lastSample);
    if (list.x == 0u) enabled = false;
    if (full && enabled) sumRuns(receiver * capacity, list.x, position, normal, sum);
    if (!full && enabled && firstSample < last) {
        sumStrata(receiver, list.y, count, last, candidatesOfOne, pixel, position, normal, sum);
    }
    sum.clamped *= inverseEdge2;
    sum.unclamped *= inverseEdge2;
    return sum;
}
