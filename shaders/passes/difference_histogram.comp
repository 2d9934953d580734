// |difference| -> how many texels fall into each bin of equal upper 16 bits: each less than 1 %
// wide. Zeros are left out; what is no number falls into bins from kFiniteDifferenceBins on.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/tone.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitDifferences) uniform sampler2D values;
layout(std430, binding = kBlockHistogram) restrict buffer Histogram { uint bins[]; };
uniform ivec2 size;

void main() {
    uint first = globalIndex() * kTexelsPerInvocation;
    uint end = min(first + kTexelsPerInvocation, uint(size.x * size.y));
    for (uint i = first; i < end; ++i) {
        ivec2 p = ivec2(int(i) % size.x, int(i) / size.x);
        uint bits = floatBitsToUint(texelFetch(values, p, 0).r) & 0x7FFFFFFFu;
        if (bits != 0u) atomicAdd(bins[bits >> 16u], 1u);
    }
}
