// The samples of a pixel that a gather at a lower resolution gathers for itself, or else the
// gather's pixels that it is brought up from.
#define MV_RECORDS_SAMPLES
#include "shaders/passes/gather_alone.glsl"
#include "shaders/passes/upsample.glsl"

layout(local_size_x = 1) in;

void main() {
    if (gl_GlobalInvocationID.x > 0u) return;
    beginRecord();
    if (upsamplePixel(chosen).alone) gatherAlone(chosen);
    endRecord();
}
