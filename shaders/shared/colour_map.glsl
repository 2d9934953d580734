// Colour maps for numbers: display values (sRGB encoded) for [0, 1]; what lies outside is clamped.
#ifndef MV_COLOUR_MAP_GLSL
#define MV_COLOUR_MAP_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

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

MV_END_NAMESPACE
#endif
