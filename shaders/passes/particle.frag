#include "shaders/passes/no_surface.glsl"

flat in vec3 radiance;

void main() {
    vec2 p = 2.0 * gl_PointCoord - 1.0;
    if (dot(p, p) > 1.0) discard;
    writeNoSurface(radiance);
}
