// Shoots VPLs: one invocation a path, or, with MV_VPL_EMITTERS 1, one a bounce-0 VPL on an
// emissive surface. Writes every slot, dead ones included.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/types.glsl"

#include "shaders/shared/vpl.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;
layout(std430, binding = kBlockViews) writeonly buffer ViewBlock { View views[]; };

void main() {
    uint index = globalIndex();
#if MV_VPL_EMITTERS
    if (index >= vplSetup.surfaceSlots) return;
    views[index] = vplOnEmitter(index);
#else
    if (index >= vplSetup.paths) return;
    vec3 origin;
    vec3 direction;
    vec3 flux;
    vplEmit(index, origin, direction, flux);
    bool alive = vplAnyFlux(flux);
    uint slot = vplSetup.surfaceSlots + index * vplSetup.bounces;
    uint bounce = 1u;
    while (bounce <= vplSetup.bounces && slot < vplSetup.count) {
        View view = vplDead();
        if (alive) alive = vplBounce(index, bounce, slot, origin, direction, flux, view);
        views[slot] = view;
        slot += 1u;
        bounce += 1u;
    }
#endif
}
