// Visibility of a sample of the gather (passes/gather_sum.glsl): a ray against the scene's
// triangles.
//
// The walk's loops are nested, and a software renderer runs eight lanes together: it may take as
// many rounds as those of all eight one after the other.
#ifdef MV_SAMPLE_ROUNDS
const uint kLanes = 8u;
uint roundsTaken;
#define MV_BVH_COUNT(rounds)                   \
    roundsTaken += rounds;                     \
    if (roundsTaken * kLanes > sampleRounds) { \
        top = 0;                               \
        group = 0u;                            \
        item = kNone;                          \
    }
#endif
#include "shaders/shared/shadow_ray.glsl"

bool isVisible(VisibilitySample s) {
    if (!s.counts) return true;
#ifdef MV_SAMPLE_ROUNDS
    roundsTaken = 0u;
#endif
    bool blocked = shadowRayBlocked(s.position, s.normal, s.position + s.toView);
#ifdef MV_SAMPLE_ROUNDS
    noteRounds(roundsTaken * kLanes);
#endif
    return !blocked;
}
