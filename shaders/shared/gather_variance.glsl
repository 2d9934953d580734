// How much a pixel's sum of samples may be off, told from the samples: what the filter is guided
// by.
#ifndef MV_GATHER_VARIANCE_GLSL
#define MV_GATHER_VARIANCE_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

// The variance of a sum of n independent samples, from the sum and the sum of their squares.
MV_FN float varianceOfSum(float sum, float squares, uint n) {
    if (n < 2u) return squares;
    return max(0.0f, squares - sum * sum / float(n)) * (float(n) / float(n - 1u));
}

// The same where samples are drawn in two ways, each way a fixed number: that one way finds more
// than the other is no noise. What a single sample may be off is not known: no more than all of it,
// nor than it would be among samples of one way.
MV_FN float varianceOfWay(float sum, float squares, uint n, float mean, uint all) {
    if (n != 1u) return n == 0u ? 0.0f : varianceOfSum(sum, squares, n);
    float off = sum - mean;
    return all < 2u ? squares : min(squares, off * off * (float(all) / float(all - 1u)));
}
MV_FN float varianceOfTwoWays(vec2 sums, vec2 squares, uvec2 counts) {
    uint all = counts.x + counts.y;
    float mean = all > 0u ? (sums.x + sums.y) / float(all) : 0.0f;
    return varianceOfWay(sums.x, squares.x, counts.x, mean, all) +
           varianceOfWay(sums.y, squares.y, counts.y, mean, all);
}

// The same where some of the samples are of lamps. Strata are patches of a lamp, and of n of them
// the edge of a shadow cuts about sqrt(n): the others are lit or not for sure. So the square of
// such a sample's distance from the mean counts only this much of any other's. On average over
// lines through a square it would be 0.9 / sqrt(n); with less, the filter blurs less of a shadow.
MV_FN float lampSpread(uint n) { return min(1.0f, 0.5f / sqrt(float(n))); }
// That holds for one lamp. Where samples next to each other lie on different ones, `apart` of all
// such pairs, an edge of a shadow says nothing of the next sample.
MV_FN float lampsSpread(uint n, float apart) {
    float ofOne = lampSpread(n);
    return ofOne + (1.0f - ofOne) * apart;
}
// Do two views on lamps stand for one lamp, as seen from a receiver? They do if they lie in one
// plane or close together.
MV_CONST float kLampPlane = 0.05f;  // of their distance, that they may be off each other's plane
MV_CONST float kLampWidth = 0.25f;  // of the receiver's distance
MV_FN bool isOneLamp(vec3 receiver, vec3 a, vec3 normalA, vec3 b, vec3 normalB) {
    vec3 between = b - a;
    vec3 way = a - receiver;
    float distance2 = dot3(between, between);
    if (distance2 <= kLampWidth * kLampWidth * dot3(way, way)) return true;
    float off = max(abs(dot3(between, normalA)), abs(dot3(between, normalB)));
    return off * off <= kLampPlane * kLampPlane * distance2;
}
// squares: with those of lamps times their lampsSpread(). lamps: their number and their part of the
// sum, each times what that lacks of 1.
MV_FN float varianceWithLamps(float sum, float squares, vec2 lamps, uint n) {
    if (n < 2u) return squares;
    float mean = sum / float(n);
    float less = mean * (2.0f * lamps.y - mean * lamps.x);
    return max(0.0f, squares - sum * mean + less) * (float(n) / float(n - 1u));
}

MV_END_NAMESPACE
#endif
