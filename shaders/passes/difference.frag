// Radiance of both sides -> right minus left, and the one number that is shown of it; NaN where
// either side is no number.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/colour_map.glsl"
#include "shaders/shared/tone.glsl"
layout(binding = kUnitLeft) uniform sampler2D leftTexture;
layout(binding = kUnitRight) uniform sampler2D rightTexture;
uniform uint kind;    // mv::Difference
uniform float small;  // radiance that counts as black
layout(location = 0) out vec4 delta;
layout(location = 1) out float value;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec3 left = texelFetch(leftTexture, p, 0).rgb;
    vec3 right = texelFetch(rightTexture, p, 0).rgb;
    bool bad = isBad(left) || isBad(right);
    delta = vec4(right - left, 1.0);
    value = bad ? uintBitsToFloat(0x7FC00000u) : differenceValue(kind, left, right, small);
}
