// Old and pending nodes, and what a frame knows of their views, read as texels.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/cut_data.glsl"

layout(binding = kUnitCutNodes) uniform usamplerBuffer cutNodes;
layout(binding = kUnitCutSteps) uniform usamplerBuffer cutSteps;

CutEntry fetchCutEntry(uint index) {
    uvec4 e = texelFetch(cutNodes, int(index));
    return CutEntry(CutNode(e.x, uintBitsToFloat(e.y), uintBitsToFloat(e.z)), e.w);
}
CutPending fetchPending(uint index) {
    uvec4 p = texelFetch(cutNodes, int(index));
    return CutPending(p.x, p.y, uintBitsToFloat(p.z), p.w);
}
CutStep fetchStep(uint slot) {
    uvec2 s = texelFetch(cutSteps, int(slot)).xy;
    return CutStep(s.x, uintBitsToFloat(s.y));
}
// Is the old cut of the view brought up to date?
bool goesOn(CutStep step) { return step.viewNode != kNone && step.displacement >= 0.0f; }
