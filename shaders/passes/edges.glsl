// How much two surface points may share irradiance: the weights of the cross-bilateral filter
// [ED04, PSA*04]. Both end at exactly zero, so that nothing leaks over an edge.
#include "shaders/shared/gather.glsl"

// Normals apart by 37 degrees (cos 0.8) share nothing. Each point must also lie near the other's
// tangent plane: a depth edge is a step along the ray, which leaves the plane by far more than the
// slope allowed here unless the surface is seen from below 6 degrees.
float edgeWeight(vec3 p, vec3 np, vec3 q, vec3 nq) {
    float turn = clamp((dot(np, nq) - 0.8) * 5.0, 0.0, 1.0);
    vec3 way = q - p;
    float off = max(abs(dot(np, way)), abs(dot(nq, way)));
    float slope = off / (0.1 * length(way) + 1e-6);
    float plane = max(0.0, 1.0 - slope * slope);
    return turn * turn * plane * plane;
}
