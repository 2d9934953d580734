// Sorted views as the builders of view nodes read them; the arithmetic of mv::ViewHierarchy::build.
#include "shaders/shared/cone.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/morton.glsl"
#include "shaders/shared/types.glsl"

layout(binding = 0) uniform usamplerBuffer viewTexels;  // sorted View, 3 texels each

struct Cone {
    vec3 axis;
    float cosTheta, sinTheta;
    bool culls;
};

vec3 viewPosition(uint i) { return uintBitsToFloat(texelFetch(viewTexels, int(3u * i)).xyz); }
bool viewIsHemisphere(uint i) {
    return (texelFetch(viewTexels, int(3u * i)).w & kViewOmnidirectional) == 0u;
}
vec3 viewNormal(uint i) { return uintBitsToFloat(texelFetch(viewTexels, int(3u * i + 1u)).xyz); }

Cone coneOfView(uint i) {
    vec3 normal = viewNormal(i);
    vec3 axis = vec3(0.0);
    bool culls = coneAxis(normal, 1.0, axis) && viewIsHemisphere(i);
    return Cone(culls ? normal : axis, 1.0, 0.0, culls);
}
