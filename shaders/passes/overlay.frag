#include "shaders/shared/bindings.glsl"
layout(binding = kUnitDisplay) uniform sampler2D display;
layout(binding = kUnitOverlay) uniform sampler2D layer;
layout(location = 0) out vec4 outColour;

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 line = texelFetch(layer, p, 0);
    outColour = vec4(mix(texelFetch(display, p, 0).rgb, line.rgb, line.a), 1.0);
}
