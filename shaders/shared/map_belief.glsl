// What is believed of a view's map when the gather samples its views, and how far that is doubted
// (docs/method.md).
#ifndef MV_MAP_BELIEF_GLSL
#define MV_MAP_BELIEF_GLSL
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/map_verdict.glsl"

MV_BEGIN_NAMESPACE

// How likely light passes by a map's verdict. Where the map is not sure this is the share of
// samples that rays found lit, in round numbers (docs/method.md). Any value is unbiased; these
// leave little to correct.
MV_FN float beliefIn(uint verdict) {
    return verdict == kVerdictLit         ? 1.0f
           : verdict == kVerdictRatherLit ? 0.75f
           : verdict == kVerdictBlocked   ? 0.0f
                                          : 0.4f;
}
// How far a belief is off, relative to one that knows nothing: samples are worth taking in
// proportion. check: of those that are sure; 0: they are not doubted.
MV_FN float doubtIn(uint verdict, float check) {
    return isSure(verdict) ? check : verdict == kVerdictRatherLit ? 0.85f : 1.0f;
}

// What a group of candidates takes samples in proportion to where its choice has a verdict, and
// what it would give, told from that weight. Since what is hidden is believed to be, the weight is
// closer to the light itself than groupWeight().
MV_CONST float kDoubtedPower = 0.75f;
MV_FN float doubtedWeight(Choice choice, float doubt) {
    return pow(choice.total, kDoubtedPower) * doubt;
}
MV_FN float doubtedTotal(float weight, float doubt) {
    return pow(weight / doubt, 1.0f / kDoubtedPower);
}
// The light that each sample of such a group stands for, see sampleLight().
MV_FN float doubtedLight(float weight, float doubt, float total, uint strata, uint candidates) {
    return sampleLight(doubtedTotal(weight, doubt) / weight, total, strata, candidates);
}

MV_END_NAMESPACE
#endif
