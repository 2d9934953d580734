// The index of an invocation, or of a work group, in a 1-D dispatch that gl::Program may have
// folded into two dimensions. GLSL only.
#ifndef MV_DISPATCH_GLSL
#define MV_DISPATCH_GLSL
#ifndef MV_WORKGROUP_SIZE
#error "define MV_WORKGROUP_SIZE: 8 on software renderers, 64 on GPUs (gl::limits().workGroupSize)"
#endif

uint groupIndex() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

// A barrier for what the work group shares. MV_ONE_VECTOR 1: its invocations run in step
// (gl::Limits::groupIsOneVector), so that only the compiler has to keep the order.
void groupBarrier() {
#if defined(MV_ONE_VECTOR) && MV_ONE_VECTOR
    memoryBarrierShared();
#else
    barrier();
#endif
}
uint globalIndex() { return groupIndex() * uint(MV_WORKGROUP_SIZE) + gl_LocalInvocationID.x; }
#endif
