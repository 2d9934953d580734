// Visibility of a sample of the gather (passes/gather_sum.glsl): a ray against the scene's
// triangles.
//
// The walk's loops are nested, and a software renderer runs eight lanes together: it may take as
// many rounds as those of all eight one after the other. One ray in thousands looks at ten times
// what others do, so all rays of an invocation share what its samples may take.
#ifdef MV_SAMPLE_ROUNDS
const uint kLanes = 8u;
uint roundsTaken = 0u;  // by all rays so far
#define MV_BVH_COUNT(rounds)                     \
    roundsTaken += rounds;                       \
    if (roundsTaken * kLanes > roundsOfRays()) { \
        top = 0;                                 \
        group = 0u;                              \
        item = kNone;                            \
    }
uint roundsOfRays() { return sampleRounds * (lastSample - firstSample); }
#endif
#include "shaders/shared/shadow_ray.glsl"

bool isVisible(VisibilitySample s) {
    if (!s.counts) return true;
    bool blocked = shadowRayBlocked(s.position, s.normal, s.position + s.toView);
#ifdef MV_SAMPLE_ROUNDS
    noteRounds(roundsTaken * kLanes, roundsOfRays());
#endif
    return !blocked;
}
