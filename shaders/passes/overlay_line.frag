#include "shaders/shared/bindings.glsl"
layout(binding = kUnitSurfaceDepth) uniform sampler2D surfaceDepth;  // reversed: 0 = nothing
uniform float widthPixels;
uniform float hiddenAlpha;
uniform vec2 tolerance;  // relative, absolute
flat in vec4 colour;
noperspective in float across;
layout(location = 0) out vec4 outColour;

void main() {
    float coverage = clamp(0.5 * widthPixels + 0.5 - abs(across), 0.0, 1.0);
    // The farthest of the surfaces around: a line in a slanting surface is not hidden by it.
    ivec2 last = textureSize(surfaceDepth, 0) - 1;
    ivec2 p = ivec2(gl_FragCoord.xy);
    float surface = texelFetch(surfaceDepth, p, 0).x;
    surface = min(surface, texelFetch(surfaceDepth, min(p + ivec2(1, 0), last), 0).x);
    surface = min(surface, texelFetch(surfaceDepth, min(p + ivec2(0, 1), last), 0).x);
    surface = min(surface, texelFetch(surfaceDepth, max(p - ivec2(1, 0), 0), 0).x);
    surface = min(surface, texelFetch(surfaceDepth, max(p - ivec2(0, 1), 0), 0).x);
    bool hidden = gl_FragCoord.z < surface * (1.0 - tolerance.x) - tolerance.y;
    outColour = vec4(colour.rgb, colour.a * coverage * (hidden ? hiddenAlpha : 1.0));
}
