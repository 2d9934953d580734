// Sizes that the host and the kernels of prefix sums and of the radix sort agree on.
#ifndef MV_SORT_GLSL
#define MV_SORT_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

// Counts that one invocation sums. Short enough for many invocations, long enough for few passes:
// 64^3 counts take five.
MV_CONST uint kSumSegment = 64u;

// A pass sorts by one digit; elements that are dead have a bin of their own behind all others.
MV_CONST uint kSortKeyBits = 30u;
MV_CONST uint kDigitBits = 5u;
MV_CONST uint kDigits = 32u;
MV_CONST uint kSortBins = 33u;

MV_END_NAMESPACE
#endif
