// The sky behind everything. Smoother than its light: between the middles of cells.
#include "shaders/shared/sky.glsl"

layout(location = 0) out vec4 outPosition;
layout(location = 1) out vec4 outNormalDepth;
layout(location = 2) out vec4 outAlbedo;
layout(location = 3) out vec4 outEmission;
layout(location = 4) out vec4 outPlane;

uniform uint skyRows;
uniform vec2 size;                // of the picture, pixels
uniform vec3 right, up, forward;  // world; of the picture's edges at distance 1

vec3 cellAt(int column, int row) {
    int rows = int(skyRows);
    int columns = 2 * rows;
    if (row < 0 || row >= rows) column += rows;  // over the pole
    int inside = clamp(row, 0, rows - 1);
    return skyTexel(skyIndex(skyRows, uint((column + columns) % columns), uint(inside))).rgb;
}

void main() {
    outPosition = vec4(0.0);  // no surface
    outNormalDepth = vec4(0.0);
    outAlbedo = vec4(0.0);
    outPlane = vec4(0.0);
    vec2 place = 2.0 * gl_FragCoord.xy / size - 1.0;
    vec3 direction = normalize(forward + place.x * right + place.y * up);
    vec2 at = skyPlace(skyRows, direction) - 0.5;
    ivec2 base = ivec2(floor(at));
    vec2 part = at - vec2(base);
    vec3 above = mix(cellAt(base.x, base.y), cellAt(base.x + 1, base.y), part.x);
    vec3 below = mix(cellAt(base.x, base.y + 1), cellAt(base.x + 1, base.y + 1), part.x);
    outEmission = vec4(mix(above, below, part.y), 1.0);
}
