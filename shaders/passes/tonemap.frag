// Radiance -> display: exposure, tone map MV_TONE_MAP (mv::ToneMap: 0 none, 1 ACES-like, 2 Khronos
// neutral), sRGB; data views (MV_VIEW) are shown as they are.
#include "shaders/shared/debug_view.glsl"
#include "shaders/shared/light.glsl"
#include "shaders/shared/tone.glsl"
layout(binding = 0) uniform sampler2D radianceTexture;
uniform float exposure;
out vec4 color;

bool isBad(float x) { return (floatBitsToUint(x) & 0x7F800000u) == 0x7F800000u; }

// Black, blue, magenta, orange, yellow, white for 0 .. 1.
vec3 heat(float x) {
    return clamp(vec3(2.6 * x - 0.5, 2.2 * x - 1.0, x < 0.5 ? sin(2.0 * kPi * x) : 4.0 * x - 3.0),
                 vec3(0.0), vec3(1.0));
}

void main() {
    vec3 radiance = texelFetch(radianceTexture, ivec2(gl_FragCoord.xy), 0).rgb;
    bool bad = isBad(radiance.r) || isBad(radiance.g) || isBad(radiance.b);
    if (bad) radiance = vec3(0.0);
#if MV_VIEW == MV_VIEW_NORMALS
    vec3 shown = 0.5 * radiance + 0.5 * float(dot(radiance, radiance) > 0.0);
#elif MV_VIEW == MV_VIEW_ALBEDO
    vec3 shown = srgbEncode(clamp(radiance, vec3(0.0), vec3(1.0)));
#elif MV_VIEW == MV_VIEW_DEPTH
    vec3 shown = vec3(1.0 - exp2(-4.0 * max(radiance.r, 0.0)));
#elif MV_VIEW == MV_VIEW_CANDIDATES
    vec3 shown = heat(radiance.r);
#else
    vec3 mapped = max(radiance * exposure, vec3(0.0));
#if MV_TONE_MAP == 1
    mapped = acesToneMap(mapped);
#elif MV_TONE_MAP == 2
    mapped = neutralToneMap(mapped);
#endif
    vec3 shown = srgbEncode(clamp(mapped, vec3(0.0), vec3(1.0)));
#if MV_VIEW == MV_VIEW_NAN
    shown = bad ? vec3(1.0, 0.0, 0.0) : vec3(0.4 * luminance(shown));
#endif
#endif
    color = vec4(clamp(shown, vec3(0.0), vec3(1.0)), 1.0);
}
