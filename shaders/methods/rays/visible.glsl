// Visibility of a sample of the gather (passes/gather_sum.glsl): a march of the scene octree.
#define MV_MARCH_UNIT kUnitMarchNodes
#include "shaders/shared/march.glsl"

bool isVisible(VisibilitySample s) {
    if (!s.counts) return true;
    uint steps;
    bool blocked = marchBlocked(s.position, s.normal, s.position + s.toView, s.viewNormal,
                                sampleRounds, steps);
    noteRounds(steps);
    return !blocked;
}
