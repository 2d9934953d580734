// Differences -> colours, by their share of the range.
#include "shaders/shared/colour_map.glsl"
layout(binding = 0) uniform sampler2D values;
uniform uint kind;
uniform float range;
layout(location = 0) out vec4 color;

void main() {
    float value = texelFetch(values, ivec2(gl_FragCoord.xy), 0).r;
    bool bad = (floatBitsToUint(value) & 0x7F800000u) == 0x7F800000u;
    vec3 shown = differenceColor(kind, clamp(value / range, -1.0, 1.0));
    color = vec4(bad ? badDifferenceColor() : shown, 1.0);
}
