// How many texels of each run of kTexelsPerInvocation are NaN or infinite.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/tone.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;
layout(binding = kUnitRadiance) uniform sampler2D radianceTexture;
layout(std430, binding = kBlockBadCounts) writeonly buffer Counts { uint counts[]; };
uniform ivec2 size;

void main() {
    uint texels = uint(size.x * size.y);
    uint begin = globalIndex() * kTexelsPerInvocation;
    if (begin >= texels) return;
    uint end = min(begin + kTexelsPerInvocation, texels);
    uint bad = 0u;
    for (uint i = begin; i < end; ++i) {
        vec4 c = texelFetch(radianceTexture, ivec2(int(i) % size.x, int(i) / size.x), 0);
        if (isBad(c.rgb)) ++bad;
    }
    counts[globalIndex()] = bad;
}
