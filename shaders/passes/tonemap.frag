// Radiance -> display: exposure, tone map MV_TONE_MAP (mv::ToneMap: 0 none, 1 ACES-like, 2 Khronos
// neutral, 3 AgX), sRGB; data views (MV_VIEW) are shown as they are.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/colour_map.glsl"
#include "shaders/shared/debug_view.glsl"
#include "shaders/shared/light.glsl"
#include "shaders/shared/tone.glsl"
layout(binding = kUnitRadiance) uniform sampler2D radianceTexture;
uniform float exposure;
uniform float meanExposure;  // of displayMean in passes/average_pixels.comp; 0: plain radiance
out vec4 color;

// A value lies on a scale (mv::DebugLegend) at value * scale + offset, or its logarithm does.
uniform float scale;
uniform float scaleOffset;
uniform bool logarithmic;
uniform bool grey;

vec3 onScale(float value) {
    float at = (logarithmic ? log2(max(value, 1e-30)) : value) * scale + scaleOffset;
    vec3 colour = grey ? vec3(clamp(at, 0.0, 1.0)) : viridis(at);
    return value > 0.0 ? colour : vec3(0.0);
}

// Less than half a step of 8 bits either way, another one at each pixel but the same for its
// channels: gradients have no steps, and what lies on a step stays there. Interleaved gradient
// noise [Jimenez, Next Generation Post Processing in Call of Duty: Advanced Warfare, 2014].
float ditherAt(vec2 pixel) {
    float u = fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715))));
    return (u - 0.5) * (0.998 / 255.0);
}

void main() {
    vec3 radiance = texelFetch(radianceTexture, ivec2(gl_FragCoord.xy), 0).rgb;
    if (meanExposure > 0.0) radiance = expandLight(radiance) / meanExposure;
    bool bad = isBad(radiance);
    if (bad) radiance = vec3(0.0);
#if MV_VIEW == MV_VIEW_NORMALS
    vec3 shown = 0.5 * radiance + 0.5 * float(dot(radiance, radiance) > 0.0);
#elif MV_VIEW == MV_VIEW_ALBEDO || MV_VIEW == MV_VIEW_SHARED
    vec3 shown = srgbEncode(clamp(radiance, vec3(0.0), vec3(1.0)));
#elif MV_VIEW == MV_VIEW_DEPTH || MV_VIEW == MV_VIEW_CANDIDATES || MV_VIEW == MV_VIEW_UNDECIDED || \
    MV_VIEW == MV_VIEW_SHARING
    vec3 shown = onScale(radiance.r);
#else
    vec3 mapped = max(radiance * exposure, vec3(0.0));
#if MV_TONE_MAP == 1
    mapped = acesToneMap(mapped);
#elif MV_TONE_MAP == 2
    mapped = neutralToneMap(mapped);
#elif MV_TONE_MAP == 3
    mapped = agxToneMap(mapped);
#endif
    vec3 shown = srgbEncode(clamp(mapped, vec3(0.0), vec3(1.0)));
#if MV_VIEW == MV_VIEW_NAN
    shown = bad ? vec3(1.0, 0.0, 0.0) : vec3(0.4 * luminance(shown));
#else
    shown += vec3(ditherAt(gl_FragCoord.xy));
#endif
#endif
    color = vec4(clamp(shown, vec3(0.0), vec3(1.0)), 1.0);
}
