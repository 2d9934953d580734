// How much two surface points may share irradiance: the weights of the cross-bilateral filter
// [ED04, PSA*04]. They end at exactly zero, so that nothing leaks over an edge.
#include "shaders/shared/gather.glsl"

// Root-cube units that a pixel of the G-buffer covers, seen straight on: x + y * depth.
uniform vec2 pixelSize;
float pixelFootprint(float depth) { return pixelSize.x + pixelSize.y * depth; }

// Normals apart by 60 degrees share nothing. Each point must also lie near the other's tangent
// plane, within a slope of 6 degrees and `tolerance`, a part of what lies between two taps: curved
// surfaces leave the plane by less, a depth edge, being a step along the ray, by far more.
float edgeWeight(vec3 p, vec3 np, vec3 q, vec3 nq, float tolerance) {
    float turn = max(0.0, 2.0 * dot(np, nq) - 1.0);
    vec3 way = q - p;
    float off = max(abs(dot(np, way)), abs(dot(nq, way)));
    float slope = off / (0.1 * length(way) + tolerance + 1e-6);
    float plane = max(0.0, 1.0 - slope * slope);
    return turn * turn * plane * plane;
}
