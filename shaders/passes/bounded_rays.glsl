// The scene's triangles, for passes of one ray an invocation. Where a software renderer's loops are
// bounded (BvhTables::defines()), the few rays that look at more end there and hit nothing.
#include "shaders/shared/bindings.glsl"
#ifdef MV_RAY_ROUNDS
uint roundsTaken = 0u;
#define MV_BVH_COUNT(rounds)           \
    roundsTaken += rounds;             \
    if (roundsTaken > MV_RAY_ROUNDS) { \
        top = 0;                       \
        group = 0u;                    \
        item = kNone;                  \
    }
#endif
#include "shaders/shared/shadow_ray.glsl"
