// The index of an invocation, or of a work group, in a 1-D dispatch that gl::Program may have
// folded into two dimensions. GLSL only.
#ifndef MV_DISPATCH_GLSL
#define MV_DISPATCH_GLSL
#ifndef MV_WORKGROUP_SIZE
#error "define MV_WORKGROUP_SIZE: 8 on software renderers, 64 on GPUs (gl::limits().workGroupSize)"
#endif

uint groupIndex() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
uint globalIndex() { return groupIndex() * uint(MV_WORKGROUP_SIZE) + gl_LocalInvocationID.x; }
#endif
