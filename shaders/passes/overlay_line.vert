// A line as a screen-aligned strip of two triangles, clipped to the camera's volume first so that
// both ends project.
#include "shaders/shared/bindings.glsl"
layout(binding = kUnitLines) uniform usamplerBuffer lineTexels;  // Line: a, b, colour
uniform mat4 clipFromWorld;
uniform vec2 size;  // pixels
uniform float widthPixels;
flat out vec4 colour;
noperspective out float across;  // pixels from the line's middle

float word(int i) { return uintBitsToFloat(texelFetch(lineTexels, i).x); }

// Keeps of [t.x, t.y] the part where the plane's side a + t (b - a) is not negative.
vec2 clipSide(vec2 t, float a, float b) {
    if (a < 0.0) t.x = b > a ? max(t.x, a / (a - b)) : 2.0;
    if (b < 0.0) t.y = a > b ? min(t.y, a / (a - b)) : -1.0;
    return t;
}

void main() {
    int first = 7 * (gl_VertexID / 6);
    int corner = gl_VertexID % 6;
    vec4 a = clipFromWorld * vec4(word(first), word(first + 1), word(first + 2), 1.0);
    vec4 b = clipFromWorld * vec4(word(first + 3), word(first + 4), word(first + 5), 1.0);
    colour = unpackUnorm4x8(texelFetch(lineTexels, first + 6).x);

    vec2 t = vec2(0.0, 1.0);
    t = clipSide(t, a.w - a.z, b.w - b.z);  // near; reversed depth
    // Sides, with room for the width.
    t = clipSide(t, 1.1 * a.w - a.x, 1.1 * b.w - b.x);
    t = clipSide(t, 1.1 * a.w + a.x, 1.1 * b.w + b.x);
    t = clipSide(t, 1.1 * a.w - a.y, 1.1 * b.w - b.y);
    t = clipSide(t, 1.1 * a.w + a.y, 1.1 * b.w + b.y);
    if (!(t.x < t.y)) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // clipped
        across = 0.0;
        return;
    }
    vec4 from = mix(a, b, t.x);
    vec4 to = mix(a, b, t.y);

    vec2 direction = (to.xy / to.w - from.xy / from.w) * size;
    float pixels = length(direction);
    direction = pixels > 1e-6 ? direction / pixels : vec2(1.0, 0.0);
    // Half a pixel more would be covered a little: too little to hide what lies behind.
    float reach = 0.5 * widthPixels + 0.3;
    float side = corner == 1 || corner == 2 || corner == 4 ? 1.0 : -1.0;
    bool atEnd = corner == 2 || corner == 4 || corner == 5;
    float along = atEnd ? 0.5 * widthPixels : -0.5 * widthPixels;  // square caps
    vec4 clip = atEnd ? to : from;
    vec2 offset = vec2(-direction.y, direction.x) * side * reach + direction * along;
    clip.xy += offset * 2.0 / size * clip.w;
    gl_Position = clip;
    across = side * reach;
}
