// GBuffer x kept views x maps -> noisy irradiance [Kol19 §5.1], one fragment a gather pixel.
// MEASURE: instead, what the clamp takes away, on a sparse grid of the gather's pixels.
#include "shaders/passes/gather_pixel.glsl"

uniform uint viewCount;
uniform int stride;  // of the grid; 1 unless measuring

layout(location = 0) out vec4 irradiance;
layout(location = 1) out vec2 candidates;

void main() {
    bool present;
    uvec4 list;
    Gathered sum = gatherPixel(ivec2(gl_FragCoord.xy) * stride, present, list);
#ifdef MEASURE
    irradiance = vec4(luminance(sum.clamped), luminance(sum.unclamped), 0.0, 1.0);
#else
    irradiance = vec4(sum.clamped, present ? 1.0 : 0.0);
#endif
    candidates = vec2(present ? float(list.z) / float(viewCount) : 0.0, 0.0);
}
