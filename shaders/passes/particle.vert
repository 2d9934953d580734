// A glowing particle as a disc that faces the camera.
#include "shaders/shared/types.glsl"
layout(location = 0) in vec3 position;
layout(location = 1) in uint flags;
layout(location = 2) in vec3 fluxW;
uniform mat4 clipFromWorld;
uniform vec3 eye;
uniform vec3 forward;
uniform float pixelsPerUnit;  // at distance 1 (perspective) or at any (orthographic)
uniform float eyeShare;       // 1: perspective
uniform float radius;         // root-cube units
uniform float edgeM;          // metres of the root cube's edge
uniform vec2 radiusPixels;    // least and most
flat out vec3 radiance;

void main() {
    gl_Position = clipFromWorld * vec4(position, 1.0);
    float depth = max(mix(1.0, dot(position - eye, forward), eyeShare), 1e-5);
    float scale = pixelsPerUnit / depth;
    float pixels = clamp(radius * scale, radiusPixels.x, radiusPixels.y);
    gl_PointSize = 2.0 * pixels;
    // The radiance of a Lambertian ball as large as the disc that is drawn.
    float radiusM = pixels / scale * edgeM;
    radiance = max(fluxW, vec3(0.0)) / (4.0 * kPi * kPi * radiusM * radiusM);
    if (flags == kViewDead) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // clipped
}
