// What maps say of whether light passes between a view, or the sky, and a receiver. One texel says
// lit, blocked or undecided. A view's map is sure where its nearest texels agree, and else says
// what more of them say.
#ifndef MV_MAP_VERDICT_GLSL
#define MV_MAP_VERDICT_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

MV_CONST uint kVerdictBlocked = 0u;
MV_CONST uint kVerdictLit = 1u;
MV_CONST uint kVerdictRatherBlocked = 2u;
MV_CONST uint kVerdictRatherLit = 3u;
MV_CONST uint kVerdictUndecided = 4u;  // of one texel, or of the sky's maps: never stored
MV_FN bool isSure(uint verdict) { return verdict <= kVerdictLit; }

// Verdicts of views are stored in so many bits.
MV_CONST uint kVerdictBits = 2u;
MV_CONST uint kVerdictMask = (1u << kVerdictBits) - 1u;
MV_CONST uint kVerdictsInWord = 32u / kVerdictBits;
#ifdef __cplusplus
static_assert(kVerdictRatherLit <= kVerdictMask && kVerdictUndecided > kVerdictMask);
#endif

MV_END_NAMESPACE
#endif
