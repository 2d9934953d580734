// What a view's map knows of a sample of the gather (gather_sum.glsl) without asking the scene:
// lit, blocked, or kAsk where its four nearest texels disagree or one of them cannot tell.
#include "shaders/passes/gather_maps.glsl"
#include "shaders/shared/shadow_test.glsl"

uint decide(VisibilitySample s) {
    float d = length3(s.fromMap);
    if (!(d > 1e-20)) return kAsk;
    uvec4 texels = nearestTexels(s.fromMap, viewRes);
    float angle = texelAngle(s.fromMap, viewRes);
    uint first = kTexelUndecided;
    for (int i = 0; i < 4; ++i) {
        vec3 ray = texelDirection(texels[i], viewRes);
        uint verdict = texelVerdict(loadMapTexel(s.map - firstMap, texels[i]), ray, s.fromMap, d,
                                    s.plane, angle, bias);
        if (i == 0) first = verdict;
        if (verdict != first) first = kTexelUndecided;
    }
    return first == kTexelLit ? kLit : first == kTexelBlocked ? kBlocked : kAsk;
}
