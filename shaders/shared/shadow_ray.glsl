// Is the way between a receiver and a view free of the scene's triangles, alpha masks honoured? The
// ray is that of the exact gather (megaviews/references/exact_gather.h): from the receiver, lifted
// off its surface as VPLs are, to the view's own position.
// Root-cube units. bvh_data.glsl says how to include it from either language.
#ifndef MV_SHADOW_RAY_GLSL
#define MV_SHADOW_RAY_GLSL
#include "shaders/shared/bvh.glsl"

MV_BEGIN_NAMESPACE

MV_FN bool shadowRayBlocked(MV_BVH_PARAMS vec3 receiver, vec3 normal, vec3 view) {
    vec3 lifted = receiver + normal * bvhLift(MV_BVH_SELF);
    return bvhOccluded(MV_BVH_ARGS lifted, view - lifted, 0.0f, 1.0f);
}
// The share of a light's light, by colour, that gets there: what is clear tints it.
MV_FN vec3 shadowRayPassed(MV_BVH_PARAMS vec3 receiver, vec3 normal, vec3 light) {
    vec3 lifted = receiver + normal * bvhLift(MV_BVH_SELF);
    return bvhPassed(MV_BVH_ARGS lifted, light - lifted, 0.0f, 1.0f);
}

MV_END_NAMESPACE
#endif
