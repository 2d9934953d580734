layout(binding = 0) uniform sampler2D layer;
layout(location = 0) out vec4 outColour;

void main() {
    outColour = texelFetch(layer, ivec2(gl_FragCoord.xy), 0);
    if (outColour.a == 0.0) discard;
}
