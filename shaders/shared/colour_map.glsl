// Numbers -> colours that also show in grey and to the colour-blind. All are sRGB-encoded, in
// [0,1].
#ifndef MV_COLOUR_MAP_GLSL
#define MV_COLOUR_MAP_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/light.glsl"

MV_BEGIN_NAMESPACE

// Values of mv::Difference.
MV_CONST uint kDifferenceAbsolute = 1u;
MV_CONST uint kDifferenceSigned = 2u;
MV_CONST uint kDifferenceRelative = 3u;

MV_FN vec3 unitColor(vec3 c) { return clamp(c, vec3(0.0f), vec3(1.0f)); }

MV_FN vec3 colourOfCode(uint rgb) {
    return vec3(float((rgb >> 16u) & 255u), float((rgb >> 8u) & 255u), float(rgb & 255u)) / 255.0f;
}

// Ten equally spaced colours of viridis [Smith and van der Walt 2015]: even in lightness and told
// apart by colour-blind eyes.
MV_FN uint viridisCode(uint i) {
    uint low = i < 1u   ? 0x440154u
               : i < 2u ? 0x482878u
               : i < 3u ? 0x3E4A89u
               : i < 4u ? 0x31688Eu
                        : 0x26828Eu;
    uint high = i < 6u   ? 0x1F9E89u
                : i < 7u ? 0x35B779u
                : i < 8u ? 0x6DCD59u
                : i < 9u ? 0xB4DE2Cu
                         : 0xFDE725u;
    return i < 5u ? low : high;
}
MV_FN vec3 viridis(float x) {
    float at = x > 0.0f ? min(x, 1.0f) * 9.0f : 0.0f;
    uint i = min(uint(at), 8u);
    return mix(colourOfCode(viridisCode(i)), colourOfCode(viridisCode(i + 1u)), at - float(i));
}

// Cividis [Nunez, Anderton and Renslow 2018] for t in [0,1]: our least-squares fit of degree 5 to
// ten of its colours an equal way apart, at most 10/255 off them.
MV_FN vec3 cividis(float t) {
    t = clamp(t, 0.0f, 1.0f);
    vec3 c = vec3(-14.7845f, -0.4750f, 10.7767f);
    c = c * t + vec3(38.9555f, 1.2700f, -28.9171f);
    c = c * t + vec3(-36.2944f, -1.0866f, 27.2506f);
    c = c * t + vec3(13.9531f, 0.4421f, -11.1341f);
    c = c * t + vec3(-0.8266f, 0.6418f, 1.9957f);
    return unitColor(c * t + vec3(-0.0071f, 0.1253f, 0.3052f));
}

// Dark blue, white, dark orange for t in [-1,1]: two quadratic Bezier curves that leave white and
// grow darker alike. Blue and orange are told apart with any common colour blindness.
MV_FN vec3 divergingColor(float t) {
    float x = min(abs(t), 1.0f);
    vec3 middle = t < 0.0f ? vec3(0.26f, 0.62f, 0.92f) : vec3(0.99f, 0.58f, 0.18f);
    vec3 end = t < 0.0f ? vec3(0.03f, 0.17f, 0.42f) : vec3(0.45f, 0.12f, 0.02f);
    vec3 near = vec3(0.97f) + (middle - vec3(0.97f)) * x;
    vec3 far = middle + (end - middle) * x;
    return unitColor(near + (far - near) * x);
}

// Colours a difference, given as a share of its range: [0,1], signed ones [-1,1].
MV_FN vec3 differenceColor(uint kind, float t) {
    if (kind == kDifferenceSigned) return divergingColor(t);
    return kind == kDifferenceRelative ? cividis(t) : viridis(t);
}
// Where the difference is no number: none of the colours above.
MV_FN vec3 badDifferenceColor() { return vec3(1.0f, 0.0f, 1.0f); }

// ---------------------------------------------------------------- the number itself

// Compares two radiances, right minus left: by the luminance of |right - left|, with its sign that
// of right - left, or the first over the luminance of the left, where `small` stands for black.
MV_FN float differenceValue(uint kind, vec3 left, vec3 right, float small) {
    vec3 delta = right - left;
    if (kind == kDifferenceSigned) return luminance(delta);
    float value = luminance(abs(delta));
    if (kind == kDifferenceAbsolute) return value;
    return value / (max(luminance(left), 0.0f) + small);
}

MV_END_NAMESPACE
#endif
