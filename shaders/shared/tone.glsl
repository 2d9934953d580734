// Tone maps and the sRGB transfer function: radiance times exposure -> display value in [0,1].
#ifndef MV_TONE_GLSL
#define MV_TONE_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE
#ifdef __cplusplus
using std::log2;
using std::pow;
#endif

MV_CONST uint kTexelsPerInvocation = 256u;  // of what sums over a picture

MV_CONST float kMiddleGrey = 0.18f;
// Bins of differences by the upper 16 bits of their magnitude; numbers lie in the finite ones.
MV_CONST uint kDifferenceBins = 0x8000u;
MV_CONST uint kFiniteDifferenceBins = 0x7F80u;

MV_FN bool isBad(float x) { return (floatBitsToUint(x) & 0x7F800000u) == 0x7F800000u; }
MV_FN bool isBad(vec3 c) { return isBad(c.x) || isBad(c.y) || isBad(c.z); }

// What is averaged over a pixel's points for a display: 1 - 4c / (1 + 4c) of each channel of
// exposed light, so that a bright point at an edge counts as much as is shown of it [Karis 2014].
MV_FN float compressChannel(float x) { return 1.0f / (1.0f + 4.0f * max(x, 0.0f)); }
MV_FN vec3 compressLight(vec3 c) {
    return vec3(compressChannel(c.x), compressChannel(c.y), compressChannel(c.z));
}
MV_FN float expandChannel(float share) { return (1.0f / share - 1.0f) / 4.0f; }
MV_FN vec3 expandLight(vec3 c) {
    return vec3(expandChannel(c.x), expandChannel(c.y), expandChannel(c.z));
}

// Fit of the ACES reference rendering transform [Narkowicz, ACES Filmic Tone Mapping Curve, 2015].
MV_FN float acesChannel(float x) {
    float y = x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f);
    return clamp(y, 0.0f, 1.0f);
}
MV_FN vec3 acesToneMap(vec3 c) {
    return vec3(acesChannel(c.x), acesChannel(c.y), acesChannel(c.z));
}

// PBR Neutral [Khronos, 2024]: keeps base colours below 0.8, compresses and desaturates above.
MV_FN vec3 neutralToneMap(vec3 c) {
    const float start = 0.8f - 0.04f;
    const float desaturation = 0.15f;
    float x = min(c.x, min(c.y, c.z));
    float offset = x < 0.08f ? x - 6.25f * x * x : 0.04f;
    vec3 color = c - vec3(offset);
    float peak = max(color.x, max(color.y, color.z));
    if (peak < start) return color;
    float d = 1.0f - start;
    float newPeak = 1.0f - d * d / (peak + d - start);
    color = color * (newPeak / peak);
    float g = 1.0f - 1.0f / (desaturation * (peak - newPeak) + 1.0f);
    return color * (1.0f - g) + vec3(newPeak * g);
}

// AgX [Sobotka, github.com/sobotka/AgX, 2022], its base look. Colours are drawn a fifth of the way
// to a weighted mean, each channel then goes through a sigmoid over 16.5 stops, and colours are
// drawn apart again: what is bright turns white whatever its hue, without the turn of the hue that
// a curve on each channel alone gives. The published matrices are these two lines, and the usual
// polynomials [Wrensch, Minimal AgX Implementation, 2023] are fits of this sigmoid, which is
// Sobotka's own: it is monotone and reaches 0 and 1.
MV_FN float agxMean(vec3 c) {
    return 0.21200536f * c.x + 0.39218251f * c.y + 0.39581214f * c.z;  // weights add up to 1
}
MV_FN float agxChannel(float x) {
    const float low = -12.473931f;  // stops below 1, and above; middle grey is where slopes meet
    const float high = 4.0260688f;
    const float middle = 0.60606061f;
    float d = (clamp(log2(max(x, 1e-10f)), low, high) - low) / (high - low) - middle;
    float s = d < 0.0f ? pow(1.0f + 59.507875f * pow(-d, 3.0f), -1.0f / 3.0f)
                       : pow(1.0f + 69.862789f * pow(d, 3.25f), -4.0f / 13.0f);
    return clamp(0.5f + 2.0f * d * s, 0.0f, 1.0f);
}
MV_FN vec3 agxToneMap(vec3 c) {
    vec3 inset = c * 0.8f + vec3(0.2f * agxMean(c));
    vec3 curved = vec3(agxChannel(inset.x), agxChannel(inset.y), agxChannel(inset.z));
    vec3 shown = max((curved - vec3(0.2f * agxMean(curved))) / 0.8f, vec3(0.0f));
    return vec3(pow(shown.x, 2.2f), pow(shown.y, 2.2f), pow(shown.z, 2.2f));  // of a display
}

// IEC 61966-2-1, exact, of a value in [0,1].
MV_FN float srgbChannel(float x) {
    return x <= 0.0031308f ? 12.92f * x : 1.055f * pow(x, 1.0f / 2.4f) - 0.055f;
}
MV_FN float linearFromSrgbChannel(float s) {
    return s <= 0.04045f ? s / 12.92f : pow((s + 0.055f) / 1.055f, 2.4f);
}
MV_FN vec3 srgbEncode(vec3 c) { return vec3(srgbChannel(c.x), srgbChannel(c.y), srgbChannel(c.z)); }

MV_END_NAMESPACE
#endif
