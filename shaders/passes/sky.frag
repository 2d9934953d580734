// The sky behind everything.
#include "shaders/passes/sky_seen.glsl"

layout(location = 0) out vec4 outPosition;
layout(location = 1) out vec4 outNormalDepth;
layout(location = 2) out vec4 outAlbedo;
layout(location = 3) out vec4 outEmission;
layout(location = 4) out vec4 outPlane;
layout(location = 5) out vec4 outGloss;  // where the G-buffer has it
layout(location = 6) out vec4 outClear;  // so, too
layout(location = 7) out vec4 outCoat;   // so, too

uniform uint skyRows;
uniform vec2 size;                // of the picture, pixels
uniform vec3 right, up, forward;  // world; of the picture's edges at distance 1

void main() {
    outPosition = vec4(0.0);  // no surface
    outNormalDepth = vec4(0.0);
    outAlbedo = vec4(0.0);
    outPlane = vec4(0.0);
    outGloss = vec4(0.0);
    outClear = vec4(0.0);
    outCoat = vec4(0.0);
    vec2 place = 2.0 * gl_FragCoord.xy / size - 1.0;
    vec3 direction = normalize(forward + place.x * right + place.y * up);
    outEmission = vec4(skySeen(skyRows, direction), 1.0);
}
