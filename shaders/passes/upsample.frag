// The full-resolution pixels of a gather at half resolution.
#include "shaders/passes/upsample.glsl"

layout(location = 0) out vec4 irradiance;
layout(location = 1) out vec4 unfiltered;
layout(location = 2) out vec2 candidates;

void main() {
    Upsampled result = upsamplePixel(ivec2(gl_FragCoord.xy));
    irradiance = result.irradiance;
    unfiltered = result.unfiltered;
    candidates = result.candidates;
}
