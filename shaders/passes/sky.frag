// The sky behind everything.
#include "shaders/passes/no_surface.glsl"
#include "shaders/passes/sky_seen.glsl"

uniform uint skyRows;
uniform vec2 size;                // of the picture, pixels
uniform vec3 right, up, forward;  // world; of the picture's edges at distance 1

void main() {
    vec2 place = 2.0 * gl_FragCoord.xy / size - 1.0;
    vec3 direction = normalize(forward + place.x * right + place.y * up);
    writeNoSurface(skySeen(skyRows, direction));
}
