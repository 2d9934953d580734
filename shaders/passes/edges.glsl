// How much two surface points may share irradiance: the weights of the cross-bilateral filter
// [ED04, PSA*04]. They end at exactly zero, so that nothing leaks over an edge.
#include "shaders/shared/gather.glsl"

// Root-cube units that a pixel of the G-buffer covers, seen straight on: x + y * depth.
uniform vec2 pixelSize;
float pixelFootprint(float depth) { return pixelSize.x + pixelSize.y * depth; }

// The tolerance of edgeWeight() for a tap of a 3 x 3 pattern, as a part of what lies between two
// taps: a corner is farther off than a side, by sqrt(2).
float tapTolerance(bool corner) { return corner ? 0.57 : 0.4; }

// Normals share what is left of their cosine above `leastCos`. Each point must also lie near the
// other's tangent plane, within `mostSlope` and `tolerance`, a part of what lies between two taps:
// curved surfaces leave the plane by less, a depth edge, being a step along the ray, by far more.
float edgeWeight(vec3 p, vec3 np, vec3 q, vec3 nq, float leastCos, float mostSlope,
                 float tolerance) {
    float turn = max(0.0, (dot(np, nq) - leastCos) / (1.0 - leastCos));
    vec3 way = q - p;
    float off = max(abs(dot(np, way)), abs(dot(nq, way)));
    float slope = off / (mostSlope * length(way) + tolerance + 1e-6);
    float plane = max(0.0, 1.0 - slope * slope);
    return turn * turn * plane * plane;
}
