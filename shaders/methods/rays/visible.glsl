// Visibility of a sample of the gather (passes/gather_sum.glsl): a march of the scene octree.
#include "shaders/shared/march.glsl"

bool isVisible(VisibilitySample s) {
    if (!s.counts) return true;
    uint steps;
    bool blocked = marchBlocked(s.position, s.normal, s.position + s.toView, s.viewNormal,
                                sampleRounds, steps);
    noteRounds(steps, sampleRounds);
    return !blocked;
}
