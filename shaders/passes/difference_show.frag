// Differences -> colours, by their share of the range.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/colour_map.glsl"
#include "shaders/shared/tone.glsl"
layout(binding = kUnitDifferences) uniform sampler2D values;
uniform uint kind;
uniform float range;
layout(location = 0) out vec4 color;

void main() {
    float value = texelFetch(values, ivec2(gl_FragCoord.xy), 0).r;
    bool bad = isBad(value);
    vec3 shown = differenceColor(kind, clamp(value / range, -1.0, 1.0));
    color = vec4(bad ? badDifferenceColor() : shown, 1.0);
}
