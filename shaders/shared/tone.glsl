// Tone maps and the sRGB transfer function: radiance times exposure -> display value in [0,1].
#ifndef MV_TONE_GLSL
#define MV_TONE_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE
#ifdef __cplusplus
using std::pow;
#endif

MV_CONST uint kTexelsPerInvocation = 256u;  // of what sums over a picture

MV_FN bool isBad(float x) { return (floatBitsToUint(x) & 0x7F800000u) == 0x7F800000u; }
MV_FN bool isBad(vec3 c) { return isBad(c.x) || isBad(c.y) || isBad(c.z); }

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
