// What a view's map says of a sample of the gather (gather_sum.glsl) without asking the scene: it
// is sure where the four nearest texels agree.
#include "shaders/passes/gather_maps.glsl"
#include "shaders/shared/shadow_test.glsl"

uint decide(VisibilitySample s) {
    float d = length3(s.fromMap);
    NearestTexels nearest = nearestTexels(s.fromMap, mapRes);
    float angle = texelAngle(s.fromMap, mapRes);
    uint lit = 0u;
    uint blocked = 0u;
    for (int i = 0; i < 4; ++i) {
        vec2 center = vec2(nearest.u[i], nearest.v[i]);
        uint verdict = texelVerdict(loadMapTexel(s.map - firstMap, nearest.texels[i]),
                                    centerRay(nearest.face, center), centerRayLength(center),
                                    s.fromMap, d, s.plane, angle, bias);
        if (verdict == kVerdictLit) ++lit;
        if (verdict == kVerdictBlocked) ++blocked;
    }
    if (d > 1e-20 && lit == 4u) return kVerdictLit;
    if (d > 1e-20 && blocked == 4u) return kVerdictBlocked;
    return lit >= blocked ? kVerdictRatherLit : kVerdictRatherBlocked;
}
