// Sorted views as the builders of view nodes read them; the arithmetic of mv::ViewHierarchy::build.
#include "shaders/shared/cone.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/morton.glsl"

struct Cone {
    vec3 axis;
    float cosTheta, sinTheta;
    bool culls;
};

bool viewIsHemisphere(uint i) { return (viewFlags(i) & kViewOmnidirectional) == 0u; }

Cone coneOfView(uint i) {
    vec3 normal = viewNormal(i);
    vec3 axis = vec3(0.0);
    bool culls = coneAxis(normal, 1.0, axis) && viewIsHemisphere(i);
    return Cone(culls ? normal : axis, 1.0, 0.0, culls);
}
