// The sky as the eye sees it: smoother than its light, between the middles of cells.
#include "shaders/shared/sky.glsl"

vec3 skyCell(uint skyRows, int column, int row) {
    int rows = int(skyRows);
    int columns = 2 * rows;
    if (row < 0 || row >= rows) column += rows;  // over the pole
    int inside = clamp(row, 0, rows - 1);
    return skyTexel(skyIndex(skyRows, uint((column + columns) % columns), uint(inside))).rgb;
}

vec3 skySeen(uint skyRows, vec3 direction) {
    vec2 at = skyPlace(skyRows, direction) - 0.5;
    ivec2 base = ivec2(floor(at));
    vec2 part = at - vec2(base);
    vec3 above =
        mix(skyCell(skyRows, base.x, base.y), skyCell(skyRows, base.x + 1, base.y), part.x);
    vec3 below =
        mix(skyCell(skyRows, base.x, base.y + 1), skyCell(skyRows, base.x + 1, base.y + 1), part.x);
    return mix(above, below, part.y);
}
